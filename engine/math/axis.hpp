// The three coordinate axes, and signed directions along them.
#pragma once

namespace abbe {

enum class Axis { x, y, z };

/// A signed coordinate direction: XDIR, -ZDIR.
struct AxisDirection {
  Axis axis{};
  int sign = 1;
};

}  // namespace abbe
