#include "engine/diagnose/model/power.hpp"

#include <doctest/doctest.h>
#include <algorithm>
#include <cmath>

#include "engine/diagnose/model/log_sums.hpp"
#include "engine/diagnose/model/restricted_likelihood.hpp"
#include "engine/lanes/random.hpp"
#include "tests/unit/diagnose/random_model.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

double standard_normal(std::uint32_t address) {
  return normal_quantile(uniform_pair({11, address, stream_of("evidence_test"), 0, 0, 0}).a);
}

LinearModel noise_only(int rows, std::uint32_t stream) {
  LinearModel m;
  m.free = Matrix::Ones(rows, 1);
  m.random = Matrix::Zero(rows, 2);
  for (int i = 0; i < rows; ++i) m.random(i, 0) = double(i) / rows, m.random(i, 1) = std::sin(0.1 * i);
  m.random_group.assign(2, 0);
  m.noise_um = Vector::Ones(rows);
  m.noise_group.assign(static_cast<std::size_t>(rows), 0);
  m.follows.assign(static_cast<std::size_t>(rows), 0);
  m.y.resize(rows);
  for (int i = 0; i < rows; ++i) m.y(i) = standard_normal(stream + static_cast<std::uint32_t>(i));
  return m;
}

/// Two explanations: a square wave and a parabola.
Explanations two(int rows) {
  Explanations all;
  for (int k = 0; k < 2; ++k) {
    Variant b;
    b.explanation = k;
    b.columns = {{0, 0, 1}};
    b.signature.resize(rows, 1);
    for (int i = 0; i < rows; ++i) b.signature(i, 0) = k == 0 ? (i / 5 % 2 ? 1 : -1) : std::pow(2.0 * i / rows - 1, 2);
    all.variants.push_back(b);
    Explanation e;
    e.name = k == 0 ? "square" : "parabola";
    e.prior = 0.5;
    e.variants = {k};
    all.list.push_back(e);
  }
  return all;
}

}  // namespace

namespace {

/// The Bayes factor of a variant of one column. L(g, s) = integral over the common factor v of N(y; 0, v V) times its
/// inverse gamma prior (shape 2, scale 2), done numerically here.
double log_bayes_by_definition(const LinearModel& m, const Variant& variant, const std::vector<Size>& sizes,
                               double low_scale, double high_scale) {
  const Eigen::Index n = m.y.size();
  Matrix kept = Matrix::Identity(n, n) + 1e7 * m.free * m.free.transpose(), scaled = Matrix::Zero(n, n);
  for (Eigen::Index k = 0; k < m.random.cols(); ++k)
    (m.random_group[k] == 0 ? scaled : kept) += m.random.col(k) * m.random.col(k).transpose();
  const auto log_likelihood = [&](double g, double size) {
    const Matrix v = kept + g * g * scaled + size * size * variant.signature * variant.signature.transpose();
    const Cholesky root(v);
    const double half_log_determinant = root.half_log_determinant(), squares = root.whitened(m.y).squaredNorm();
    std::vector<double> logs;
    for (double log_v = -4; log_v < 4; log_v += 0.01) {
      const double f = std::exp(log_v);
      // dv = v d(log v)
      logs.push_back(-half_log_determinant - 0.5 * double(n - 1) * log_v - 0.5 * squares / f - 2 * log_v - 2 / f);
    }
    return log_sum_exp(logs);
  };
  std::vector<double> alone, with;
  for (int k = 0; k < 7; ++k) {
    const double g = low_scale * std::pow(high_scale / low_scale, k / 6.0),
                 prior = -0.5 * std::pow(std::log(g) / m.scale_spread, 2);
    alone.push_back(prior + log_likelihood(g, 0));
    for (const Size& s : sizes) with.push_back(prior + s.log_prior + log_likelihood(g, s.factor));
  }
  return log_sum_exp(with) - log_sum_exp(alone);
}

}  // namespace

