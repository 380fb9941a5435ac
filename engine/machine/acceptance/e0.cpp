// E0 (E of the 2001 edition): seven lines, tip straight below the ram.
//
// Which end a line starts at matters: errors are zero at home, so lengths that start there meet
// smaller ones, and the share accepted moves by some percent. The axes start at home; of each
// diagonal's two corners the one is taken that makes the four starting points alternate corners of
// the volume, one of them home: no end of any axis is favoured.
#include "engine/machine/acceptance/acceptance.hpp"

namespace abbe {
namespace {

std::vector<TestLine> e0_lines(const Machine& machine) {
  static constexpr struct {
    std::string_view name;
    char mark;
    Vec3 runs;
  } all[] = {{"x", 'x', {1, 0, 0}},    {"y", 'y', {0, 1, 0}},    {"z", 'z', {0, 0, 1}},   {"d1", '1', {1, 1, 1}},
             {"d2", '2', {1, -1, -1}}, {"d3", '3', {-1, 1, -1}}, {"d4", '4', {-1, -1, 1}}};
  std::vector<TestLine> out;
  for (const auto& [name, mark, runs] : all)
    out.push_back(central_line(machine, "E0", name, mark, runs, kTestTip, machine.specification.mpe));
  return out;
}

}  // namespace

extern const AcceptanceTest length_e0_test{
    .name = "E0",
    .help =
        "five lengths on each of seven lines: the axes and the space diagonals, with the tip below "
        "the ram",
    .source = "ISO 10360-2:2001 (E) and ISO 10360-2:2009 (E0)",
    .lines = e0_lines,
};

}  // namespace abbe
