#include "engine/diagnose/patterns/families.hpp"

namespace abbe::diagnose::patterns {

namespace {

/// Along the reading of one axis: in every direction or in one.
std::vector<Matrix> along_a_guide(const TouchFactors& f) {
  std::vector<Matrix> out;
  for (const Points& reading : f.reading) {
    const Matrix course = rugged(reading, 0.15, 24);
    for (Matrix& m : along_all_or_one(course, f.normal)) out.push_back(std::move(m));
  }
  return out;
}

}  // namespace

void over_position(const TouchFactors& f, Family& family) {
  family.add("smooth", along(smooth(f.place, 0.6, 14), f.normal));
  family.add("patch", along(smooth(f.place, 0.25, 26), f.normal));
  family.add("height", smooth(f.place, 0.4, 24));
  family.add("along a guide", along_a_guide(f));
  family.add_joint("in time", along(products(smooth(f.place, 0.6, 8), trend(f)), f.normal));
}

}  // namespace abbe::diagnose::patterns
