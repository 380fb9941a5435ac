#include "engine/diagnose/findings/improvement.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "engine/diagnose/model/log_sums.hpp"
#include "engine/effects/effect.hpp"
#include "engine/lanes/random.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

constexpr int kSetups = 3, kInSetup = 16, kAllTouches = kSetups * kInSetup;

/// A recording on the bench that has 1.2 of one shape in it: the first explanation, whose only size is 1. The second
/// one has another shape. Both carry names of the catalogue, which nothing asks for their physics.
struct Found {
  Recording recording;
  Case c;
  SearchResult result;

  explicit Found(std::uint32_t seed = 13) {
    LinearModel& m = c.model;
    m.free = Matrix::Ones(kAllTouches, 1);
    m.random = Matrix(kAllTouches, 1);
    m.random_group = {0};
    m.noise_um = Vector::Constant(kAllTouches, 0.5);
    m.noise_group.assign(kAllTouches, 0);
    m.follows.assign(kAllTouches, 0);
    m.y = Vector(kAllTouches);
    recording.rows.resize(kAllTouches);
    c.recording = &recording;
    c.touches.touches.resize(kAllTouches);
    c.explanations.variants.resize(2);
    for (Variant& v : c.explanations.variants) v.signature = Matrix(kAllTouches, 1), v.sizes = {{1, 0}};
    for (int i = 0; i < kAllTouches; ++i) {
      recording.rows[i].touch = i + 1;
      c.touches.touches[i].row = i;
      c.touches.touches[i].scene.setup = 1 + i / kInSetup;
      c.rows.push_back(i);
      m.random(i) = std::cos(0.1 * i);
      c.explanations.variants[0].signature(i) = i % 4 < 2 ? 1 : -1;
      c.explanations.variants[1].signature(i) = i % 3 - 1;
      const double noise =
          normal_quantile(uniform_pair({seed, std::uint32_t(i), stream_of("improvement_test"), 0, 0, 0}).a);
      m.y(i) = 3 + 0.7 * m.random(i) + 1.2 * c.explanations.variants[0].signature(i) + 0.5 * noise;
    }
    for (int k = 0; k < 2; ++k) {
      Explanation e;
      e.name = k == 0 ? "machine.scale" : "machine.squareness";
      e.effect = find_effect(e.name);
      e.prior = 0.5;
      e.variants = {k};
      c.explanations.list.push_back(e);
      c.explanations.variants[k].explanation = k;
    }
    // A mismatch passes for noise: the recording alone asks for more of it than beside what was found.
    c.hyper.noise = Vector::Constant(1, 2.2);
    result.hyper.noise = result.hyper_of_likelier.noise = Vector::Constant(1, 1.0);
    Finding f;
    f.explanation = 0;
    f.variant = 0;
    f.set = {0};
    result.findings = {f};
    result.first.log_bayes = {20, 0};
    result.first.variant_log_bayes = {20, 0};
  }

  Improvement shown(Diagnosis& out) const {
    show_improvement(c, result, out);
    REQUIRE(out.improvement);
    return *out.improvement;
  }
};

/// The logarithm of the density of some touches, but for what all densities of as many share: covariance and unknown
/// offset as they are, the scale of the machine and the common factor of all variances summed over.
double log_density_of(const LinearModel& m, const std::vector<Eigen::Index>& rows, double noise, const Matrix* effect) {
  const Vector y = m.y(rows), z = m.random(rows, 0);
  const Eigen::Index n = y.size();
  std::vector<double> logs, prior;
  for (int k = 0; k < 7; ++k) {
    const double g = std::pow(1.25, (k - 3) / 3.0);
    prior.push_back(-0.5 * std::pow(std::log(g) / m.scale_spread, 2));
    Matrix v = 1e6 * Matrix::Ones(n, n) + g * g * z * z.transpose();
    v.diagonal().array() += std::pow(0.5 * noise, 2);
    if (effect) v += (*effect)(rows, 0) * (*effect)(rows, 0).transpose();
    const Cholesky root(v);
    const double half_log_determinant = root.half_log_determinant(), squares = root.whitened(y).squaredNorm();
    for (double log_f = -4; log_f < 4; log_f += 0.01)
      logs.push_back(prior.back() - half_log_determinant - 0.5 * double(n - 1) * log_f -
                     0.5 * squares * std::exp(-log_f) - 2 * log_f - 2 * std::exp(-log_f));
  }
  return log_sum_exp(logs) - log_sum_exp(prior);
}

