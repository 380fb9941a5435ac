#include "engine/diagnose/explanations/patterns/families.hpp"

namespace abbe::diagnose::patterns {

namespace {

/// Along the reading of one axis: in every direction or in one, or yielding to both sides across one axis.
std::vector<Matrix> along_a_guide(const TouchFactors& f) {
  std::vector<Matrix> out;
  for (const Points& reading : f.reading) {
    const Matrix course = rugged(reading, 0.15, 24);
    for (Matrix& m : along_all_or_one(course, f.normal)) out.push_back(std::move(m));
    for (int k = 0; k < 3; ++k) out.push_back(Vector(component(f.normal, k).array().square()).asDiagonal() * course);
  }
  return out;
}

/// Around one place of the machine, or at one reading of one or two of its axes.
std::vector<Matrix> one_place(const TouchFactors& f) {
  constexpr int kMost = 24;
  std::vector<Matrix> out;
  for (int axes = 1; axes < 8; ++axes) {
    Points at(f.place.size());
    for (std::size_t i = 0; i < at.size(); ++i)
      for (int k = 0; k < 3; ++k)
        if (axes >> k & 1) at[i].push_back(f.reading[k][i][0]);
    for (const double width : {0.1, 0.2})
      for (const auto& centre : centres(at, 2 * width, kMost)) out.push_back(along(bump(at, centre, width), f.normal));
  }
  return out;
}

}  // namespace

void over_position(const TouchFactors& f, Family& family) {
  family.add("along a guide", along_a_guide(f));
  family.add("one place", one_place(f));
  family.add("in time", along(products(smooth(f.place, 0.6, 8), trend(f)), f.normal));
  if (f.one_round) return;  // what is smooth over the place is smooth over the direction there, and counts once
  family.add("with direction", rugged_over({{f.place, 0.1}, {as_points(f.normal), 0.9}}, 100));
  family.add("smooth", along(smooth(f.place, 0.6, 14), f.normal));
  family.add("patch", along(smooth(f.place, 0.25, 26), f.normal));
  family.add("height", smooth(f.place, 0.4, 24));
}

}  // namespace abbe::diagnose::patterns
