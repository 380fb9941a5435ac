#include "engine/report/writer.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/report/writers/table.hpp"

using namespace abbe;
using Json = nlohmann::ordered_json;

namespace {

CharacteristicReport length() {
  CharacteristicReport c;
  c.features = {"END1", "END2"};
  c.tolerance = "LEN", c.kind = "DISTB", c.unit = "mm";
  c.line = 41;
  c.nominal = 500, c.reference = 500;
  c.evaluated = 1000;
  c.summary.n = 1000;
  c.summary.mean = 500.00002, c.summary.u = 0.00203;
  c.summary.symmetric = {499.996, 500.0042}, c.summary.shortest = {499.9961, 500.0041};
  c.summary.mean_error = 6.4e-5, c.summary.u_error = 4.5e-5, c.summary.low_error = 1.7e-4,
  c.summary.high_error = 1.8e-4;
  c.histogram = {499.994, 500.006, {20, 230, 500, 230, 20}};
  c.lcl = -0.0040, c.ucl = 0.0042;
  c.lower = 499.99, c.upper = 500.01;
  c.conformance_probability = 0.998;
  c.decision = {Conformity::conforms, 0.0034, 499.9934, 500.0066, 4.878};
  c.contributions = {{"geometry", 0.62}, {"head", 0.0}, {"probe", 0.38}};
  return c;
}

RunReport report() {
  RunReport r;
  r.program = "block.dmi", r.machine = "coord3-mc16", r.version = "0.1.0", r.seed = 7;
  r.cycle_time_s = 191.6;
  r.machines = {2711, 1640, 71, 1000};
  r.characteristics = {length()};
  r.influences = {{"geometry", InfluenceStatus::modelled}, {"part temperature"}, {"operator"}};
  r.lost = {{77, "BORE", "the statement has errors"}};
  r.traps = {{3, 10, 84, "no points"}, {8, 10, 84, "no points"}, {9, 4, 12, "endless loop"}};
  r.messages = {diagnostic(Code::W0416, "only 36.9 % pass", "see `abbe machine screen`"),
                diagnostic_at(SourceFile("block.dmi", "FOO/1\n"), {0, 3}, Code::E0604, "about a place")};
  return r;
}

std::vector<std::string> keys(const Json& object) {
  std::vector<std::string> out;
  for (const auto& item : object.items()) out.push_back(item.key());
  return out;
}

std::string written(std::string_view format, const RunReport& r) {
  const ReportWriter* writer = find_report_writer(format);
  REQUIRE(writer != nullptr);
  return writer->write(r);
}

}  // namespace

TEST_CASE("writers are found by name") {
  CHECK(find_report_writer("text")->name == "text");
  CHECK(find_report_writer("yaml") == nullptr);
}

