#include "engine/diagnose/words.hpp"

#include <doctest/doctest.h>

using namespace abbe;

namespace {

DiagnosedParameter size(const char* name, const char* unit, double value, double u) {
  return {.name = name, .unit = unit, .value = value, .u = u, .low = value - 1.96 * u, .high = value + 1.96 * u};
}

}  // namespace

TEST_CASE("a size is told with its unit and the digits that its uncertainty bears") {
  CHECK(with_uncertainty(size("amplitude_um", "um", 3.00543, 0.00924)) == "amplitude 3.005 ± 0.018 um");
  CHECK(with_uncertainty(size("cte_error_ppm_per_K", "ppm/K", -2.34567, 0.3)) == "cte error -2.35 ± 0.60 ppm/K");
  CHECK(with_uncertainty(size("tau_s", "s", 3480.7, 240)) == "tau 3481 ± 480 s");
  CHECK(with_uncertainty(size("sag_um_per_500kg", "um", 4, 0.25)) == "sag per 500kg 4.00 ± 0.50 um");
  CHECK(with_uncertainty(size("second_tau_s", "s", 12, 1)) == "second tau 12.0 ± 2.0 s");
  CHECK(with_uncertainty(size("share", "1", 0.02, 0)) == "share 0.0200");
  CHECK(with_uncertainty({.name = "axis", .unit = "code", .word = "x"}) == "axis x");
  DiagnosedParameter which{.name = "sensor", .unit = "code", .value = 2, .u = 0, .low = 2, .high = 2};
  CHECK(with_interval(which) == "sensor 2");
  which.called = "STAR_LEFT";
  CHECK(with_interval(which) == "sensor STAR_LEFT");
  CHECK(with_uncertainty(which) == "sensor STAR_LEFT");
  DiagnosedParameter nodes{.name = "spacing_mm", .unit = "mm", .value = 25, .u = 0, .low = 25, .high = 25};
  nodes.others = {{"50 mm", 0.3}};
  CHECK(with_interval(nodes) == "spacing 25.0 mm (or 50 mm)");
  nodes.others = {{"50 mm", 0.3}, {"20 mm", 0.2}, {"75 mm", 0.1}, {"100 mm", 0.1}};
  CHECK(with_uncertainty(nodes) == "spacing 25.0 mm (or 50 mm, 20 mm, 2 more)");
  DiagnosedParameter along{.name = "axis", .word = "x"};
  along.others = {{"y", 0.2}};
  CHECK(with_interval(along) == "axis x (or y)");
  DiagnosedParameter moment = size("t0_s", "s", 301.8, 4.85);
  moment.called = "in run 2";
  CHECK(with_uncertainty(moment) == "t0 301.8 ± 9.7 s (in run 2)");
  DiagnosedParameter slow = size("tau_s", "s", 2866, 3600);
  slow.low = 1401, slow.high = 11215;
  CHECK(with_uncertainty(slow) == "tau 2866 s (1401 to 11215)");
  DiagnosedParameter far = size("squareness_urad", "urad", 46, 6);
  far.plausible = false;
  CHECK(with_interval(far) == "squareness 46 urad (34 to 58), implausible");
}

TEST_CASE("a pattern is as large as its rms, and as it is at a touch") {
  Unexplained u{"time", "slow", 0.82, 0.1, 0.62, 1.02, ""};
  u.largest_um = 5.43;
  CHECK(amplitude_in_words(u) == "0.82 um rms (0.62 to 1.0); at most 5.4 um at a touch");
  u.largest_um.reset();
  CHECK(amplitude_in_words(u) == "0.82 um rms (0.62 to 1.0)");
}

TEST_CASE("a value that no virtual machine reaches has no p of its own") {
  JudgedValue v;
  v.p = 1 / 1001.0;
  CHECK(p_in_words(v) == "0.001");
  v.beyond_all = true;
  CHECK(p_in_words(v) == "<0.001");
}

TEST_CASE("two digits, and no exponent") {
  CHECK(two_digits(0) == "0");
  CHECK(two_digits(0.0314) == "0.031");
  CHECK(two_digits(0.999) == "1.0");
  CHECK(two_digits(4.55) == "4.5");
  CHECK(two_digits(38.4) == "38");
  CHECK(two_digits(-384) == "-380");
  CHECK(two_digits(12345) == "12000");
}

