#include "engine/diagnose/findings/search.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <set>

#include "engine/diagnose/explanations/catalogue.hpp"
#include "engine/diagnose/model/restricted_likelihood.hpp"
#include "engine/effects/effect.hpp"
#include "tests/unit/diagnose/scattered.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

/// What is found where the names, and one pattern beside them, have these probabilities.
Finding found(const std::vector<double>& names, double pattern, bool catalogue) {
  Explanations all;
  Evidence evidence;
  const auto add = [&](const Effect* effect, double probability) {
    Explanation e;
    e.effect = effect;
    e.prior = probability;
    e.variants = {static_cast<int>(all.variants.size())};
    all.variants.emplace_back();
    all.list.push_back(e);
    evidence.log_bayes.push_back(5);  // nats: the recording speaks for all
    evidence.variant_log_bayes.push_back(0);
  };
  for (const double probability : names) add(find_effect("machine.scale"), probability);
  add(nullptr, pattern);
  return finding_of(all, evidence, catalogue);
}

}  // namespace

TEST_CASE("an effect with a direction is sought along any, and along each axis") {
  const Planted at(1);
  const Explanations all = named_explanations(at.c.touches, at.c.rows, {"machine.step"});
  std::map<int, std::set<Eigen::Index>> columns;  // by axis
  for (const Variant& v : all.variants) columns[v.axis].insert(v.signature.cols());
  CHECK(columns == std::map<int, std::set<Eigen::Index>>{{-1, {3}}, {0, {1}}, {1, {1}}, {2, {1}}});
}

TEST_CASE("a spread of indexings is not judged by two of them") {
  Planted at(1);
  const auto judged = [&](int visits) {
    for (int i = 0; i < at.count(); ++i) at.scene(i).visit = i % visits;
    return !named_explanations(at.c.touches, at.c.rows, {"head.reindexing"}).list.empty();
  };
  CHECK_FALSE(judged(2));
  CHECK(judged(3));
}

TEST_CASE("what the recording does not speak for is in no set") {
  Explanations all;
  Evidence evidence;
  for (const double log_bayes : {3.0, 2.0, 0.1}) {
    Explanation e;
    e.effect = find_effect("machine.scale");
    e.prior = 1.0 / 3;
    e.variants = {static_cast<int>(all.variants.size())};
    all.variants.emplace_back();
    all.list.push_back(e);
    evidence.log_bayes.push_back(log_bayes);
    evidence.variant_log_bayes.push_back(log_bayes);
  }
  CHECK(finding_of(all, evidence, true).set == std::vector<int>{0, 1});
}

TEST_CASE("a set of names ends where it holds 92 % of what the names have") {
  const Finding sure = found({0.02, 0.93, 0.05}, 0, true);
  CHECK(sure.set == std::vector<int>{1});
  CHECK(sure.probability == doctest::Approx(0.93));
  const Finding two = found({0.02, 0.91, 0.07}, 0, true);
  CHECK(two.set == std::vector<int>{1, 2});
  CHECK(two.probability == doctest::Approx(0.98));
  const Finding beside = found({0.01, 0.465, 0.025}, 0.5, true);
  CHECK(beside.set == std::vector<int>{1});
  CHECK(beside.probability == doctest::Approx(0.465));
  CHECK(found({0.1, 0.2}, 0.7, false).set == std::vector<int>{2});
}

TEST_CASE("whether a machine is rougher shows beside what was found") {
  constexpr int kBumps = 8;
  Planted p(5);
  Matrix& rough = p.c.model.rough;
  rough.resize(p.count(), kBumps);
  for (int k = 0; k < kBumps; ++k)
    for (int i = 0; i < p.count(); ++i)
      rough(i, k) = p.scene(i).normal.y * std::exp(-0.5 * std::pow((p.scene(i).point.x - 500.0 * k / kBumps) / 30, 2));
  for (int k = 0; k < kBumps; ++k) p.c.model.y += p.normal(k, 7) * rough.col(k);
  p.plant("machine.scale", {100, 0});  // as an error of the specification's functions it is a hundred times too large
  p.c.hyper = estimate(p.c.model);
  p.find({"machine.scale"});
  CHECK_FALSE(EvidenceSearch(p.c.model, p.c.hyper, p.c.explanations).more_likely_rough());
  fit_beside_findings(p.c, p.result);
  CHECK(p.c.rough);
  CHECK(p.result.hyper_of_likelier.scale < 3);
}

TEST_CASE("what displaces most is first") {
  Planted p(4);
  p.plant("probe.tip_radius", {0.4, 0});
  p.plant("machine.squareness", {45, 0});
  const std::vector<std::string> names{"probe.tip_radius", "machine.squareness"};
  p.c.explanations = named_explanations(p.c.touches, p.c.rows, names);
  const Evidence evidence = EvidenceSearch(p.c.model, p.c.hyper, p.c.explanations).evidence();
  std::vector<Finding> findings;
  for (int k = 0; k < 2; ++k) {
    REQUIRE(p.c.explanations.list[k].name == names[k]);
    Finding f;
    f.explanation = k;
    f.variant = best_variant(p.c.explanations, k, evidence);
    findings.push_back(f);
  }
  put_largest_first(p.c, findings);
  CHECK(findings[0].explanation == 1);
  CHECK(findings[1].explanation == 0);
  put_largest_first(p.c, findings);
  CHECK(findings[0].explanation == 1);
}