TEST_CASE("JSON has the keys of schema abbe.run/1 in order") {
  const Json j = Json::parse(written("json", report()));
  const std::vector<std::string> published{"schema",   "program",         "machine", "seed",       "version",
                                           "machines", "characteristics", "lost",    "influences", "messages"};
  std::vector<std::string> found = keys(j);
  std::erase_if(found, [&](const std::string& key) {
    return std::find(published.begin(), published.end(), key) == published.end();
  });
  CHECK(found == published);
  CHECK(j["schema"] == "abbe.run/1");
  CHECK(j["seed"] == 7);
  CHECK(j["cycle_time_s"] == 191.6);
  CHECK(j["machines"] ==
        Json{{"used", 1000},
             {"generated", 2711},
             {"failed_mpe", 1640},
             {"too_small", 71},
             {"share_accepted", 1000.0 / 2711}});
  const Json& c = j["characteristics"][0];
  CHECK(keys(c) ==
        std::vector<std::string>{"feature",
                                 "tolerance",
                                 "kind",
                                 "unit",
                                 "line",
                                 "occurrence",
                                 "nominal",
                                 "reference",
                                 "mean",
                                 "u",
                                 "lcl",
                                 "ucl",
                                 "interval95",
                                 "monte_carlo_error",
                                 "tolerance_limits",
                                 "conformance_probability",
                                 "decision",
                                 "contributions",
                                 "trapped",
                                 "evaluated"});
  CHECK(c["feature"] == Json{"END1", "END2"});
  CHECK(c["u"] == 0.00203);
  CHECK(c["interval95"] == Json{{"symmetric", {499.996, 500.0042}}, {"shortest", {499.9961, 500.0041}}});
  CHECK(c["monte_carlo_error"] == Json{{"mean", 6.4e-5}, {"u", 4.5e-5}, {"lcl", 1.7e-4}, {"ucl", 1.8e-4}});
  CHECK(c["tolerance_limits"] == Json{499.99, 500.01});
  CHECK(c["decision"] ==
        Json{{"rule", "ISO 14253-1:2017"},
             {"probability", 0.95},
             {"guard_band", 0.0034},
             {"acceptance_limits", {499.9934, 500.0066}},
             {"verdict", "conforms"},
             {"tolerance_to_uncertainty", 4.878}});
  CHECK(c["contributions"] == Json{{"geometry", 0.62}, {"head", 0.0}, {"probe", 0.38}});
  CHECK(j["lost"][0] == Json{{"line", 77}, {"feature", "BORE"}, {"reason", "the statement has errors"}});
  CHECK(j["influences"][1] == Json{{"name", "part temperature"}, {"status", "not modelled"}});
  CHECK(j["traps"].size() == 3);
  CHECK(j["traps"][2] == Json{{"machine", 9}, {"line", 12}, {"reason", "endless loop"}});
  CHECK(j["messages"][0] ==
        Json{{"code", "W0416"},
             {"severity", "warning"},
             {"line", nullptr},
             {"column", nullptr},
             {"message", "only 36.9 % pass"},
             {"help", "see `abbe machine screen`"}});
  CHECK(j["messages"][1]["line"] == 1);
  CHECK(j["messages"][1]["column"] == 1);
}

TEST_CASE("JSON never holds NaN or bytes that are not UTF-8") {
  RunReport r = report();
  r.characteristics[0].reference = std::numeric_limits<double>::quiet_NaN();
  r.characteristics[0].ucl = std::numeric_limits<double>::infinity();
  r.characteristics[0].lower = std::nullopt;
  r.characteristics[0].conformance_probability = std::nullopt;
  r.characteristics[0].features = {"BOHRUNG_\xE4"};  // Latin-1
  const Json c = Json::parse(written("json", r))["characteristics"][0];
  CHECK(c["reference"].is_null());
  CHECK(c["ucl"].is_null());
  CHECK(c["tolerance_limits"] == Json{nullptr, 500.01});
  CHECK(c["conformance_probability"].is_null());
  CHECK(c["feature"][0] == "BOHRUNG_\xEF\xBF\xBD");
}

TEST_CASE("the text report reads at a glance") {
  CHECK(
      written("text", report()) ==
      "block.dmi\n"
      "machine coord3-mc16: 1000 virtual machines used of 2711 generated (36.9 % accepted), seed "
      "7\n"
      "estimated cycle time 3 min 12 s\n"
      "\n"
      "line  feature     tolerance    unit     value       u      LCL      UCL     lower     "
      "upper  conforms  geometry  head  probe\n"
      "  41  END1, END2  LEN (DISTB)  mm    500.0000  0.0020  -0.0040  +0.0042  499.9900  "
      "500.0100    99.8 %      62 %   0 %   38 %\n"
      "\n"
      "value: on an error-free machine; u: standard uncertainty; LCL, UCL: 95 % limits (2.5 % "
      "and 97.5 %) minus value;\n"
      "lower, upper: tolerance limits; conforms: share of machines inside them; then shares of "
      "the variance.\n"
      "Monte Carlo error of u: 2.2 % (standard error, the largest of the table).\n"
      "\n"
      "line  feature     tolerance    unit     value  accepted              verdict   T/U\n"
      "  41  END1, END2  LEN (DISTB)  mm    500.0000  499.9934 to 500.0066  conforms  4.9\n"
      "\n"
      "accepted: the values that prove conformity by ISO 14253-1:2017 (95 %), the tolerance limits less a guard band from the simulated\n"
      "errors; verdict: on the value; T/U: tolerance over expanded uncertainty (half of the 95 % interval).\n"
      "\n"
      "1 of 1000 machines stopped at line 12: endless loop\n"
      "2 of 1000 machines stopped at line 84: no points\n"
      "lost: line 77: BORE: the statement has errors\n"
      "Not modelled: part temperature, operator.\n");
}

