// What simulated and recorded touches fill alike in a TouchScene.
#pragma once

#include "engine/effects/effect.hpp"
#include "engine/machine/machine.hpp"
#include "engine/run/sensor.hpp"

namespace abbe {

/// The stylus system as effects see it.
StylusScene stylus_scene(const Sensor&);
/// How the machine is built: travel of the axes, what their carriages carry, and their levers, from the
/// readings and the stylus of the scene.
void set_structure(const Machine&, TouchScene&);

}  // namespace abbe