TEST_CASE("why an effect cannot be judged") {
  CHECK(why_not_judged({"part.load_bending", {"load_kg"}, {}}, true) == "missing: load_kg");
  CHECK(why_not_judged({"thermal.part_expansion", {"temp_part_C"}, {"temp_part_C"}}, true) ==
        "the same throughout: temp_part_C");
  CHECK(why_not_judged({"machine.dynamics", {"accel_mm_s2", "speed_mm_s"}, {"speed_mm_s"}}, true) ==
        "missing: accel_mm_s2; the same throughout: speed_mm_s");
  CHECK(why_not_judged({"noise.unequal", {"a", "b", "c"}, {"a"}, {"b", "c"}, "fewer than 20 touches at another speed"},
                       true) == "the same throughout: a; fewer than 20 touches at another speed: b, c");
  CHECK(why_not_judged({"noise.vibration", {}, {}}, false) == "nothing of it shows in values");
}

TEST_CASE("one explanation, or several that cannot be told apart") {
  const std::vector<DiagnosedParameter> sizes{size("delay_ms", "ms", 1.2, 0.05)};
  CHECK(explanation_sentence({"trigger delay"}, sizes, "this recording") ==
        "It is explained by trigger delay: delay 1.20 ± 0.10 ms.");
  CHECK(explanation_sentence({"outliers"}, {}, "this recording") == "It is explained by outliers.");
  CHECK(explanation_sentence({"outliers"}, {}, "this recording", {}, false, true) ==
        "What that leaves is explained by outliers.");
  CHECK(
      explanation_sentence({"trigger delay", "tip radius"}, sizes, "this recording") ==
      "One of these explains it, and this recording cannot tell which: trigger delay; tip radius. As the first: delay 1.20 ± 0.10 ms.");
  CHECK(explanation_sentence({"trigger delay"}, sizes, "this recording", {}, true) ==
        "It looks like trigger delay: delay 1.20 ± 0.10 ms.");
  CHECK(explanation_sentence({"trigger delay", "tip radius"}, {}, "this recording", {}, true) ==
        "One of these may explain it, and this recording cannot tell which: trigger delay; tip radius.");
  CHECK(explanation_sentence({"trigger delay"}, sizes, "this recording", {.from = 2}) ==
        "What is new in run 2 is explained by trigger delay: delay 1.20 ± 0.10 ms.");
  CHECK(explanation_sentence({"trigger delay"}, sizes, "this recording", {.until = 2}) ==
        "What is gone in run 2 is explained by trigger delay: delay 1.20 ± 0.10 ms.");
  CHECK(explanation_sentence({"trigger delay", "tip radius"}, {}, "this recording", {.from = 3}) ==
        "One of these explains what is new in run 3, and this recording cannot tell which: trigger delay; tip radius.");
}

TEST_CASE("a name says in which run it is new") {
  DiagnosedEffect e;
  e.members = {"probe.tip_radius", "machine.step"};
  e.change = {{.from = 2}, {}};
  CHECK(in_words(e) == std::vector<std::string>{"probe.tip_radius, new in run 2", "machine.step"});
  e.change = {{.until = 3}, {.from = 2}};
  CHECK(in_words(e) == std::vector<std::string>{"probe.tip_radius, gone in run 3", "machine.step, new in run 2"});
  e.change = {{.from = 2, .until = 3}, {}};
  CHECK(in_words(e).front() == "probe.tip_radius, new in run 2 and gone in run 3");
  e.change.clear();
  CHECK(in_words(e) == e.members);
}

TEST_CASE("where several factors hold a pattern alike, all are told") {
  Diagnosis d;
  CHECK(located_in_words(d) == "");
  d.location = {{"feature", {{"feature", "BALL4"}}, 1, 0.001}, {"time", {}, 0.9, 0.001}, {"position", {}, 0.5, 0.01}};
  CHECK(located_in_words(d) == "located in feature; strongest at feature BALL4");
  d.unexplained.emplace();
  CHECK(located_in_words(d) == "located in feature; strongest at feature BALL4; nearly as well in time");
}

TEST_CASE("the sizes of an effect say what they come to at a touch") {
  DiagnosedEffect e;
  e.parameters = {size("amplitude_um", "um", 0.04, 0.004), size("phase_deg", "deg", -40, 1.8)};
  CHECK(sizes_in_words(e.parameters, e.largest_um) ==
        "amplitude 0.0400 um (0.0322 to 0.0478); phase -40.0 deg (-43.5 to -36.5)");
  e.largest_um = 1.38;
  CHECK(sizes_in_words(e.parameters, e.largest_um) ==
        "amplitude 0.0400 um (0.0322 to 0.0478); phase -40.0 deg (-43.5 to -36.5); at most 1.4 um at a touch");
}

TEST_CASE("names are doubted that leave more than chance does") {
  Diagnosis d;
  CHECK(!doubtful(d));
  d.adequacy_p = 0.2;
  CHECK(!doubtful(d));
  d.adequacy_p = 0.01;
  CHECK(doubtful(d));
  d.unexplained = Unexplained{};
  CHECK(!doubtful(d));
}
