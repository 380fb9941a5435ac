#include "engine/diagnose/model/marginal_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "engine/diagnose/model/log_sums.hpp"
#include "engine/lanes/elementary.hpp"
#include "engine/lanes/for_lanes.hpp"
#include "engine/lanes/vectors.hpp"

namespace abbe::diagnose {

namespace {

/// Axes whose sums are kept in registers.
constexpr int kAxes = 4;

}  // namespace

PreparedVariant::PreparedVariant(Eigen::Index first_column, Eigen::Index columns, std::vector<Size> at_sizes,
                                 Eigen::Index scales)
    : first(first_column), count(columns), sizes(std::move(at_sizes)) {
  const auto all = static_cast<Eigen::Index>(sizes.size());
  axes.resize(count, count * scales);
  carried.resize(all, count * scales);
  share.resize(all, count * scales);
  log_weight.resize(all, scales);
}

void PreparedVariant::set(Eigen::Index scale, const Matrix& g, double times) {
  const Tridiagonal t = tridiagonal(g);
  axes.middleCols(scale * count, count) = t.axes.transpose();
  for (Eigen::Index s = 0; s < log_weight.rows(); ++s) {
    const auto& [factor, log_prior] = sizes[static_cast<std::size_t>(s)];
    const double s2 = factor * times * factor * times;
    double log_determinant = 0, pivot = 1;
    for (Eigen::Index i = 0, at = scale * count; i < count; ++i, ++at) {
      const double beside = i > 0 ? s2 * t.beside(i - 1) : 0;
      carried(s, at) = beside / pivot;
      pivot = std::max(1.0, 1 + s2 * t.diagonal(i) - beside * carried(s, at));  // less than 1 is rounding
      share(s, at) = s2 / pivot;
      log_determinant += std::log(pivot);
    }
    log_weight(s, scale) = log_prior - 0.5 * log_determinant;
  }
}

struct MarginalLikelihood::AtScale {
  int recordings, columns, sizes;
  double shape;
  const double *axes, *carried, *share, *log_weight;  ///< of the variant
  const double* squares;                              ///< by recording
  const double* const* u;                             ///< of each column at the first scale
  std::ptrdiff_t after;                               ///< it, as many numbers
  double* along;                                      ///< by axis of some and recording: Q' u
  double *before, *left;  ///< by size and recording; `before`: what L^-1 Q' u is along the axis before
  double* logs;           ///< likewise, of each scale

  AtScale next() const {
    AtScale s = *this;
    s.axes += columns * columns, s.carried += columns * sizes, s.share += columns * sizes, s.log_weight += sizes;
    s.logs += sizes * recordings;
    s.squares += recordings, s.after += recordings;
    return s;
  }

  /// From one recording on, as many as a vector holds: u along some of the axes.
  template <int width, int together>
  [[gnu::always_inline]] inline void project(int axis, int first) const {
    using Numbers = typename VectorOf<width>::type;
    Numbers sums[together] = {};
    for (int column = 0; column < columns; ++column) {
      const Numbers of_column = reinterpret_cast<const Numbers&>(u[column][after + first]);
      for (int k = 0; k < together; ++k) sums[k] += axes[column * columns + axis + k] * of_column;
    }
    for (int k = 0; k < together; ++k) reinterpret_cast<Numbers&>(along[k * recordings + first]) = sums[k];
  }
  /// The same for all recordings.
  template <int width, int together>
  [[gnu::always_inline]] inline void project(int axis) const {
    int first = 0;
    for (; first + width <= recordings; first += width) project<width, together>(axis, first);
    if (first < recordings && recordings >= width) project<width, together>(axis, recordings - width);  // some again
    for (; first < recordings && recordings < width; ++first) project<1, together>(axis, first);
  }

