#include "engine/machine/effect_names.hpp"

#include <doctest/doctest.h>

using namespace abbe;

TEST_CASE("settings of one effect are told apart by a number from the second on") {
  CHECK(effect_names({{"machine.scale", {}}, {"noise.vibration", {}}, {"machine.scale", {}}, {"machine.scale", {}}}) ==
        std::vector<std::string>{"machine.scale", "noise.vibration", "machine.scale #2", "machine.scale #3"});
}
