// The list of the head's effects.
#include "engine/effects/families.hpp"
#include "engine/effects/head/head.hpp"

namespace abbe {

std::span<const Effect* const> head_effects() {
  static constexpr const Effect* list[] = {&kHeadAxisErrors, &kHeadReindexing, &kHeadSag, &kHeadQualification};
  return list;
}

}  // namespace abbe