TEST_CASE("the Bayes factor is that of the definition, where columns keep their scale too") {
  const int n = 60;
  for (const bool some_keep_theirs : {false, true}) {
    LinearModel m = noise_only(n, 1);
    const Explanations all = two(n);
    m.y += 0.7 * all.variants[0].signature.col(0);
    if (some_keep_theirs) m = with_random(m, 0.3 * all.variants[0].signature + 2 * all.variants[1].signature);
    Hyperparameters h;
    h.noise = Vector::Ones(1);
    h.scale = 2;
    const EvidenceSearch search(m, h, all);
    CHECK(search.evidence().log_bayes[0] ==
          doctest::Approx(log_bayes_by_definition(m, all.variants[0], search.sizes(0), 1 / 1.25, 2.5)).epsilon(1e-4));
    if (!some_keep_theirs) CHECK(search.evidence().log_bayes[0] > search.evidence().log_bayes[1] + 3);
  }
}

TEST_CASE("what shows less than the noise even at thirty times what is typical explains nothing") {
  const int n = 100;
  LinearModel m = noise_only(n, 1);
  Explanations all = two(n);
  m.y += 5 * all.variants[1].signature.col(0);
  all.variants[0].signature = 1e-4 * m.y;  // the touches' own deviations, in the last digits of their readings
  Hyperparameters h;
  h.noise = Vector::Ones(1);
  const EvidenceSearch search(m, h, all);
  CHECK(search.evidence().log_bayes[0] <= 0);
  CHECK(search.evidence().log_bayes[1] > 3);
}

TEST_CASE("an ensemble of larger errors does not swallow an effect") {
  // The parabola is nearly within the span of the ensemble. Estimated alone, the ensemble would have to be
  // twenty times as large.
  const int n = 80;
  LinearModel m = noise_only(n, 7);
  for (int i = 0; i < n; ++i) m.random(i, 1) = std::pow(2.0 * i / n - 1, 2) - 0.4;
  m.random *= 0.5;
  const Explanations all = two(n);
  m.y += 10 * all.variants[1].signature.col(0);
  const Hyperparameters h = estimate(m);
  CHECK(h.scale > 3);
  CHECK(EvidenceSearch(m, h, all).evidence().log_bayes[1] > 2);
}

TEST_CASE("errors rougher than the ensemble are no mismatch") {
  const int n = 120;
  LinearModel m = noise_only(n, 9);
  const Explanations all = two(n);
  m.rough = Matrix::Zero(n, 12);
  for (int k = 0; k < 12; ++k)
    for (int i = 0; i < n; ++i) m.rough(i, k) = std::exp(-0.5 * std::pow((i - 10.0 * k) / 6, 2));
  for (int k = 0; k < 12; ++k) m.y += 5 * standard_normal(static_cast<std::uint32_t>(5000 + k)) * m.rough.col(k);
  Hyperparameters h;
  h.noise = Vector::Ones(1);
  h.scale = 4;
  const EvidenceSearch with_rough(m, h, all);
  CHECK(with_rough.rough() > 0.99);
  CHECK(with_rough.evidence().statistic < 2);
  // Smooth ones are not taken for rough.
  LinearModel smooth = noise_only(n, 12);
  smooth.rough = m.rough;
  CHECK(EvidenceSearch(smooth, h, all).rough() < 0.2);
}

TEST_CASE("one error function more uneven than the others is no mismatch") {
  const int n = 120;
  LinearModel m = noise_only(n, 21);
  const Explanations all = two(n);
  Matrix function(n, 8);
  for (int k = 0; k < 8; ++k)
    for (int i = 0; i < n; ++i) function(i, k) = std::exp(-0.5 * std::pow((i - 15.0 * k) / 9, 2));
  // As large as it may be, and of a shape that the parabola imitates.
  const Vector wave = function * Vector{{-2, -1, 0.5, 1.5, 1.5, 0.5, -1, -2}};
  m.y -= wave;
  Hyperparameters h;
  h.noise = Vector::Ones(1);
  CHECK(EvidenceSearch(m, h, all).evidence().log_bayes[1] > 10);
  m.uneven = {function};
  const EvidenceSearch search(m, h, all);
  CHECK(search.evidence().log_bayes[1] < 2);
  REQUIRE(search.uneven());
  // Without it, it counts as noise.
  CHECK(estimate(m).noise(0) > 1.3);
  CHECK(estimate(with_random(m, *search.uneven())).noise(0) == doctest::Approx(1).epsilon(0.15));
  LinearModel even = noise_only(n, 21);
  even.uneven = m.uneven;
  CHECK(!EvidenceSearch(even, h, all).uneven());
  // Where it cannot do what is seen, the mismatch stays.
  m.y += wave + 0.8 * all.variants[0].signature.col(0);
  CHECK(EvidenceSearch(m, h, all).evidence().log_bayes[0] > 10);
}

