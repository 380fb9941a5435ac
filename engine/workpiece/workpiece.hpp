// The workpiece: how the true part differs from its nominal geometry, how warm it is, and how well
// both are known (docs/workpiece.md, "Workpiece file").
//
// The true part at 20 degrees C (ISO 1) has its surfaces where the program says, moved by the best
// estimates of this file. An error-free machine sees exactly that, so the reference of every
// characteristic is its true value. A virtual machine sees in addition what is not known of the
// part (its draw of every uncertain quantity) and the thermal expansion of part and scales,
//
//     d_k = [ a_p (T_p - 20) - a_s (T_k - 20) - taken out ] (p_k - p0_k),      k = x, y, z
//     taken out = a_p,set (T_p + s_p - 20) - a_s,set (T_k + s_k - 20)
//
// (ISO/TR 16015; without temperature compensation nothing is taken out).
// a: expansion coefficients of part and scales, a_set: those that the controller reckons with, T:
// temperatures of the part and of the scale of axis k, s: errors of the controller's sensors, p0: a
// point where part and machine are held together, here the first point that is touched. Products of
// two strains (1e-8 of a length) are left out.
//
// So the gauge block of GUM H.1 is a workpiece: the block is the part, the standard of the
// comparator is the scale.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/effects/effect.hpp"
#include "engine/influences/influence.hpp"
#include "engine/workpiece/temperature_log.hpp"
#include "engine/workpiece/uncertain.hpp"

namespace abbe {

/// One harmonic of the form error of a round surface: amplitude cos(n phi + phase) along the
/// outward normal, phi being the angle about the axis of the feature from the x axis of the
/// coordinate system in force (from y where the axis is along x).
struct FormHarmonic {
  int undulations = 2;
  Uncertain amplitude_mm;
  std::optional<double> phase_half_turns;  ///< nothing: not known, drawn for every virtual machine
};

/// What is known of the surface that a feature of the program is measured on.
struct Surface {
  std::string label;
  Span label_span;
  Uncertain offset_mm;  ///< true minus nominal along the outward normal
  /// Of round features: two other ways to give the offset.
  std::optional<Uncertain> diameter_mm, diameter_deviation_mm;
  std::vector<FormHarmonic> form;
  Uncertain random_form_mm;  ///< standard deviation from touch to touch, the same at every repeat
};

struct Workpiece {
  SourceFile source{"", ""};  ///< the file it was read from, for messages
  std::string name, material;

  Uncertain part_cte_per_K, scale_cte_per_K;
  bool part_cte_from_scale = false;  ///< then part_cte_per_K is the difference to the scales'

  Uncertain part_C, scale_C[3];  ///< where the log has no column
  std::string scale_name[3];     ///< names the random numbers: scales with one temperature share it
  /// Where given the scales follow the part, or the part the scales.
  std::optional<Uncertain> part_minus_scale_K;
  bool part_follows_scale = false;
  TemperatureLog log;
  std::string log_file;  ///< that it was read from; empty without one
  Temperatures other;    ///< air and gradients; part and scales are unused here

  bool compensated = false;  ///< at the start; TECOMP changes it
  double assumed_part_cte_per_K = 0, assumed_scale_cte_per_K = 0;
  Uncertain sensor_K;

  double load_kg = 0;
  struct Knows {  ///< what the file says; other columns of a recording stay empty
    bool part = false, scale[3] = {false, false, false}, air = false, load = false;
  } knows;
  std::vector<Surface> surfaces;
  std::vector<InfluenceBound> bounds;  ///< on influences that are not propagated

  // Whether the file says more of these than nothing, or 0. Of sizes and forms of known phase recorded points hold the
  // best estimate, so that beside them only doubts are more.
  bool has_form(bool recorded) const;
  bool has_sizes(bool recorded) const;
  bool part_expands() const;  ///< its coefficient of expansion
  bool scales_expand() const;
  /// Whether it has, or may have, another temperature than the reference, or, where the controller compensates, is
  /// thought to have one, and changes a length by it.
  bool part_temperature_acts(bool compensates) const;
  bool scale_temperature_acts(bool compensates) const;
  /// Best estimates, for effects that depend on temperatures.
  Temperatures temperatures(double time_s) const;
};

/// Reads a workpiece file. Throws UserError with every mistake found; a log is read beside the
/// file.
Workpiece read_workpiece(const std::string& path);
/// Parses the text of a workpiece file; its name says where a log lies.
Workpiece parse_workpiece(const SourceFile&);

/// What one virtual machine has of everything that concerns temperature.
struct ThermalDraw {
  double part_cte_per_K = 0, scale_cte_per_K = 0;
  double part_K = 0;  ///< beyond the best estimate
  std::array<double, 3> scale_K{};
  double part_sensor_K = 0;  ///< error of the controller's sensor
  std::array<double, 3> scale_sensor_K{};
};
ThermalDraw draw_thermal(const Workpiece&, DrawFor);
/// Whether the temperature of part or scales is uncertain, so that every virtual machine has its own.
bool temperatures_vary(const Workpiece&);
/// The temperatures of one virtual machine at a moment for which temperatures() gives `estimate`.
Temperatures drawn_temperatures(const Temperatures& estimate, const ThermalDraw&);
/// Displacement of a surface point per mm of its distance from the fixed point, by axis of the
/// machine. `estimate`: what temperatures() gives for the moment of the touch.
Vec3 strain(const Workpiece&, const ThermalDraw&, const Temperatures& estimate, bool compensated);

}  // namespace abbe
