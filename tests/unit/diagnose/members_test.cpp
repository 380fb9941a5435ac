#include "engine/diagnose/findings/members.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "engine/diagnose/explanations/catalogue.hpp"
#include "engine/effects/effect.hpp"
#include "tests/unit/diagnose/scattered.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

/// Of a set that holds 0.9 of all belief, in these shares; `unlogged`: which of them need what was not logged.
struct OfASet {
  Case c;
  SearchResult result;

  OfASet(const std::vector<double>& shares, const std::vector<int>& unlogged) {
    Finding f;
    for (const double share : shares) {
      const int k = static_cast<int>(c.explanations.list.size());
      Explanation e;
      e.effect = find_effect("machine.scale");
      e.prior = 1.0 / double(shares.size());
      e.variants = {k};
      c.explanations.list.push_back(e);
      c.explanations.variants.emplace_back();
      f.evidence.log_bayes.push_back(std::log(share) + 20);
      f.set.push_back(k);
      f.best.push_back(k);
    }
    for (const int k : unlogged) c.explanations.list[k].missing = 1;
    f.explanation = f.variant = f.set.front();
    f.probability = 0.9;
    result.findings = {f};
  }

  Finding& finding() { return result.findings.front(); }
};

/// One effect planted, a tip radius or a scale, and a set of three names that share nine tenths of all belief as 0.5, 0.3
/// and 0.2.
struct OfThree : Planted {
  explicit OfThree(const std::vector<std::string>& names, bool scale = false) : Planted(4) {
    if (scale)
      plant("machine.scale", {60, 1});  // along y: a machine whose x is too long is taken for one of the specification
    else
      plant("probe.tip_radius", {1.2, 0});
    c.explanations = named_explanations(c.touches, c.rows, names);
    c.machine = &machine;
    Finding f;
    f.evidence = EvidenceSearch(c.model, c.hyper, c.explanations).evidence();
    const double shares[] = {0.5, 0.3, 0.2};
    for (int k = 0; k < 3; ++k) {
      f.evidence.log_bayes[k] = 20 + std::log(shares[k] / c.explanations.list[k].prior);
      f.set.push_back(k);
      f.best.push_back(best_variant(c.explanations, k, f.evidence));
    }
    f.explanation = 0, f.variant = f.best[0], f.probability = 0.9;
    result.findings = {f};
  }
};

}  // namespace

TEST_CASE("a member is believed by its share of the set, and told with a size of its own") {
  OfThree of({"probe.tip_radius", "machine.scale", "machine.squareness"});
  CHECK(belief_in_first(of.c.explanations, of.result.findings[0]) == doctest::Approx(0.45));
  DiagnosedEffect told;
  told.probability = 0.5;  // doubted: less than the 0.9 of the set
  told.change.resize(3);
  told.parameters = {{.name = "amplitude_um", .unit = "um", .value = 1.2, .u = 0.1}};
  told.largest_um = 1.2;
  for (const int b : of.c.explanations.list[1].variants) of.c.explanations.variants[b].change.from = 2;
  const std::vector<DiagnosedMember> members = members_of(of.c, of.result, 0, told);
  REQUIRE(members.size() == 3);
  CHECK(members[0].probability == doctest::Approx(0.25));
  CHECK(members[1].probability == doctest::Approx(0.15));
  CHECK(members[2].probability == doctest::Approx(0.10));
  CHECK(members[0].parameters.at(0).name == "amplitude_um");
  CHECK(members[1].parameters.at(0).name == "scale_um_per_m");
  CHECK(members[2].parameters.at(0).unit == "urad");
  CHECK(told.change[1].from == 2);  // what has that size is new then
  CHECK_FALSE(told.change[2].any());
}

