#include "engine/diagnose/model/decompositions.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "engine/base/ids.hpp"

namespace abbe::diagnose {

namespace {

using Orthogonal = Eigen::CompleteOrthogonalDecomposition<Matrix>;

constexpr double kDependent = 1e-6;  // of the length of a column, whatever its unit: less is the rounding of targets

}  // namespace

Spectrum spectrum(const Matrix& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Tridiagonal tridiagonal(const Matrix& symmetric) {
  const Eigen::Tridiagonalization<Matrix> of(symmetric);
  return {of.diagonal(), of.subDiagonal(), of.matrixQ()};
}

Spectrum spectrum_beside(const Matrix& symmetric, const Matrix& positive) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> solver(symmetric, positive);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Matrix inverse_root(const Matrix& positive) {
  return Eigen::SelfAdjointEigenSolver<Matrix>(positive).operatorInverseSqrt();
}

Matrix factor_of(const Matrix& symmetric) {
  const auto [values, vectors] = spectrum(symmetric);
  return vectors * values.cwiseMax(0).cwiseSqrt().asDiagonal();
}

Matrix no_wider(const Matrix& factor) {
  if (factor.cols() <= factor.rows()) return factor;
  const Eigen::HouseholderQR<Matrix> qr(factor.transpose());
  const Matrix triangle = qr.matrixQR().topRows(factor.rows()).triangularView<Eigen::Upper>();
  return triangle.transpose();
}

Cholesky::Cholesky(Matrix p, double a) {
  p.diagonal().array() += a;
  const Eigen::LLT<Matrix> decomposed(p);
  ABBE_CHECK(decomposed.info() == Eigen::Success);
  lower_ = decomposed.matrixL();
}

Matrix Cholesky::solve(const Matrix& b) const {
  return lower_.transpose().triangularView<Eigen::Upper>().solve(whitened(b));
}

Vector Cholesky::solve(const Vector& b) const {
  return lower_.transpose().triangularView<Eigen::Upper>().solve(whitened(b));
}

Matrix Cholesky::inverse() const { return solve(Matrix(Matrix::Identity(lower_.rows(), lower_.cols()))); }

Matrix Cholesky::whitened(const Matrix& b) const { return lower_.triangularView<Eigen::Lower>().solve(b); }

Vector Cholesky::whitened(const Vector& b) const { return lower_.triangularView<Eigen::Lower>().solve(b); }

double Cholesky::half_log_determinant() const { return lower_.diagonal().array().log().sum(); }

Matrix least_squares(const Matrix& a, const Matrix& b) { return Orthogonal(a).solve(b); }

Vector least_squares(const Matrix& a, const Vector& b) { return Orthogonal(a).solve(b); }

Vector explained(const Matrix& gram, const Matrix& cross) {
  constexpr double kRidge = 1e-9;
  return cross.cwiseProduct(Cholesky(gram, kRidge * (gram.trace() + 1)).solve(cross)).colwise().sum();
}

Matrix pseudo_inverse(const Matrix& symmetric) { return Orthogonal(symmetric).pseudoInverse(); }

Matrix independent(const Matrix& columns) {
  const Vector length = columns.colwise().norm().cwiseMax(1e-300);
  Eigen::ColPivHouseholderQR<Matrix> qr(columns * length.cwiseInverse().asDiagonal());
  qr.setThreshold(kDependent);
  return qr.householderQ() * Matrix::Identity(columns.rows(), qr.rank());
}

}  // namespace abbe::diagnose
