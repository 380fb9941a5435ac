// The list of the effects of the part.
#include "engine/effects/families.hpp"
#include "engine/effects/part/part.hpp"

namespace abbe {

std::span<const Effect* const> part_effects() {
  static constexpr const Effect* list[] = {&kLoadBending, &kClamping, &kPartForm, &kPartShift};
  return list;
}

}  // namespace abbe
