#include "engine/diagnose/patterns/families.hpp"

namespace abbe::diagnose::patterns {

void over_head(const TouchFactors& f, Family& family) {
  if (!several(f.orientation)) return;
  family.add("orientation", along(indicator(f.orientation), f.normal));
  family.add_joint("orientation in time", along(by_group(trend(f), f.orientation), f.normal));
  family.add_joint("settling", along(by_group(settling(f.settled), f.orientation), f.normal));
  family.add_joint("over position", along(by_group(linear(f.place), f.orientation), f.normal));
}

}  // namespace abbe::diagnose::patterns
