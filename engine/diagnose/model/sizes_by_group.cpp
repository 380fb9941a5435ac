#include "engine/diagnose/model/sizes_by_group.hpp"

#include <cmath>
#include <limits>

#include "engine/math/normal.hpp"

namespace abbe::diagnose {

double SizesByGroup::p() const { return dof == 0 ? 1 : chi2_above(chi2, dof); }

OneShape::OneShape(const LinearModel& model, const Hyperparameters& h, const std::vector<const Matrix*>& found,
                   std::size_t which)
    : precision_(model, h), y_(precision_.y()) {
  const Eigen::Index rows = model.y.size();
  found_ = precision_.seen(side_by_side(rows, found));
  information_ = inner(found_, found_);
  const Vector u = inner(found_, y_);
  coefficients_ = least_squares(information_, u);
  std::vector<const Matrix*> others = found;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(which));
  others_ = precision_.seen(side_by_side(rows, others));
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < which; ++k) first += found[k]->cols();
  shape_ = *found[which] * coefficients_.segment(first, found[which]->cols());
  const Precision::Seen shape = precision_.seen(shape_);
  explains_ = inner(shape, shape)(0, 0);
}

SizesByGroup OneShape::by(const std::vector<int>& group) const {
  // Of what tells less, a size in one group that is twice that in the others would not show.
  constexpr double kTellsNothing = 0.25;
  const Precision::Seen apart = precision_.seen(by_group(shape_, group));
  const Matrix information = inner(apart, apart), with_found = inner(apart, found_);
  const Vector u = inner(apart, y_);
  SizesByGroup out;
  // beside all that was found, whatever its size
  const Spectrum contrasts =
      spectrum(information - with_found * least_squares(information_, Matrix(with_found.transpose())));
  const Vector t = contrasts.vectors.transpose() * (u - with_found * coefficients_);
  for (Eigen::Index k = 0; k < t.size(); ++k) {
    const double tells = contrasts.values(k);
    if (tells < kTellsNothing) continue;
    out.chi2 += t(k) * t(k) / tells;
    ++out.dof;
  }
  // beside what else was found
  Matrix g = information;
  Vector v = u;
  if (others_.rows.cols() > 0) {
    const Matrix across = inner(apart, others_), taken = across * pseudo_inverse(inner(others_, others_));
    g -= taken * across.transpose();
    v -= taken * inner(others_, y_);
  }
  const Matrix covariance = pseudo_inverse(g);
  out.size = covariance * v;
  out.u = Vector::Constant(v.size(), std::numeric_limits<double>::infinity());
  for (Eigen::Index k = 0; k < v.size(); ++k)
    if (information(k, k) >= kTellsNothing) out.u(k) = std::sqrt(std::max(0.0, covariance(k, k)));
  return out;
}

}  // namespace abbe::diagnose