TEST_CASE("all messages are on the page, those of a place with it but without its line") {
  const std::string page = written("html", report());
  CHECK(page.find("only 36.9 % pass") != std::string::npos);
  CHECK(page.find("<p>block.dmi:1:1: error E0604: about a place</p>") != std::string::npos);
  CHECK(page.find("FOO/1") == std::string::npos);
}

TEST_CASE("a bounded influence shows its bound and who stated it") {
  RunReport r = report();
  r.influences[1] = {"part temperature", InfluenceStatus::bounded, 0.35, "climate log"};
  const Json influences = Json::parse(written("json", r))["influences"];
  CHECK(influences[1] ==
        Json{{"name", "part temperature"}, {"status", "bounded"}, {"at_most_um", 0.35}, {"source", "climate log"}});
  CHECK(!influences[0].contains("at_most_um"));
  const std::string text = written("text", r);
  CHECK(
      text.ends_with("Bounded, not in u: part temperature, at most 0.35 um at a touch (climate log).\n"
                     "Not modelled: operator.\n"));
}

TEST_CASE("an interval of another coverage is shown when it was asked for") {
  RunReport r = report();
  CHECK(!Json::parse(written("json", r))["characteristics"][0].contains("interval"));
  CHECK(written("text", r).find("symmetric") == std::string::npos);
  r.characteristics[0].reference = 500;
  r.characteristics[0].interval = {0.99, {499.99, 500.012}, {499.991, 500.01}};
  const Json interval = Json::parse(written("json", r))["characteristics"][0]["interval"];
  CHECK(interval == Json{{"coverage", 0.99}, {"symmetric", {499.99, 500.012}}, {"shortest", {499.991, 500.01}}});
  const std::string text = written("text", r);
  CHECK(text.find("symmetric 99 %") != std::string::npos);
  CHECK(text.find("-0.0100 to +0.0120") != std::string::npos);
  CHECK(text.find("-0.0090 to +0.0100") != std::string::npos);
  CHECK(written("html", r).find("<td class=\"n\">-0.0100 to +0.0120</td><td class=\"n\">-0.0090 to +0.0100</td>") !=
        std::string::npos);
}

TEST_CASE("a page shows the table and the distribution of each characteristic") {
  RunReport r = report();
  r.program = "<block> & co.dmi";
  const std::string page = written("html", r);
  const auto count = [&](std::string_view what) {
    int n = 0;
    for (std::size_t at = page.find(what); at != std::string::npos; at = page.find(what, at + 1)) ++n;
    return n;
  };
  CHECK(page.starts_with("<!DOCTYPE html>"));
  CHECK(page.find("&lt;block&gt; &amp; co.dmi") != std::string::npos);
  CHECK(page.find("<block>") == std::string::npos);
  CHECK(page.find("END1, END2: LEN (DISTB)") != std::string::npos);
  CHECK(page.find("99.8 %") != std::string::npos);
  CHECK(page.find("<td class=\"n\">-0.0040</td><td class=\"n\">+0.0042</td>") != std::string::npos);
  CHECK(count("<svg") == 1);
  CHECK(count("fill-opacity=\"0.75\"") == 3);  // bars whose middle is between LCL and UCL
  CHECK(count("fill-opacity=\"0.3\"") == 2);
  CHECK(count("stroke-dasharray") == 2);  // both tolerance limits, 10 um away
  CHECK(page.find("lost: line 77: BORE") != std::string::npos);
  CHECK(page.find("part temperature") != std::string::npos);
  CHECK(page.find("<script") == std::string::npos);
  r.characteristics[0].unit = "deg";  // from -21.6 to 21.6 seconds of arc
  CHECK(written("html", r).find("value on a machine minus value, arcsec") != std::string::npos);
  CHECK(written("html", r).find(">20</text>") != std::string::npos);
  r.characteristics[0].unit = "mm";
  r.characteristics[0].lower = 490;  // too far away to be drawn
  const std::string far = written("html", r);
  CHECK(far.find("stroke-dasharray") == far.rfind("stroke-dasharray"));
  r.characteristics.clear();
  CHECK(written("html", r).find("No characteristic was evaluated.") != std::string::npos);
}

