#include "engine/diagnose/explanations/patterns/families.hpp"

namespace abbe::diagnose::patterns {

namespace {

/// One spot of one feature.
std::vector<Matrix> one_spot(const TouchFactors& f) {
  constexpr int kMost = 12;
  std::vector<Matrix> out;
  const Points spots = as_points(f.normal_on_part);
  const Matrix in = indicator(f.feature);
  for (Eigen::Index k = 0; k < in.cols(); ++k) {
    Points mine;
    for (std::size_t i = 0; i < spots.size(); ++i)
      if (in(static_cast<Eigen::Index>(i), k) > 0) mine.push_back(spots[i]);
    for (const double width : {0.35, 0.7})
      for (const auto& centre : centres(mine, 2 * width, kMost))
        out.push_back(in.col(k).asDiagonal() * bump(spots, centre, width));
  }
  return out;
}

/// One feature moves on the part as time goes on.
std::vector<Matrix> one_in_time(const TouchFactors& f) {
  std::vector<Matrix> out;
  const Matrix in = indicator(f.feature), moved = along(rugged(f.time, 0.2, 12), f.normal_on_part);
  for (Eigen::Index k = 0; k < in.cols(); ++k) out.push_back(in.col(k).asDiagonal() * moved);
  return out;
}

/// Lobes of the part about one of its axes, more than a form of the catalogue has; of all features alike, or of
/// each by itself about its own.
std::vector<Matrix> lobes_of_the_part(const TouchFactors& f) {
  constexpr int kFirst = 4, kLast = 12;
  std::vector<Matrix> out;
  for (int count = kFirst; count <= kLast; ++count) {
    for (int axis = 0; axis < 3; ++axis) out.push_back(lobes(f.normal_on_part, axis, count));
    if (several(f.feature)) out.push_back(by_group(lobes(f.normal_on_part, 2, count), f.feature));
  }
  return out;
}

}  // namespace

void over_feature(const TouchFactors& f, Family& family) {
  family.add("lobes", lobes_of_the_part(f));
  if (!several(f.feature)) return;
  const Matrix in = indicator(f.feature);
  family.add("size", in);
  family.add("size in time", by_group(trend(f), f.feature));
  family.add("offset on the part", along(in, f.normal_on_part));
  family.add("form", by_group(smooth(as_points(f.normal), 0.9, 8), f.feature));
  family.add("one spot", one_spot(f));
  family.add("one of them in time", one_in_time(f));
}

}  // namespace abbe::diagnose::patterns