std::vector<Eigen::Index> touches_outside(int setup) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < kAllTouches; ++i)
    if (i / kInSetup != setup) rows.push_back(i);
  return rows;
}

/// What touches of a setup have beyond the expectation given the others, um: of normal laws, noise as stated.
Vector beyond_others(const LinearModel& m, int setup, const Matrix* effect) {
  Matrix v = 1e6 * Matrix::Ones(kAllTouches, kAllTouches) + m.random * m.random.transpose();
  v.diagonal().array() += 0.25;
  if (effect) v += *effect * effect->transpose();
  const std::vector<Eigen::Index> rest = touches_outside(setup);
  const Matrix of_rest = v(rest, rest), cross = v(Eigen::all, rest);
  return m.y - cross * Cholesky(of_rest).solve(Vector(m.y(rest)));
}

}  // namespace

TEST_CASE("the gain is that in the density of each setup given the others") {
  const Found found;
  Diagnosis out;
  const Improvement i = found.shown(out);
  CHECK(i.scheme == "leave-one-setup-out");
  const Matrix& shape = found.c.explanations.variants[0].signature;
  const auto gain_of = [&](const std::vector<Eigen::Index>& rows) {
    return log_density_of(found.c.model, rows, 1.0, &shape) - log_density_of(found.c.model, rows, 2.2, nullptr);
  };
  double gain = 0, squares = 0;
  std::vector<double> by_setup;
  for (int s = 0; s < kSetups; ++s) {
    by_setup.push_back(gain_of(touches_outside(-1)) - gain_of(touches_outside(s)));
    gain += by_setup.back();
  }
  for (const double g : by_setup) squares += std::pow(g - gain / kSetups, 2);
  CHECK(i.log_score_gain == doctest::Approx(gain).epsilon(1e-4));
  CHECK(i.log_score_gain > 15);
  CHECK(i.se == doctest::Approx(std::sqrt(kSetups * squares / (kSetups - 1))).epsilon(1e-3));
  REQUIRE(out.runner_up);
  CHECK(out.runner_up->members == std::vector<std::string>{"machine.squareness"});
  CHECK(out.runner_up->log_score_gain < i.log_score_gain - 10);
}

TEST_CASE("residuals are what the other setups do not predict, without and with what was found") {
  const Found found;
  Diagnosis out;
  const Improvement i = found.shown(out);
  const Matrix& shape = found.c.explanations.variants[0].signature;
  REQUIRE(out.residuals.size() == kAllTouches);
  double before = 0, after = 0, bias_before = 0, bias_after = 0;
  for (int k = 0; k < kAllTouches; ++k) {
    const ResidualRow& r = out.residuals[k];
    CHECK(r.touch == k + 1);
    CHECK(std::abs(r.before_um - beyond_others(found.c.model, k / kInSetup, nullptr)(k)) < 1e-3);
    CHECK(std::abs(r.after_um - beyond_others(found.c.model, k / kInSetup, &shape)(k)) < 1e-3);
    before += r.before_um * r.before_um, after += r.after_um * r.after_um;
    bias_before += r.before_um * shape(k), bias_after += r.after_um * shape(k);
  }
  CHECK(std::abs(i.rms_before_um - std::sqrt(before / kAllTouches)) < 1e-9);
  CHECK(std::abs(i.rms_after_um - std::sqrt(after / kAllTouches)) < 1e-9);
  // all touches have as much of it
  CHECK(std::abs(i.bias_before_um - bias_before / kAllTouches) < 1e-9);
  CHECK(std::abs(i.bias_after_um - bias_after / kAllTouches) < 1e-9);
  CHECK(i.bias_before_um > 0.9);
  CHECK(i.chi2_per_dof_after < i.chi2_per_dof_before / 3);
}

