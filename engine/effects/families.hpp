// The families of effects; each folder lists its own in its all.cpp.
#pragma once

#include "engine/effects/effect.hpp"

namespace abbe {

std::span<const Effect* const> thermal_effects();
std::span<const Effect* const> probe_effects();
std::span<const Effect* const> head_effects();
std::span<const Effect* const> machine_effects();
std::span<const Effect* const> part_effects();
std::span<const Effect* const> noise_effects();
/// Curves fitted to what the catalogue does not explain. They stand in machine files like any effect but are
/// no part of the catalogue: no recording is searched for them.
std::span<const Effect* const> empirical_effects();

}  // namespace abbe