TEST_CASE("what goes on in the sequence is not taken for noise that neighbours share") {
  // Five slow waves: noise that neighbours share imitates them, and under it slow things tell little.
  const int n = 220;
  LinearModel m = noise_only(n, 31);
  m.follows.assign(n, 1);
  m.follows[0] = 0;
  Explanations all = two(n);
  for (int i = 0; i < n; ++i) all.variants[1].signature(i, 0) = std::sin(2 * kPi * 5 * i / n);
  m.y += all.variants[1].signature.col(0);
  const Hyperparameters h = estimate(m);
  REQUIRE(h.correlation > 0);
  CHECK(EvidenceSearch(m, h, all).evidence().log_bayes[1] > 20);
  // Noise that neighbours do share is no mismatch.
  m.y = noise_only(n, 32).y;
  for (int i = 1; i < n; ++i) m.y(i) = 0.5 * m.y(i - 1) + std::sqrt(0.75) * m.y(i);
  const Hyperparameters shared = estimate(m);
  REQUIRE(shared.correlation > 0);
  CHECK(EvidenceSearch(m, shared, all).evidence().log_bayes[1] < 2);
}

TEST_CASE("p-values without a mismatch are uniform") {
  // 60 recordings: the smallest p-values follow a binomial law; P(4 or more of 60 below 0.01) = 0.3 %, P(10
  // or more below 0.05) = 0.1 %.
  const int n = 50;
  const Explanations all = two(n);
  int below1 = 0, below5 = 0, above50 = 0;
  for (int k = 0; k < 60; ++k) {
    const LinearModel m = noise_only(n, static_cast<std::uint32_t>(1000 * (k + 1)));
    Hyperparameters h;
    h.noise = Vector::Ones(1);
    const EvidenceSearch search(m, h, all);
    const double observed = search.evidence().statistic;
    std::vector<double> simulated;
    for (const Evidence& e : search.bootstrap(observed, {}, {300, 0}, 5, 2)) simulated.push_back(e.statistic);
    const double p = tail_probability(observed, simulated);
    below1 += p < 0.01, below5 += p<0.05, above50 += p> 0.5;
  }
  CHECK(below1 <= 3);
  CHECK(below5 <= 9);
  CHECK(above50 >= 15);
  CHECK(above50 <= 45);
}

TEST_CASE("tails of the noise are no mismatch where they are simulated") {
  // Each touch by itself is an explanation, which is what tails look like. With 100 recordings of t noise of 4
  // degrees of freedom, P(6 or more below 0.01) = 0.05 %; simulated with normal noise, they are one in five.
  const int n = 150, recordings = 100;
  Explanations spots;
  for (int k = 0; k < n; k += 3) {
    Variant b;
    b.explanation = k / 3;
    b.columns = {{0, 0, 1}};
    b.signature = Matrix::Identity(n, n).col(k);
    spots.variants.push_back(b);
    Explanation e;
    e.prior = 3.0 / n;
    e.variants = {k / 3};
    spots.list.push_back(e);
  }
  int alarms = 0, alarms_of_normal = 0;
  for (int k = 0; k < recordings; ++k) {
    LinearModel m = noise_only(n, 0);
    m.y = NoiseLaw::student_t(4).simulated(n, 3, stream_of("evidence_test"), k);
    Hyperparameters h;
    h.noise = Vector::Ones(1);
    const EvidenceSearch search(m, h, spots);
    const double observed = search.evidence().statistic;
    const std::vector<double>& by_variant = search.evidence().variant_log_bayes;
    const auto likeliest = std::max_element(by_variant.begin(), by_variant.end()) - by_variant.begin();
    const NoiseLaw law(search.residuals_beside(spots.variants[static_cast<std::size_t>(likeliest)]));
    const auto p = [&](const NoiseLaw& simulated_with) {
      std::vector<double> simulated;
      for (const Evidence& e : search.bootstrap(observed, simulated_with, {200, 0}, 5, 2))
        simulated.push_back(e.statistic);
      return tail_probability(observed, simulated);
    };
    alarms += p(law) < 0.01, alarms_of_normal += p({}) < 0.01;
  }
  CHECK(alarms <= 5);
  CHECK(alarms_of_normal > 5);
}