TEST_CASE("nothing of the effect stays where it acts") {
  // All touches have as much of it, and what two thirds of them tell too much the others tell too little. What stays is the
  // pull of the prior on what 32 touches tell: 1.2 um / (1 + 32 / 0.5^2) = 0.009 um, a little more beside the machine.
  double sum = 0;
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    Diagnosis out;
    sum += Found(seed).shown(out).bias_after_um;
  }
  CHECK(std::abs(sum / 100 - 0.0093) < 0.002);
}

TEST_CASE("of an effect that is as large everywhere, rounding does not choose the touches of its bias") {
  Found found;
  Diagnosis out;
  const Improvement exact = found.shown(out);
  Matrix& shape = found.c.explanations.variants[0].signature;
  for (int i = 0; i < kAllTouches; ++i) shape(i) *= 1 + 1e-12 * i;
  const Improvement rounded = found.shown(out);
  CHECK(std::abs(rounded.bias_before_um - exact.bias_before_um) < 1e-9);
  CHECK(std::abs(rounded.bias_after_um - exact.bias_after_um) < 1e-9);
}

TEST_CASE("what shows in one setup alone is predicted within it") {
  Found found;
  Diagnosis out;
  Matrix& shape = found.c.explanations.variants[0].signature;
  for (int i = 0; i < kAllTouches; ++i) {
    found.c.touches.touches[i].scene.stylus.head_b_rad = 0.5 * (i % 4);
    if (i >= kInSetup) shape(i) = 0;
  }
  CHECK(found.shown(out).scheme == "leave-one-orientation-out");
  shape(kAllTouches - 1) = 0.5;  // what little one touch of another setup has of it tells nothing
  CHECK(found.shown(out).scheme == "leave-one-orientation-out");
  for (int i = 0; i < kAllTouches; ++i) shape(i) = i < kInSetup ? 1 : 5;  // nor where another may stand anywhere
  found.c.model.free = Matrix::Zero(kAllTouches, 1);
  found.c.model.free.bottomRows(kAllTouches - kInSetup).setOnes();
  CHECK(found.shown(out).scheme == "leave-one-orientation-out");
}

TEST_CASE("what is left out is the hardest that leaves others to learn from") {
  Found found;
  Diagnosis out;
  const auto scheme_with = [&](auto change) {
    for (int i = 0; i < kAllTouches; ++i) change(i, found.c.touches.touches[i].scene);
    return found.shown(out).scheme;
  };
  CHECK(scheme_with([](int i, TouchScene& s) { s.run = 1 + i / kInSetup; }) == "leave-one-setup-out");
  // two thirds in one setup: they can be learnt from no other
  CHECK(scheme_with([](int i, TouchScene& s) { s.setup = i < 2 * kInSetup ? 1 : i; }) == "leave-one-run-out");
  CHECK(scheme_with([](int i, TouchScene& s) { s.run = 1, s.stylus.head_b_rad = 0.5 * (i % 4); }) ==
        "leave-one-orientation-out");
  CHECK(scheme_with([](int, TouchScene& s) { s.stylus.head_b_rad = 0; }) == "leave-one-fifth-out");
}

TEST_CASE("where nothing was found only residuals are shown") {
  Found found;
  found.result.findings.clear();
  Diagnosis out;
  show_improvement(found.c, found.result, out);
  CHECK(!out.improvement);
  CHECK(!out.runner_up);
  REQUIRE(out.residuals.size() == kAllTouches);
  for (const auto& r : out.residuals) CHECK(r.before_um == r.after_um);
}