TEST_CASE("how effects are used is told when there are any") {
  RunReport r = report();
  CHECK(Json::parse(written("json", r))["effects_use"].is_null());
  CHECK(written("text", r).find("effects ") == std::string::npos);
  r.effect_use = EffectUse::corrected;
  CHECK(Json::parse(written("json", r))["effects_use"] == "corrected");
  CHECK(written("text", r).find("\neffects corrected\n") != std::string::npos);
  r.effect_use = EffectUse::left_in;
  CHECK(Json::parse(written("json", r))["effects_use"] == "left-in");
}

TEST_CASE("a short cycle is told in seconds") {
  RunReport r = report();
  r.cycle_time_s = 59.4;
  CHECK(written("text", r).find("\nestimated cycle time 59 s\n") != std::string::npos);
  r.cycle_time_s = 59.6;
  CHECK(written("text", r).find("\nestimated cycle time 1 min 0 s\n") != std::string::npos);
}

TEST_CASE("figures are rounded to two digits of u and decimal points stand below each other") {
  RunReport r = report();
  r.characteristics.push_back(length());
  CharacteristicReport& fine = r.characteristics[1];
  fine.summary.u = 0.0000996;  // two digits: 0.00010
  fine.lcl = -0.00019, fine.ucl = -0.000001;
  fine.lower = std::nullopt, fine.conformance_probability = std::nullopt, fine.decision = std::nullopt;
  fine.contributions.clear();
  fine.occurrence = 2;
  const std::string text = written("text", r);
  CHECK(text.find("  41  END1, END2  LEN (DISTB)     mm    500.0000   0.0020   -0.0040   +0.0042   "
                  "499.9900  500.0100    99.8 %      62 %   0 %   38 %\n") != std::string::npos);
  CHECK(text.find("  41  END1, END2  LEN (DISTB) #2  mm    500.00000  0.00010  -0.00019  +0.00000  "
                  "  -       500.0100         -         -     -      -\n") != std::string::npos);
}

TEST_CASE("tolerance limits have the decimals that they need") {
  RunReport r = report();
  r.characteristics.resize(2, length());
  r.characteristics[0].lower = 499.99955, r.characteristics[0].upper = 500.00004;
  r.characteristics[1].lower = 1.0 / 60, r.characteristics[1].upper = 500.1 + 1e-13;
  const std::string text = written("text", r), page = written("html", r);
  INFO(text);
  CHECK(text.find("  499.99955      500.00004        99.8 %  ") != std::string::npos);
  CHECK(text.find("    0.016666667  500.1000         99.8 %  ") != std::string::npos);
  for (const char* limit : {">499.99955<", ">500.00004<", ">0.016666667<", ">500.1000<"})
    CHECK(page.find(limit) != std::string::npos);
}

TEST_CASE("decisions: zones, limits that no value meets, and rows without one") {
  RunReport r = report();
  r.characteristics.resize(4, length());
  CharacteristicReport &zone = r.characteristics[1], &narrow = r.characteristics[2];
  r.characteristics[0].decision->lower = 499.99334, r.characteristics[0].decision->upper = 500.00666;
  r.characteristics[3].summary.u_error = 1e-6;
  zone.reference = 0, zone.lower = std::nullopt, zone.decision = {Conformity::undecided, 0.0046, {}, 0.0004, 2.44};
  narrow.decision = {Conformity::does_not_conform, {}, {}, {}, std::numeric_limits<double>::infinity()};
  r.characteristics[3].decision = std::nullopt;
  const std::string text = written("text", r), page = written("html", r);
  INFO(text);
  // Rounded inwards: what is printed is accepted.
  CHECK(text.find("  499.9934 to 500.0066  conforms  ") != std::string::npos);
  CHECK(text.find("Monte Carlo error of u: 2.2 % (standard error, the largest of the table)") != std::string::npos);
  CHECK(text.find("    0.0000  up to 0.0004          undecided         2.4\n") != std::string::npos);
  CHECK(text.find("  500.0000  none                  does not conform    -\n") != std::string::npos);
  CHECK(page.find("<h2>Decisions</h2>") != std::string::npos);
  CHECK(page.find("<td>up to 0.0004</td><td>undecided</td>") != std::string::npos);
  const Json c = Json::parse(written("json", r))["characteristics"];
  CHECK(c[1]["decision"]["acceptance_limits"] == Json{nullptr, 0.0004});
  CHECK(c[2]["decision"]["acceptance_limits"].is_null());
  CHECK(c[2]["decision"]["guard_band"].is_null());
  CHECK(c[2]["decision"]["tolerance_to_uncertainty"].is_null());
  CHECK(c[3]["decision"].is_null());
  for (CharacteristicReport& each : r.characteristics) each.decision = std::nullopt;
  CHECK(written("text", r).find("verdict") == std::string::npos);
  CHECK(written("html", r).find("Decisions") == std::string::npos);
}

