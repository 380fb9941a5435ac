#include "engine/diagnose/explanations/patterns/families.hpp"

namespace abbe::diagnose::patterns {

void over_run(const TouchFactors& f, Family& family) {
  if (!several(f.run)) return;
  family.add("offset", along(indicator(f.run), f.normal));
  family.add("form", by_group(along(smooth(f.place, 0.6, 6), f.normal), f.run));
  family.add("over direction", by_group(smooth(as_points(f.normal), 0.9, 8), f.run));
}

}  // namespace abbe::diagnose::patterns