TEST_CASE("where the decision is near, more recordings are simulated") {
  const LinearModel m = noise_only(40, 3);
  Hyperparameters h;
  h.noise = Vector::Ones(1);
  const EvidenceSearch search(m, h, two(40));
  const auto number_at = [&](double observed, double level) {
    return search.bootstrap(observed, {}, {300, level}, 1, 1).size();
  };
  std::vector<double> statistics;
  for (const Evidence& e : search.bootstrap(1e9, {}, {3000, 0}, 1, 2)) statistics.push_back(e.statistic);
  std::sort(statistics.begin(), statistics.end());
  const double at1 = statistics[2970], middle = statistics[1500];
  CHECK(number_at(at1, 0) == 300);
  CHECK(number_at(at1, 0.01) > 1000);  // until 20 lie beyond, one in a hundred
  CHECK(number_at(at1, 0.01) <= 1800);
  CHECK(number_at(at1, 0.001) == 300);  // ten times as probable as the level
  CHECK(number_at(middle, 0.01) < 100);
  CHECK(number_at(1e3, 0.01) == 300);
  // Threads simulate ahead, and what was not needed counts no more than if it had not been.
  for (const double observed : {at1, middle, statistics[2900], 1e3})
    for (const int threads : {2, 3, 16})
      CHECK(search.bootstrap(observed, {}, {300, 0.01}, 1, threads).size() == number_at(observed, 0.01));
}

TEST_CASE("four in five recordings show what the search is said to detect") {
  // Twenty simulated recordings tell the size to a quarter of a standard deviation: 80 % to within 10 %.
  const int n = 60, recordings = 300;
  LinearModel m = noise_only(n, 3);
  Hyperparameters h;
  h.noise = Vector::Ones(1);
  const Explanations all = two(n);
  const EvidenceSearch search(m, h, all);
  std::vector<double> alone;
  for (const Evidence& e : search.bootstrap(1e9, {}, {2000, 0}, 4, 2)) alone.push_back(e.statistic);
  std::sort(alone.begin(), alone.end());
  const double alarm = alone[1980];
  const Matrix shift = all.variants[0].signature / all.variants[0].signature.norm();
  Matrix drawn(n, 2);
  drawn << all.variants[0].signature, all.variants[1].signature;
  drawn /= drawn.norm();
  const Power power(search, {search, 2}, search, 300, 1, 2);
  const auto seen_share = [&](const Matrix& columns, double times) {
    int seen = 0;
    for (int k = 0; k < recordings; ++k) {
      const Vector size = columns.cols() == 1 ? Vector::Ones(1) : standard_normal(columns.cols(), 9, 77, k);
      const Vector y = noise_only(n, static_cast<std::uint32_t>(100 * (k + 1))).y + times * columns * size;
      seen += search.judge(search.seen(y)).front().statistic > alarm ? 1 : 0;
    }
    return seen / double(recordings);
  };
  CHECK(seen_share(shift, power.detected_from(shift, 0, 1, 100)) == doctest::Approx(0.8).epsilon(0.15));
  CHECK(std::isinf(power.detected_from(shift, 0, 1, 1)));
  // Of what is drawn anew in every recording some is always small: more is needed than of the same shift in all.
  CHECK(power.detected_from(drawn, 0, 1, 100) > 1.3 * power.detected_from(shift, 0, 1, 100));
}

