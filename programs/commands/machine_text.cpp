// The text reports of `abbe machine show` and `abbe machine screen`.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/math/units.hpp"
#include "programs/commands/machine_report.hpp"

namespace abbe {

namespace {

std::string triple_text(const Vec3& v) { return fmt::format("{:9.6g} {:9.6g} {:9.6g}", v.x, v.y, v.z); }

std::string chain_text(const Machine& machine) {
  std::string ram = "base", table = "base";
  for (const Axis axis : machine.ram_chain) ram += fmt::format(" > {}", kAxisNames[static_cast<int>(axis)]);
  for (const Axis axis : machine.table_chain) table += fmt::format(" > {}", kAxisNames[static_cast<int>(axis)]);
  return fmt::format("  {} > mount > head > tip;  {} > part\n", ram, table);
}

std::string axes_text(const Machine& machine) {
  std::string out =
      "\nAxes                                   scale position, mm\n"
      "  axis  side   travel mm  readings            x         y         z\n";
  for (int k = 0; k < 3; ++k) {
    const MachineAxis& axis = machine.axes[k];
    out += fmt::format("  {:<5} {:<6} {:>9g}  0 .. {:<8g} {}\n", kAxisNames[k], axis.table_side ? "table" : "ram",
                       axis.travel_mm, axis.direction * axis.travel_mm, triple_text(axis.offset_mm));
  }
  out += fmt::format("  {:<40} {}\n", "mount", triple_text(machine.mount_offset_mm));
  out += fmt::format("  {:<40} {}\n", "the mount at readings of 0", triple_text(machine.home_offset()));
  return out + chain_text(machine);
}

std::string components_text(const Machine& machine) {
  std::string out = fmt::format(
      "\nError functions, {} harmonics: shares of the linear and quadratic term, e_max, largest "
      "over the travel\n",
      machine.harmonics);
  for (int k = 0; k < kComponents; ++k) {
    const auto component = static_cast<Component>(k);
    const ComponentSpec& spec = machine[component];
    const bool rotation = is_rotation(component);
    const double e_max = spec.e_max * (rotation ? 1 / kPpm : kUmPerMm);
    out += fmt::format("  {}  s {:<5g} c {:<5g} {:>6g} {:<7}{:>7.3g} {}\n", name(component), spec.linear,
                       spec.curvature, e_max, rotation ? "um/m2" : "um/m",
                       e_max * machine[axis_of(component)].travel_mm * kUm, rotation ? "um/m" : "um");
  }
  return out +
      fmt::format("  known squareness: cwy {:g}, bwz {:g}, awz {:g} um/m\n", machine.squareness_cwy_rad / kPpm,
                  machine.squareness_bwz_rad / kPpm, machine.squareness_awz_rad / kPpm);
}

/// Of the performance indicator: "1 <= v <= 2", "v >= 1".
std::string accepted_range(const Specification& spec) {
  return std::isfinite(spec.v_max) ? fmt::format("{:g} <= v <= {:g}", spec.v_min, spec.v_max)
                                   : fmt::format("v >= {:g}", spec.v_min);
}

/// What a specification may state beyond E0, a line for each.
std::string limits_text(const Specification& spec) {
  std::string out;
  const auto limit = [&](std::string_view name, const std::optional<double>& mm) {
    if (mm) out += fmt::format("{:<15}{} at most {:g} um\n", "", name, *mm * kUmPerMm);
  };
  if (spec.e150_mpe) out += fmt::format("{:<15}E150: MPE(l) = {}\n", "", length_mpe_text(*spec.e150_mpe));
  limit("R0", spec.r0_mpl_mm);
  limit("P_Form.Sph.1x25", spec.form_mpe_mm);
  limit("P_Size.Sph.1x25", spec.size_mpe_mm);
  return out;
}

std::string equipment_text(const Machine& machine) {
  const Specification& spec = machine.specification;
  const HeadSpec& head = machine.head;
  const Vec3 sd_um = kUmPerMm * machine.probe.sd_mm;
  std::string out = fmt::format(
      "\nSpecification  {}: MPE(l) = {}; accepted {}; lines over {:g} of the "
      "travel\n",
      spec.standard, length_mpe_text(spec.mpe), accepted_range(spec), spec.longest_share);
  out += limits_text(spec);
  out += fmt::format("Head           {}: l_r {:g} mm; repeatability A {:.3g}, B {:.3g} arcsec; turned {:g} deg\n",
                     head.model.empty() ? "none" : head.model, head.l_r_mm, head.sd_a_rad / kArcsec,
                     head.sd_b_rad / kArcsec, in_degrees(head.mounting_rad));
  out += fmt::format(
      "Probe          standard deviations {:g}, {:g}, {:g} um along the axes of the head's last "
      "link\n",
      sd_um.x, sd_um.y, sd_um.z);
  out += fmt::format("Motion         {:g} mm/s, probing at {:g} mm/s, {:g} mm/s2\n", machine.motion.speed_mm_s,
                     machine.motion.probing_speed_mm_s, machine.motion.acceleration_mm_s2);
  out += "Sensors\n";
  for (const auto& [label, s] : machine.sensors)
    out += fmt::format("  {:<12} A {:>5.6g}, B {:>5.6g} deg  tip {} mm  diameter {:g} mm, shaft {:g} mm {}\n", label,
                       in_degrees(s.head_a_rad), in_degrees(s.head_b_rad), triple_text(s.tip_in_r_mm), 2 * s.radius_mm,
                       s.shaft_diameter_mm, s.material);
  out += "Effects\n";
  for (const EffectSetting& effect : machine.effects) {
    out += "  " + effect.name;
    for (const auto& [key, value] : effect.parameters)
      out += value.word.empty()
          ? fmt::format("  {} {:g}{}", key, value.value, value.u > 0 ? fmt::format(" (u {:g})", value.u) : "")
          : fmt::format("  {} {}", key, value.word);
    out += "\n";
  }
  if (machine.effects.empty()) out += "  none beyond geometry, head and probe\n";
  if (!machine.bounds.empty()) out += "Bounds on influences that are not propagated\n";
  for (const InfluenceBound& b : machine.bounds)
    out += fmt::format("  {}  at most {:g} um at a touch ({})\n", b.influence, b.at_most_mm * kUmPerMm, b.source);
  return out;
}

/// A row of blocks from the lowest value to the highest.
std::string sparkline(const std::vector<double>& values) {
  static constexpr std::string_view blocks[] = {"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double range = *high > *low ? *high - *low : 1;
  std::string out;
  for (const double value : values) out += blocks[std::clamp(static_cast<int>(8 * (value - *low) / range), 0, 7)];
  return out;
}

std::string curves_text(const MachineReport& report) {
  constexpr int kColumns = 48;
  const Machine& machine = report.machine;
  std::string out = fmt::format(
      "\nOne virtual machine (seed {}, candidate {}, v = {:.2f}): its errors from home to the end "
      "of the travel\n",
      report.seed, report.drawn.index[0], report.drawn.v[0]);
  for (int k = 0; k < kComponents; ++k) {
    const auto component = static_cast<Component>(k);
    const MachineAxis& axis = machine[axis_of(component)];
    std::vector<double> values;
    for (int i = 0; i < kColumns; ++i)
      values.push_back(
          error_at(machine, report.drawn.geometry[0], component, axis.direction * axis.travel_mm * i / (kColumns - 1)) *
          (is_rotation(component) ? 1 / kPpm : kUmPerMm));
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    out += fmt::format("  {}  {}  {:6.2f} .. {:5.2f} {}\n", name(component), sparkline(values), shown(*low),
                       shown(*high), is_rotation(component) ? "um/m" : "um");
  }
  return out;
}

std::string bar(double share) {
  constexpr int kFull = 30;
  std::string out;
  for (int i = 0; i < std::clamp(static_cast<int>(std::lround(kFull * share)), 0, kFull); ++i) out += "█";
  return out;
}

std::string count_line(std::string_view what, std::uint64_t count, const ScreeningCounts& counts) {
  return fmt::format("  {:<34} {:>8}  {:5.1f} %\n", what, count, 100 * double(count) / double(counts.generated));
}

std::string lines_text(const std::vector<LineReport>& lines) {
  std::string out =
      "\nLargest |error| / MPE of the accepted machines, by line (the bar is the median machine; "
      "full width: 1)\n"
      "  test  line  longest mm   MPE um   median   95 %  largest\n";
  for (const LineReport& report : lines) {
    const TestLine& line = report.line;
    out += fmt::format("  {:<5} {:<5} {:>10.1f} {:>8.2f} {:>8.2f} {:>6.2f} {:>8.2f}  {}\n", line.test, line.name,
                       line.length_mm.back(), line.mpe_mm.back() * kUmPerMm, report.median, report.p95, report.largest,
                       bar(report.median));
  }
  return out;
}

/// Over shorter lines it is no test of the standard.
std::string test_name(const Specification& spec) {
  return spec.shorter_than_standard()
      ? fmt::format("virtual test over {:g} of each line, shorter than {} asks for", spec.longest_share, spec.standard)
      : fmt::format("virtual test after {}", spec.standard);
}

std::string factor_text(const std::optional<SuggestedFactor>& suggested) {
  if (!suggested) return "\n  no factor on e_max from 0.01 to 100 makes a difference\n";
  const std::string which = suggested->largest
      ? fmt::format("largest factor on e_max with which {:g} % are accepted", 100 * kEnoughAccepted)
      : "best factor on e_max";
  return fmt::format("\n  {}: {:.2f}, accepts about {:.0f} %\n", which, suggested->factor,
                     100 * suggested->share_accepted);
}

std::string probe_text(const std::vector<ProbeCheck>& checks) {
  if (checks.empty()) return "";
  std::string out =
      "\nThe probe by its standard deviations alone (R0: largest of 35 ranges)\n"
      "  quantity          limit um  median um  tests passed\n";
  for (const ProbeCheck& check : checks)
    out += fmt::format("  {:<16} {:>9.2f} {:>10.2f} {:>11.1f} %\n", check.name, check.limit_mm * kUmPerMm,
                       check.median_mm * kUmPerMm, 100 * check.share_passed);
  return out;
}

}  // namespace

std::string length_mpe_text(const LengthMpe& mpe) {
  const std::string rising = fmt::format("{:g} um + {:g} um/m", mpe.a_mm * kUmPerMm, mpe.k / kPpm);
  return std::isfinite(mpe.b_mm) ? fmt::format("{}, at most {:g} um", rising, mpe.b_mm * kUmPerMm) : rising;
}

std::string machine_report_text(const MachineReport& report) {
  const Machine& machine = report.machine;
  return machine.name + "\n" + axes_text(machine) + components_text(machine) + equipment_text(machine) +
      curves_text(report) + error_state_text(report) + length_test_text(report);
}

std::string screening_text(const ScreeningReport& report) {
  const Specification& spec = report.machine.specification;
  const ScreeningCounts& counts = report.counts;
  std::string out = fmt::format("{}: {}, {} lengths, MPE(l) = {}, seed {}\n\n", report.machine.name, test_name(spec),
                                kLengthsPerLine * report.lines.size(), length_mpe_text(spec.mpe), report.seed);
  out += fmt::format("  {:<34} {:>8}\n", "virtual machines drawn", counts.generated);
  out += count_line(fmt::format("accepted ({})", accepted_range(spec)), counts.used, counts);
  out += count_line("failed the MPE", counts.failed_mpe, counts);
  out += count_line("errors too small", counts.too_small, counts);
  return out + factor_text(report.suggested) + lines_text(report.lines) + probe_text(report.probe);
}

}  // namespace abbe
