#include "engine/diagnose/evidence.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "engine/lanes/random.hpp"

namespace abbe::diagnose {

struct EvidenceSearch::Data {
  Vector z, rest;                   ///< in the basis of the ensemble, and what is outside of it
  double rest_squares = 0;
};

EvidenceSearch::EvidenceSearch(const LinearModel& model, const Hyperparameters& h, const Explanations& explanations)
    : explanations_(explanations.list), rotated_(model, h) {
  for (const Block& block : explanations.blocks) {
    const Matrix projected = rotated_.project(block.signature);
    Projected p;
    p.coordinates = rotated_.coordinates(projected);
    p.remainder = rotated_.remainder(projected, p.coordinates);
    p.square = p.remainder.transpose() * p.remainder;
    blocks_.push_back(std::move(p));
  }
  const Data data = of_recording();
  // A plan has no values yet: what it can tell is judged at the level that was stated.
  const bool plan = data.rest_squares == 0 && data.z.squaredNorm() == 0;
  if (!plan) level_ = fit_level(rotated_.lambda(), data.z, data.rest_squares, rotated_.rest_dof());
}

EvidenceSearch::Data EvidenceSearch::of_recording() const {
  Data d;
  d.z = rotated_.z();
  d.rest = rotated_.remainder(rotated_.y(), d.z);
  d.rest_squares = d.rest.squaredNorm();
  return d;
}

EvidenceSearch::Data EvidenceSearch::simulated(std::uint64_t seed, int replicate) const {
  constexpr std::uint32_t stream = stream_of("diagnose.bootstrap");
  const auto normals = [&](Vector& v, std::uint32_t site) {
    for (Eigen::Index i = 0; i < v.size(); i += 2) {
      const UniformPair p = uniform_pair({seed, static_cast<std::uint32_t>(replicate), stream, site + static_cast<std::uint32_t>(i), 0, 0});
      v(i) = normal_quantile(p.a);
      if (i + 1 < v.size()) v(i + 1) = normal_quantile(p.b);
    }
  };
  Data d;
  d.z.resize(rotated_.rank());
  normals(d.z, 0);
  d.z = (level_.g2 * rotated_.lambda().array() + level_.s2).sqrt() * d.z.array();
  Vector white(rotated_.rows());
  normals(white, 1u << 20);
  d.rest = rotated_.off_model(white) * std::sqrt(level_.s2);
  d.rest_squares = d.rest.squaredNorm();
  return d;
}

Evidence EvidenceSearch::evaluate(const Data& d) const {
  const Level level = fit_level(rotated_.lambda(), d.z, d.rest_squares, rotated_.rest_dof());
  const Vector weight = (level.g2 * rotated_.lambda().array() + level.s2).inverse();
  const Vector z = weight.array() * d.z.array();
  Evidence out;
  for (const Projected& p : blocks_) {
    const Matrix g = p.coordinates.transpose() * weight.asDiagonal() * p.coordinates + p.square / level.s2;
    const Vector u = p.coordinates.transpose() * z + p.remainder.transpose() * d.rest / level.s2;
    std::vector<double> sizes;
    for (const double s : kSizes) {
      const Matrix m = Matrix::Identity(g.rows(), g.cols()) + s * s * g;
      const Eigen::LLT<Matrix> llt(m);
      const Vector v = llt.matrixL().solve(u);
      sizes.push_back(0.5 * s * s * v.squaredNorm() - llt.matrixLLT().diagonal().array().log().sum() - std::log(double(std::size(kSizes))));
    }
    out.block_log_bayes.push_back(log_sum_exp(sizes));
  }
  std::vector<double> all;
  for (const Explanation& e : explanations_) {
    std::vector<double> variants;
    for (const int k : e.blocks) variants.push_back(out.block_log_bayes[k] - std::log(double(e.blocks.size())));
    out.log_bayes.push_back(log_sum_exp(variants));
    all.push_back(std::log(e.prior) + out.log_bayes.back());
  }
  out.statistic = log_sum_exp(all);
  return out;
}

Evidence EvidenceSearch::evidence() const { return evaluate(of_recording()); }

std::vector<Evidence> EvidenceSearch::bootstrap(double observed, int replicates, std::uint64_t seed, int threads) const {
  constexpr int kBatch = 20, kEnough = 10;
  std::vector<Evidence> out;
  int extreme = 0;
  while (static_cast<int>(out.size()) < replicates && extreme < kEnough) {
    const int first = static_cast<int>(out.size()), count = std::min(kBatch, replicates - first);
    out.resize(first + count);
    std::atomic<int> next = first;
    const auto work = [&] {
      for (int r = next++; r < first + count; r = next++) out[r] = evaluate(simulated(seed, r));
    };
    {
      std::vector<std::jthread> pool;
      for (int t = 1; t < threads; ++t) pool.emplace_back(work);
      work();
    }
    for (int r = first; r < first + count; ++r) extreme += out[r].statistic >= observed ? 1 : 0;
  }
  return out;
}

EvidenceSearch::Information EvidenceSearch::information(int block) const {
  const Data d = of_recording();
  const Projected& p = blocks_[block];
  const Vector weight = (level_.g2 * rotated_.lambda().array() + level_.s2).inverse();
  return {between(block, block), p.coordinates.transpose() * Vector(weight.array() * d.z.array()) + p.remainder.transpose() * d.rest / level_.s2};
}

Matrix EvidenceSearch::between(int a, int b) const {
  const Vector weight = (level_.g2 * rotated_.lambda().array() + level_.s2).inverse();
  return blocks_[a].coordinates.transpose() * weight.asDiagonal() * blocks_[b].coordinates +
         blocks_[a].remainder.transpose() * blocks_[b].remainder / level_.s2;
}

double tail_probability(double observed, std::vector<double> simulated) {
  const double n = static_cast<double>(simulated.size());
  std::sort(simulated.begin(), simulated.end());
  const auto above = static_cast<double>(simulated.end() - std::lower_bound(simulated.begin(), simulated.end(), observed));
  const std::size_t tail = simulated.size() / 10;
  if (above >= 8 || tail < 10) return (above + 1) / (n + 1);
  const double from = simulated[simulated.size() - tail - 1];
  double mean = 0;
  for (std::size_t k = simulated.size() - tail; k < simulated.size(); ++k) mean += (simulated[k] - from) / double(tail);
  return std::max(1e-12, double(tail) / n * std::exp(-(observed - from) / std::max(mean, 1e-9)));
}

double log_sum_exp(const std::vector<double>& v) {
  const double top = *std::max_element(v.begin(), v.end());
  double sum = 0;
  for (const double x : v) sum += std::exp(x - top);
  return top + std::log(sum);
}

}  // namespace abbe::diagnose