  /// What the variant leaves of the sums of squares at each size, and what the log likelihoods at this scale then are.
  template <int width>
  [[gnu::always_inline]] inline void judge_sizes(double log_scale) const {
    for (int size = 0; size < sizes; ++size) {
      double *const l = left + size * recordings, *const b = before + size * recordings;
      ABBE_NO_ALIAS
      for (int r = 0; r < recordings; ++r) l[r] = squares[r], b[r] = 0;
    }
    for (int axis = 0, together = 0; axis < columns; axis += together) {
      together = columns - axis < kAxes ? 1 : kAxes;
      if (together == 1)
        project<width, 1>(axis);
      else
        project<width, kAxes>(axis);
      for (int size = 0; size < sizes; ++size) {
        double *const l = left + size * recordings, *const b = before + size * recordings;
        for (int k = 0; k < together; ++k) {
          const double c = carried[(axis + k) * sizes + size], s = share[(axis + k) * sizes + size];
          const double* const a = along + k * recordings;
          ABBE_NO_ALIAS
          for (int r = 0; r < recordings; ++r) {
            b[r] = a[r] - c * b[r];
            l[r] -= s * (b[r] * b[r]);
          }
        }
      }
    }
    for (int size = 0; size < sizes; ++size) {
      const double *const l = left + size * recordings, weight = log_scale + log_weight[size];
      double* const log = logs + size * recordings;
      ABBE_NO_ALIAS
      for (int r = 0; r < recordings; ++r) log[r] = weight - shape * log_positive(l[r]);
    }
  }
};

MarginalLikelihood::MarginalLikelihood(Matrix squares, Vector log_scale, double shape)
    : squares_(std::move(squares)), log_scale_(std::move(log_scale)), shape_(shape) {
  top_.resize(static_cast<std::size_t>(squares_.rows()));
  along_.resize(kAxes * top_.size());
  by_scale_.resize(static_cast<std::size_t>(squares_.size()));
}

MarginalLikelihood::AtScale MarginalLikelihood::at_first_scale(const PreparedVariant& b, const WithData& u) {
  left_.resize(b.sizes.size() * top_.size());
  before_.resize(left_.size());
  logs_.resize(left_.size() * scales());
  return {.recordings = recordings(),
          .columns = static_cast<int>(b.count),
          .sizes = static_cast<int>(b.sizes.size()),
          .shape = shape_,
          .axes = b.axes.data(),
          .carried = b.carried.data(),
          .share = b.share.data(),
          .log_weight = b.log_weight.data(),
          .squares = squares_.data(),
          .u = u.data(),
          .after = 0,
          .along = along_.data(),
          .before = before_.data(),
          .left = left_.data(),
          .logs = logs_.data()};
}

Vector MarginalLikelihood::alone() {
  Vector out(recordings());
  on_lanes([n = recordings(), scales = scales(), shape = shape_, squares = squares_.data(),
            log_scale = log_scale_.data(), by_scale = by_scale_.data(), top = top_.data(), sums = out.data()] {
    for (int j = 0; j < scales; ++j) {
      ABBE_NO_ALIAS
      for (int r = j * n; r < (j + 1) * n; ++r) by_scale[r] = log_scale[j] - shape * log_positive(squares[r]);
    }
    log_sums_exp(scales, n, by_scale, top, sums);
  });
  return out;
}

void MarginalLikelihood::with(const PreparedVariant& b, const WithData& u, double* out) {
  on_vectors(vector_width(),
             [first = at_first_scale(b, u), scales = scales(), log_scale = log_scale_.data(), top = top_.data(),
              out](auto width) {
               AtScale s = first;
               for (int j = 0; j < scales; ++j, s = s.next()) s.judge_sizes<width>(log_scale[j]);
               log_sums_exp(scales * first.sizes, first.recordings, first.logs, top, out);
             });
}

ByScale MarginalLikelihood::alone_by_scale() {
  alone();
  ByScale out{Vector(scales()), squares_.row(0), {}};
  for (int j = 0; j < scales(); ++j) out.log_likelihood(j) = by_scale_[static_cast<std::size_t>(j * recordings())];
  return out;
}

ByScale MarginalLikelihood::with_by_scale(const PreparedVariant& b, const WithData& u) {
  ByScale out{Vector(scales()), Vector(scales()), Vector(scales())};
  AtScale s = at_first_scale(b, u);
  for (int j = 0; j < scales(); ++j, s = s.next()) {
    s.judge_sizes<1>(log_scale_(j));
    int best = 0;
    for (int size = 1; size < s.sizes; ++size)
      if (s.logs[size * s.recordings] > s.logs[best * s.recordings]) best = size;
    log_sums_exp(s.sizes, s.recordings, s.logs, top_.data(), by_scale_.data());
    out.log_likelihood(j) = by_scale_.front();
    out.squares(j) = s.left[best * s.recordings];
    out.size(j) = b.sizes[static_cast<std::size_t>(best)].factor;
  }
  return out;
}

}  // namespace abbe::diagnose
