// What the drawn virtual machine of `abbe machine show` does in its volume and in its acceptance
// test, as text: the paper's Figs. 6 and 7.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/machine/error_state.hpp"
#include "engine/math/units.hpp"
#include "programs/commands/machine_report.hpp"

namespace abbe {

namespace {

/// Errors over lengths in cells of one character. The middle row is zero.
class Canvas {
 public:
  Canvas(double longest_mm, double range_mm)
      : longest_mm_(longest_mm), range_mm_(range_mm), rows_(kRows, std::vector<std::string>(kColumns, kEmpty)) {
    std::fill(rows_[kRows / 2].begin(), rows_[kRows / 2].end(), kZero);
  }

  void draw_limit(double length_mm, double mpe_mm) {
    for (const double sign : {1.0, -1.0}) cell(length_mm, sign * mpe_mm) = kLimit;
  }

  /// A mark, or "*" where there is one already.
  void draw_mark(double length_mm, double error_mm, char mark) {
    std::string& c = cell(length_mm, error_mm);
    const bool unmarked = c == kEmpty || c == kZero || c == kLimit;
    c = unmarked ? std::string(1, mark) : "*";
  }

  double length_of(int column) const { return longest_mm_ * column / (kColumns - 1); }

  std::string text() const {
    std::string out;
    for (int row = 0; row < kRows; ++row) {
      const bool labelled = row % (kRows / 2) == 0;
      const double error_um = kUmPerMm * range_mm_ * (kRows / 2 - row) / (kRows / 2);
      out += labelled ? fmt::format("  {:>7.2f} ┤", error_um) : fmt::format("  {:>7} │", "");
      for (const std::string& c : rows_[row]) out += c;
      out += "\n";
    }
    return out + fmt::format("  {:>7}  0{:>{}.1f} mm\n", "um", longest_mm_, kColumns - 1);
  }

  static constexpr int kRows = 17, kColumns = 72;

 private:
  static constexpr const char *kEmpty = " ", *kZero = "─", *kLimit = "·";

  std::string& cell(double length_mm, double error_mm) {
    const double row = kRows / 2 * (1 - error_mm / range_mm_);
    const double column = (kColumns - 1) * length_mm / longest_mm_;
    return rows_[std::lround(row)][std::lround(column)];
  }

  double longest_mm_, range_mm_;
  std::vector<std::vector<std::string>> rows_;
};

/// The lines [first, last) of one test.
Canvas length_canvas(const MachineReport& report, std::size_t first, std::size_t last) {
  const LengthMpe& mpe = report.lines[first].mpe;
  double longest_mm = 0, range_mm = 0;
  for (std::size_t k = first; k < last; ++k)
    for (int m = 0; m < kLengthsPerLine; ++m) {
      longest_mm = std::max(longest_mm, report.lines[k].length_mm[m]);
      range_mm = std::max({range_mm, report.lines[k].mpe_mm[m], std::fabs(report.tested.error_mm[k][m])});
    }
  Canvas canvas(longest_mm, range_mm);
  for (int column = 0; column < Canvas::kColumns; ++column)
    canvas.draw_limit(canvas.length_of(column), mpe.at(canvas.length_of(column)));
  for (std::size_t k = first; k < last; ++k)
    for (int m = 0; m < kLengthsPerLine; ++m)
      canvas.draw_mark(report.lines[k].length_mm[m], report.tested.error_mm[k][m], report.lines[k].mark);
  return canvas;
}

std::string length_rows(const MachineReport& report, std::size_t first, std::size_t last) {
  std::string out = "  mark  line   errors of its five lengths, um            longest mm  largest |error| / MPE\n";
  for (std::size_t k = first; k < last; ++k) {
    const TestLine& line = report.lines[k];
    out += fmt::format("  {:<5} {:<5}", line.mark, line.name);
    double worst = 0;
    for (int m = 0; m < kLengthsPerLine; ++m) {
      const double error_mm = report.tested.error_mm[k][m];
      out += fmt::format("{:>8.2f}", shown(error_mm * kUmPerMm));
      worst = std::max(worst, std::fabs(error_mm) / line.mpe_mm[m]);
    }
    out += fmt::format("{:>14.1f}{:>10.2f}\n", line.length_mm.back(), worst);
  }
  return out;
}

}  // namespace

double shown(double value) { return std::fabs(value) < 0.005 ? 0 : value; }

std::string error_state_text(const MachineReport& report) {
  constexpr int kReadings = 3;  // home, middle, end
  const ErrorState state = error_state(report.machine, report.drawn.geometry[0], kTestTip, kReadings);
  std::string out = fmt::format(
      "\nIts error state d (measured = true + d), um, with the tip {:g} mm below the mount, over the "
      "scale readings\n  {:>8} {:>8}",
      -state.tip_mm.z, "x mm", "y mm");
  for (const double z : state.reading_mm[2])
    out += fmt::format(" |{:>22}", fmt::format("z {:g} mm: dx, dy, dz", z + 0.0));
  out += "\n";
  for (int ix = 0; ix < kReadings; ++ix)
    for (int iy = 0; iy < kReadings; ++iy) {
      out += fmt::format("  {:>8g} {:>8g}", state.reading_mm[0][ix] + 0.0, state.reading_mm[1][iy] + 0.0);
      for (int iz = 0; iz < kReadings; ++iz) {
        const Vec3 d_um = kUmPerMm * state.at(ix, iy, iz);
        out += fmt::format(" |{:>7.2f} {:>7.2f} {:>6.2f}", shown(d_um.x), shown(d_um.y), shown(d_um.z));
      }
      out += "\n";
    }
  return out;
}

std::string length_test_text(const MachineReport& report) {
  const std::vector<TestLine>& lines = report.lines;
  const Specification& spec = report.machine.specification;
  std::string out;
  for (std::size_t first = 0, last = 0; first < lines.size(); first = last) {
    while (last < lines.size() && lines[last].test == lines[first].test) ++last;
    out += fmt::format("\nIts test {} after {}: error over length, um; · MPE(l) = {}, * several lengths\n",
                       lines[first].test, spec.standard, length_mpe_text(lines[first].mpe));
    out += length_canvas(report, first, last).text() + length_rows(report, first, last);
  }
  return out;
}

}  // namespace abbe
