#include "engine/diagnose/model/precision.hpp"

#include "engine/diagnose/model/products.hpp"

namespace abbe::diagnose {

Precision::Precision(const LinearModel& m, const Hyperparameters& h) : project_(m, h), y_(m.y) {
  const Matrix z = project_(random_at_scale(m, h));
  Matrix square = Matrix::Identity(z.cols(), z.cols());
  square.selfadjointView<Eigen::Lower>().rankUpdate(z.transpose());
  reach_ = Cholesky(std::move(square)).whitened(Matrix(z.transpose()));
}

Precision::Seen Precision::Seen::operator*(const Matrix& coefficients) const {
  return {rows * coefficients, taken * coefficients};
}

Precision::Seen Precision::seen(const Matrix& patterns) const { return with_taken(project_.of_patterns(patterns)); }

Precision::Seen Precision::y() const { return with_taken(project_(y_)); }

Precision::Seen Precision::with_taken(Matrix rows) const {
  Matrix taken = product(reach_, rows);
  return {std::move(rows), std::move(taken)};
}

Matrix inner(const Precision::Seen& a, const Precision::Seen& b) {
  return a.rows.transpose() * b.rows - a.taken.transpose() * b.taken;
}

}  // namespace abbe::diagnose
