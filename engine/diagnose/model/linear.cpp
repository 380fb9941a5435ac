#include "engine/diagnose/model/linear.hpp"

#include <map>

namespace abbe::diagnose {

namespace {

/// The model with other columns in group 0.
LinearModel with_ensemble(const LinearModel& m, const Matrix& ensemble) {
  const std::vector<Eigen::Index> others = columns_of_group(m, false);
  LinearModel out = m;
  out.random = side_by_side(ensemble, m.random(Eigen::all, others));
  out.random_group.assign(static_cast<std::size_t>(ensemble.cols()), 0);
  for (const Eigen::Index k : others) out.random_group.push_back(m.random_group[k]);
  return out;
}

}  // namespace

std::vector<Eigen::Index> columns_of_group(const LinearModel& m, bool scaled) {
  std::vector<Eigen::Index> out;
  for (Eigen::Index k = 0; k < m.random.cols(); ++k)
    if ((m.random_group[k] == 0) == scaled) out.push_back(k);
  return out;
}

Matrix random_at_scale(const LinearModel& m, const Hyperparameters& h) {
  Matrix z = m.random;
  for (const Eigen::Index k : columns_of_group(m, true)) z.col(k) *= h.scale;
  return z;
}

Matrix side_by_side(Eigen::Index rows, std::span<const Matrix* const> list) {
  Eigen::Index columns = 0;
  for (const Matrix* m : list) columns += m->cols();
  Matrix out(rows, columns);
  columns = 0;
  for (const Matrix* m : list) {
    out.middleCols(columns, m->cols()) = *m;
    columns += m->cols();
  }
  return out;
}

Matrix side_by_side(const Matrix& a, const Matrix& b) {
  Matrix out(a.rows(), a.cols() + b.cols());
  out << a, b;
  return out;
}

std::vector<const Matrix*> pointers_to(const std::vector<Matrix>& list) {
  std::vector<const Matrix*> out;
  for (const Matrix& m : list) out.push_back(&m);
  return out;
}

std::size_t portion(std::span<const Matrix* const> list) {
  std::size_t count = 0;
  for (Eigen::Index columns = 0; count < list.size() && columns < kPortion; ++count) columns += list[count]->cols();
  return count;
}

std::vector<char> alone(const LinearModel& m) {
  constexpr double kNothing = 1e-6;  // of a row that X leaves
  const Matrix x = independent(m.noise_um.cwiseInverse().asDiagonal() * m.free);
  std::vector<char> out;
  for (Eigen::Index i = 0; i < x.rows(); ++i) out.push_back(1 - x.row(i).squaredNorm() < kNothing);
  return out;
}

LinearModel compact(const LinearModel& m) {
  constexpr double kNegligible = 1e-3;  // of the variance of one row, over all rows together
  const Vector weight = m.noise_um.cwiseInverse();
  const auto kept = [&](const Matrix& z) -> Matrix {
    if (z.cols() == 0) return z;
    const Matrix white = weight.asDiagonal() * z;
    const auto [values, vectors] = spectrum(white.transpose() * white);
    Eigen::Index first = 0;
    while (first < z.cols() && values(first) < kNegligible) ++first;
    return z * vectors.rightCols(z.cols() - first);
  };
  LinearModel out = with_ensemble(m, kept(m.random(Eigen::all, columns_of_group(m, true))));
  out.rough = kept(m.rough);
  return out;
}

LinearModel rougher(const LinearModel& m) { return with_ensemble(m, m.rough); }

LinearModel with_random(LinearModel m, const Matrix& columns) {
  m.random = side_by_side(m.random, columns);
  m.random_group.resize(static_cast<std::size_t>(m.random.cols()), 1);
  return m;
}

Matrix indicator(const std::vector<int>& group) {
  std::map<int, int> index;
  for (const int g : group) index.emplace(g, 0);
  int next = 0;
  for (auto& [g, i] : index) i = next++;
  Matrix out = Matrix::Zero(group.size(), next);
  for (std::size_t i = 0; i < group.size(); ++i) out(i, index[group[i]]) = 1;
  return out;
}

Matrix by_group(const Matrix& columns, const std::vector<int>& group) {
  const Matrix in = indicator(group);
  Matrix out = Matrix::Zero(columns.rows(), columns.cols() * in.cols());
  for (Eigen::Index g = 0; g < in.cols(); ++g)
    out.middleCols(g * columns.cols(), columns.cols()) = in.col(g).asDiagonal() * columns;
  return out;
}

Vector beside_free(const LinearModel& m, const Vector& displacement) {
  const Vector weight = m.noise_um.cwiseInverse();
  const Matrix free = independent(weight.asDiagonal() * m.free);
  const Vector white = weight.cwiseProduct(displacement);
  return m.noise_um.cwiseProduct(white - free * (free.transpose() * white));
}

LinearModel with_one_noise(LinearModel m) {
  m.noise_group.assign(m.noise_group.size(), 0);
  m.noise_groups = 1;
  return m;
}

LinearModel without_rows(const LinearModel& m, const std::vector<char>& dropped) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < m.y.size(); ++i)
    if (!dropped[i]) kept.push_back(i);
  LinearModel out;
  out.y = m.y(kept);
  out.free = m.free(kept, Eigen::all);
  out.random = m.random(kept, Eigen::all);
  if (m.rough.cols() > 0) out.rough = m.rough(kept, Eigen::all);
  for (const Matrix& function : m.uneven) out.uneven.push_back(function(kept, Eigen::all));
  out.random_group = m.random_group;
  out.scale_spread = m.scale_spread;
  out.quietest = m.quietest;
  out.largest_scale = m.largest_scale;
  out.noise_um = m.noise_um(kept);
  out.noise_groups = m.noise_groups;
  Eigen::Index before = -2;
  for (const Eigen::Index i : kept) {
    out.noise_group.push_back(m.noise_group[i]);
    out.follows.push_back(m.follows[i] && before == i - 1);
    before = i;
  }
  return out;
}

LinearModel with_free(const LinearModel& m, const std::vector<const Matrix*>& signatures) {
  LinearModel out = m;
  std::vector<const Matrix*> free = {&m.free};
  free.insert(free.end(), signatures.begin(), signatures.end());
  out.free = side_by_side(m.free.rows(), free);
  return out;
}

}  // namespace abbe::diagnose
