#include "engine/diagnose/explanations/patterns/families.hpp"

namespace abbe::diagnose::patterns {

void over_sensor(const TouchFactors& f, Family& family) {
  if (!several(f.sensor)) return;
  const Matrix in = indicator(f.sensor);
  family.add("offset", side_by_side(along(in, f.normal), in));
  family.add("over position", along(by_group(smooth(f.place, 0.6, 8), f.sensor), f.normal));
  family.add("over direction", by_group(smooth(as_points(f.normal_on_probe), 0.9, 12), f.sensor));
  family.add("in time", by_group(side_by_side(along(trend(f), f.normal), trend(f)), f.sensor));
}

}  // namespace abbe::diagnose::patterns