TEST_CASE(
    "what the machine's errors take up is said to be detected from the size on that stands out of larger errors") {
  // The shift is as a machine's error may be: with it in them the errors seem larger, and the search compares with machines
  // that have such. Of 200 recordings 80 % are 160 +- 6, and 10 % more for the twenty that told the size.
  const int n = 60, recordings = 200;
  const double kLarger = 2;
  LinearModel plan = model_of(n, 1, 1, 0, 50'000'000);
  plan.random = Matrix(plan.random.leftCols(4)), plan.random_group.resize(4);
  plan.y.setZero();
  Hyperparameters h;
  h.noise = Vector::Ones(1);
  Explanations all = two(n);
  all.variants[0].signature = plan.random * Vector::Ones(4) / 2;
  const Matrix shift = all.variants[0].signature;
  const EvidenceSearch machines(plan, h, all);
  const auto reckons_with = [&](double scale) {
    LinearModel m = plan;
    m.y = machines.in_order(scale, 1, 1000);
    Hyperparameters larger = h;
    larger.scale = scale;
    return EvidenceSearch(m, larger, all);
  };
  const EvidenceSearch stated = reckons_with(1), larger = reckons_with(kLarger);
  const auto seen_share = [&](double times) {
    int seen = 0;
    for (int k = 0; k < recordings; ++k) {
      LinearModel m = plan;
      m.y = machines.in_order(1, 5, k) + times * shift;
      const EvidenceSearch search(m, estimate(m), all);
      const double observed = search.evidence().statistic;
      std::vector<double> alone;
      for (const Evidence& e : search.bootstrap(observed, {}, {300, 0.01}, 1, 1)) alone.push_back(e.statistic);
      seen += tail_probability(observed, alone) < 0.01 ? 1 : 0;
    }
    return seen / double(recordings);
  };
  const double said = Power(stated, {larger, kLarger}, machines, 300, 1, 2).detected_from(shift, 0, 1, 100),
               of_stated_ones = Power(stated, {stated, kLarger}, machines, 300, 1, 2).detected_from(shift, 0, 1, 100);
  CHECK(seen_share(said) == doctest::Approx(0.8).epsilon(0.15));
  CHECK(seen_share(of_stated_ones) < 0.6);
}

TEST_CASE("a recording is judged the same to the bit beside any number of others") {
  const int n = 41, recordings = 23;
  LinearModel m = model_of(n, 1, 1, 0.4, 8);
  m.random_group[11] = 1;
  Hyperparameters h;
  h.noise = Vector::Ones(1);
  h.correlation = 0.4;
  const EvidenceSearch search(m, h, two(n));
  const Matrix list = random_matrix(n, recordings, 9'000'000);
  const std::vector<Evidence> together = search.judge(search.seen(list));
  for (int k = 0; k < recordings; ++k) {
    const Evidence alone = search.judge(search.seen(list.col(k))).front();
    CHECK(alone.variant_log_bayes == together[static_cast<std::size_t>(k)].variant_log_bayes);
    CHECK(alone.log_null == together[static_cast<std::size_t>(k)].log_null);
  }
}

TEST_CASE("far tails are extrapolated, near ones counted") {
  std::vector<double> simulated;
  for (int k = 1; k <= 1000; ++k) simulated.push_back(-std::log((k - 0.5) / 1000));  // exponential
  CHECK(tail_probability(std::log(10.0), simulated) == doctest::Approx(0.1).epsilon(0.02));
  CHECK(std::log(tail_probability(std::log(1e5), simulated)) == doctest::Approx(std::log(1e-5)).epsilon(0.1));
}

TEST_CASE("a tail of thirty values is as uncertain as thirty values are") {
  // The next exponential value after k of mean 1 exceeds x with probability (1 + x / k)^-k; e^-x would be too sure.
  std::vector<double> simulated(269, -1.0);
  simulated.insert(simulated.end(), 1, 0.0);
  for (int k = 0; k < 30; ++k) simulated.push_back(k % 2 ? 0.5 : 1.5);
  CHECK(tail_probability(10, simulated) == doctest::Approx(0.1 * std::pow(1 + 10.0 / 30, -30)).scale(0));
}

TEST_CASE("what a p-value can say at most is what Sellke, Bayarri and Berger tabulate") {
  // Their table 1: the least error probability of rejecting, for a prior of one half.
  CHECK(1 - most_believed(0.05, 0.5) == doctest::Approx(0.289).epsilon(0.002));
  CHECK(1 - most_believed(0.01, 0.5) == doctest::Approx(0.111).epsilon(0.005));
  CHECK(1 - most_believed(0.001, 0.5) == doctest::Approx(0.0184).epsilon(0.005));
  CHECK(most_believed(0.5, 0.01) == doctest::Approx(0.01));
  CHECK(most_believed(0, 0.01) == doctest::Approx(1));
}