TEST_CASE("a row that rests on some of the machines says of how many") {
  RunReport r = report();
  CharacteristicReport& c = r.characteristics[0];
  c.evaluated = 400, c.elsewhere = 595, c.trapped = 5;
  c.reference = c.lcl = c.ucl = std::nullopt;
  const std::string text = written("text", r);
  INFO(text);
  CHECK(text.find("  mm    -       0.0020  -       -       499.9900  500.0100  99.8 % of 400  ") != std::string::npos);
  const Json j = Json::parse(written("json", r))["characteristics"][0];
  CHECK(j["reference"].is_null());
  CHECK(j["lcl"].is_null());
  CHECK(j["evaluated"] == 400);
  CHECK(j["trapped"] == 5);
}

TEST_CASE("an uncertainty that is rounding asks for no decimals") {
  RunReport r = report();
  r.characteristics[0].summary.u = 3e-13;
  CHECK(written("text", r).find("  500.0000  0.0000  ") != std::string::npos);
}

TEST_CASE("an uncertainty that is not known asks for no decimals and has no interval") {
  RunReport r = report();
  CharacteristicReport& c = r.characteristics[0];
  c.varies = false, c.summary.u = 2e-7;
  c.interval = {0.99, {500, 500}, {500, 500}};
  const std::string text = written("text", r);
  INFO(text);
  CHECK(text.find("500.00000") == std::string::npos);
  CHECK(text.find("0 to +0") == std::string::npos);
  c.budget = {{"part", 0, 0}};
  c.alignment_split = {{"alignment", 0, 0}, {"feature", 0, 0}};
  for (const char* writer : {"text", "html"}) CHECK(written(writer, r).find("alignment") == std::string::npos);
  const Json json = Json::parse(written("json", r))["characteristics"][0];
  CHECK(text.find("62 %") == std::string::npos);
  for (const char* name : {"geometry", "head", "probe"}) CHECK(json["contributions"][name].is_null());
  for (const char* key : {"budget", "alignment_split"})
    for (const Json& line : json[key]) CHECK((line["share"].is_null() && line["u"].is_null()));
}

TEST_CASE("a share that rounds to nothing has no sign") {
  RunReport r = report();
  r.characteristics[0].budget = {{"probe", 1, 0.001}};
  r.characteristics[0].alignment_split = {{"alignment", -2e-5, 1e-6}, {"feature", 1.00002, 0.001}};
  for (const char* writer : {"text", "html"}) CHECK(written(writer, r).find("-0.0 %") == std::string::npos);
  r.characteristics[0].budget = {{"exx", 0.997, 0.001}, {"probe", 0.003, 5e-5}};
  for (const char* writer : {"text", "html"}) {
    const std::string shares = written(writer, r);
    CHECK(shares.find("99.7 %") != std::string::npos);
    CHECK(shares.find("0.3 %") != std::string::npos);
  }
}

TEST_CASE("a report without characteristics says so") {
  RunReport r = report();
  r.characteristics.clear();
  CHECK(written("text", r).find("No characteristic was evaluated.") != std::string::npos);
  CHECK(Json::parse(written("json", r))["characteristics"].empty());
}

TEST_CASE("the time of a table goes with its rows") {
  Table table({{"n"}, {"text", Table::Align::left}});
  constexpr int kRows = 200'000;  // with their square it would take an hour
  for (int k = 0; k < kRows; ++k) table.add({std::to_string(k), k == kRows / 2 ? "a long cell" : "x"});
  const std::string text = table.to_text();
  CHECK(text.starts_with("     n  text\n     0  x\n"));
  CHECK(std::count(text.begin(), text.end(), '\n') == kRows + 1);
}

TEST_CASE("columns are as wide as what a terminal shows") {
  CHECK(display_width("Bohrung_ä") == 9);
  Table table({{"a", Table::Align::left}, {"b"}});
  table.add({"ä", "1"});
  table.add({"long", "22"});
  CHECK(table.to_text() == "a      b\nä      1\nlong  22\n");
}
