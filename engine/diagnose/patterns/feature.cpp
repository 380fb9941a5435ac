#include "engine/diagnose/patterns/families.hpp"

namespace abbe::diagnose::patterns {

void over_feature(const TouchFactors& f, Family& family) {
  if (!several(f.feature)) return;
  const Matrix in = indicator(f.feature);
  family.add("size", in);
  family.add_joint("size in time", by_group(trend(f), f.feature));
  family.add("offset on the part", along(in, f.normal_on_part));
  family.add("form", by_group(smooth(as_points(f.normal), 0.9, 8), f.feature));
}

}  // namespace abbe::diagnose::patterns
