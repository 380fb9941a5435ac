#include "engine/diagnose/explanations/patterns/families.hpp"

namespace abbe::diagnose::patterns {

void over_setup(const TouchFactors& f, Family& family) {
  if (!several(f.setup)) return;
  family.add("form", by_group(along(smooth(f.place, 0.6, 6), f.normal), f.setup));
  family.add("settling", along(by_group(products(linear(f.place), settling(f.clamped)), f.setup), f.normal));
}

}  // namespace abbe::diagnose::patterns
