// The list of empirical effects.
#include "engine/effects/empirical/empirical.hpp"
#include "engine/effects/families.hpp"

namespace abbe {

std::span<const Effect* const> empirical_effects() {
  static constexpr const Effect* list[] = {&kEmpiricalCurve, &kEmpiricalDirection, &kEmpiricalMap, &kEmpiricalOffset};
  return list;
}

}  // namespace abbe
