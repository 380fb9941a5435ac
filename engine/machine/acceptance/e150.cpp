// E150: the tip stands 150 mm off the axis of the ram, across the plane of the line.
//
// A tip below the ram has next to no lever for the roll of the ram, so E0 cannot see that error. An
// offset of 150 mm across the plane of a vertical face diagonal turns the roll into an error along
// the diagonal, of one sign for either side. The standard has one of the two opposite directions
// tested; a virtual test costs nothing, so both are. The carriages run over the middle of their
// travels for either side, as for E0; the tip is then 150 mm off the middle.
#include "engine/machine/acceptance/acceptance.hpp"

namespace abbe {
namespace {

std::vector<TestLine> e150_lines(const Machine& machine) {
  constexpr double kOffset_mm = 150;
  static constexpr struct {
    std::string_view name;
    char mark;
    Vec3 runs, across;
  } all[] = {{"yz+", 'a', {0, 1, 1}, {1, 0, 0}},
             {"yz-", 'b', {0, 1, 1}, {-1, 0, 0}},
             {"xz+", 'c', {1, 0, 1}, {0, 1, 0}},
             {"xz-", 'd', {1, 0, 1}, {0, -1, 0}}};
  std::vector<TestLine> out;
  if (const auto& mpe = machine.specification.e150_mpe)
    for (const auto& [name, mark, runs, across] : all)
      out.push_back(central_line(machine, "E150", name, mark, runs, kTestTip + kOffset_mm * across, *mpe));
  return out;
}

}  // namespace

extern const AcceptanceTest length_e150_test{
    .name = "E150",
    .help =
        "five lengths on the diagonals of the yz and xz planes, with the tip 150 mm to either side "
        "of the plane",
    .source = "ISO 10360-2:2009 (E150)",
    .lines = e150_lines,
};

}  // namespace abbe
