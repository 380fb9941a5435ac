// The list of empirical effects.
#include "engine/effects/empirical/empirical.hpp"
#include "engine/effects/families.hpp"

namespace abbe {

std::span<const Effect* const> empirical_effects() {
  static constexpr const Effect* list[] = {&kEmpiricalCurve, &kEmpiricalDirection, &kEmpiricalMap, &kEmpiricalOffset};
  return list;
}

std::vector<Neighbours> neighbouring_knots(const Effect& effect) {
  if (&effect == &kEmpiricalCurve) return neighbouring_curve_knots();
  if (&effect == &kEmpiricalMap) return neighbouring_map_nodes();
  return {};
}

}  // namespace abbe