TEST_CASE("a runner-up that fits and predicts as well joins the set") {
  struct Given {
    double gain = 25;
    bool planted = true, beside_a_pattern = false;
    double belief = 0.3;
  };
  const auto set_with = [](Given given) {
    OfThree of({"probe.tip_radius", "machine.scale", "machine.squareness"}, given.planted);
    Finding& f = of.result.findings[0];
    f.set = {0};
    f.probability = 0.6;
    f.evidence.log_bayes[1] += std::log(given.belief / 0.3);
    if (given.beside_a_pattern) of.result.other.emplace();
    Diagnosis d;
    d.improvement = Improvement{"leave-one-setup-out", 20, 4};
    d.runner_up = RunnerUp{{"machine.scale"}, given.gain};
    take_in_runner_up(of.c, EvidenceSearch(of.c.model, of.c.hyper, of.c.explanations), d, of.result);
    return std::pair(f.set, f.probability);
  };
  const std::vector<int> alone = {0}, both = {0, 1};
  CHECK(set_with({}).first == both);
  CHECK(set_with({}).second == doctest::Approx(0.6 * (0.5 + 0.3) / 0.5));
  CHECK(set_with({.gain = 19.1}).first == both);
  CHECK(set_with({.gain = 18.9}).first == alone);
  CHECK(set_with({.planted = false}).first == alone);
  CHECK(set_with({.beside_a_pattern = true}).first == alone);
  CHECK(set_with({.belief = 0.001}).first == alone);
}

TEST_CASE("a set is judged unless four fifths of it need what was not logged") {
  CHECK(judged(OfASet({0.5, 0.3, 0.2}, {}).c, OfASet({0.5, 0.3, 0.2}, {}).finding()));
  OfASet less({0.5, 0.29, 0.21}, {0, 1}), more({0.5, 0.31, 0.19}, {0, 1});
  CHECK(judged(less.c, less.finding()));
  CHECK(!judged(more.c, more.finding()));
}

TEST_CASE("what can be judged stands first, the likeliest in front") {
  OfASet of({0.5, 0.3, 0.2}, {0});
  put_judged_members_first(of.c, of.result);
  CHECK(of.finding().set == std::vector<int>{1, 2, 0});
  CHECK(of.finding().explanation == 1);
  CHECK(of.finding().variant == 1);

  OfASet hardly({0.9, 0.1}, {0});  // what cannot be judged is what it is
  put_judged_members_first(hardly.c, hardly.result);
  CHECK(hardly.finding().set == std::vector<int>{0, 1});
}

TEST_CASE("a member that does nothing to the touches is none of a set") {
  Planted p(4);
  p.plant("probe.tip_radius", {1.2, 0});
  p.c.explanations = named_explanations(p.c.touches, p.c.rows, {"probe.tip_radius", "machine.squareness"});
  p.c.machine = &p.machine;
  for (const int k : p.c.explanations.list[1].variants)
    p.c.explanations.variants[k].signature.setZero();  // it has no arm here
  Finding f;
  f.evidence = EvidenceSearch(p.c.model, p.c.hyper, p.c.explanations).evidence();
  f.evidence.log_bayes = {20 + std::log(0.6), 20 + std::log(0.4)};
  f.set = {0, 1};
  f.explanation = 0, f.probability = 0.9;
  for (const int k : f.set) f.best.push_back(best_variant(p.c.explanations, k, f.evidence));
  f.variant = f.best[0];
  p.result.findings = {f};
  drop_impossible_members(p.c, p.result);
  CHECK(p.result.findings.front().set == std::vector<int>{0});
}

TEST_CASE("a member that would need an impossible size is struck out, and what was believed of it is gone") {
  Planted p(4);
  p.plant("probe.stylus_bending", {-1, 0});  // a force that pulls
  p.plant("machine.squareness", {600, 0});
  p.c.explanations = named_explanations(p.c.touches, p.c.rows, {"probe.stylus_bending", "machine.squareness"});
  p.c.machine = &p.machine;
  Finding f;
  f.evidence = EvidenceSearch(p.c.model, p.c.hyper, p.c.explanations).evidence();
  f.evidence.log_bayes = {20 + std::log(0.6), 20 + std::log(0.4)};
  f.explanation = 0;
  f.set = {0, 1};
  f.probability = 0.9;
  for (const int k : f.set) f.best.push_back(best_variant(p.c.explanations, k, f.evidence));
  f.variant = f.best[0];
  p.result.findings = {f};
  drop_impossible_members(p.c, p.result);
  const Finding& left = p.result.findings.front();
  CHECK(left.set == std::vector<int>{1});
  CHECK(left.explanation == 1);
  // 0.54 was believed of what is impossible, and 0.36 of this: 0.36 of the 0.46 that is left of all.
  CHECK(left.probability == doctest::Approx(0.36 / 0.46));
}
