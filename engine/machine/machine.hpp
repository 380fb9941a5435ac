// The description of one real machine: its structure, its specification and the sizes of its errors. Read
// from a machine file (docs/machine.md); everything is converted to the engine's units (mm, rad, s) at that
// edge.
//
// Source of the model: Van Gestel, Bleys, Kruth, "CMM hardware error simulation for uncertainty evaluation"
// ("the paper"). Component names follow ISO 230-1: e<motion><axis>, so `eyx` is the straightness error motion
// of x in y, `ecx` the yaw of x.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/base/letter_case.hpp"
#include "engine/influences/influence.hpp"
#include "engine/math/axis.hpp"
#include "engine/math/vec.hpp"

namespace abbe {

/// The 18 error functions, axis by axis: translations along X, Y, Z, then rotations about X, Y, Z.
enum class Component { exx, eyx, ezx, eax, ebx, ecx, exy, eyy, ezy, eay, eby, ecy, exz, eyz, ezz, eaz, ebz, ecz };
inline constexpr int kComponents = 18;
std::string_view name(Component);  ///< "exx"
constexpr Axis axis_of(Component c) { return static_cast<Axis>(static_cast<int>(c) / 6); }
constexpr bool is_rotation(Component c) { return static_cast<int>(c) % 6 >= 3; }

/// What a reading may lie outside the travel: less than programs and messages tell, and rounding leaves that much.
inline constexpr double kEndOfTravel_mm = 0.0005;

struct MachineAxis {
  double travel_mm = 0;
  int direction = 1;  ///< +1: readings run from 0 to travel; -1: from 0 to -travel
  Vec3 offset_mm;     ///< scale position: this axis' frame at home, in the frame that carries it (paper, Table 2)
  bool table_side = false;

  double lowest_mm() const { return direction > 0 ? 0.0 : -travel_mm; }
  double highest_mm() const { return direction > 0 ? travel_mm : 0.0; }
  bool reaches(double reading_mm) const {
    return reading_mm > lowest_mm() - kEndOfTravel_mm && reading_mm < highest_mm() + kEndOfTravel_mm;
  }
};

/// How one error function is generated (paper eq. 13-16).
struct ComponentSpec {
  double linear = 0;              ///< share s of the linear term
  double curvature = 0;           ///< share c of the quadratic term
  double e_max = 0;               ///< mm per m of travel (translations), rad per m of travel (rotations)
  std::vector<double> harmonics;  ///< amplitudes a_n when the file gives them; empty: drawn at random
};

/// A maximum permissible error of lengths: min(a + k l, b), mm and mm/mm.
struct LengthMpe {
  double a_mm = 0, k = 0;
  double b_mm = std::numeric_limits<double>::infinity();
  double at(double length_mm) const { return std::min(a_mm + k * length_mm, b_mm); }
};

/// What the maker states, and how virtual machines are screened with it (engine/machine/acceptance).
struct Specification {
  /// ISO 10360-2: the longest length is at least this share of its line (2009), of the space diagonal (2001).
  static constexpr double kLeastLongestShare = 0.66;

  std::string standard;                            ///< "ISO 10360-2:2001"
  LengthMpe mpe;                                   ///< E of the 2001 edition, E0 of the 2009 edition
  std::optional<LengthMpe> e150_mpe;               ///< 2009 edition: tip 150 mm off the axis of the ram
  std::optional<double> r0_mpl_mm;                 ///< 2009 edition: range of three repeats of a length
  std::optional<double> form_mpe_mm, size_mpe_mm;  ///< ISO 10360-5, one stylus: P_Form.Sph.1x25, P_Size.Sph.1x25
  double v_min = 1, v_max = 2;                     ///< accepted range of the performance indicator v (paper eq. 19)
  double longest_share = kLeastLongestShare;       ///< longest test length as a share of the line through the volume
  bool shorter_than_standard() const { return longest_share < kLeastLongestShare; }
};

struct HeadSpec {
  bool present = false;  ///< the file describes one
  std::string model;
  double l_r_mm = 0;                  ///< mounting point to the centre of the head's axes, straight down
  double sd_a_rad = 0, sd_b_rad = 0;  ///< repeatability of one indexing, one standard deviation
  double mounting_rad = 0;            ///< turn of the head about the ram axis
};

struct ProbeSpec {
  Vec3 sd_mm;  ///< standard deviations along the axes of {r}, per touch
};

struct MotionSpec {
  double speed_mm_s = 0, probing_speed_mm_s = 0, acceleration_mm_s2 = 0;
};

/// One stylus system of the machine file.
struct NamedSensor {
  /// Where nobody says what a stylus is made of: tungsten carbide.
  static constexpr double kUsualYoung_GPa = 620, kUsualCte_ppm_per_K = 5;

  double head_a_rad = 0, head_b_rad = 0;
  Vec3 tip_in_r_mm;
  double radius_mm = 0;
  double shaft_diameter_mm = 0;
  std::string material;
  double young_GPa = 0, cte_ppm_per_K = 0;
};

/// An effect switched on in the machine file ("effects"): a registry name and its parameters.
struct EffectSetting {
  struct Value {
    double value = 0, u = 0;
    std::string word;  ///< of a parameter that names something ("axis": "x")
    Span span = {};    ///< where it stands in `file`
  };
  std::string name;
  std::map<std::string, Value> parameters;
  std::shared_ptr<const SourceFile> file = {};  ///< the machine file, if it comes from one
  Span span = {};                               ///< of the name in it
  std::string option = {};                      ///< else what the command line says: "--with machine.scale"
};

/// What an earlier diagnosis learned of this machine ("known_state"): the coefficients of its error functions,
/// component by component, have this mean and the covariance factor . factor^T.
struct KnownState {
  static constexpr std::string_view kSchema = "abbe.known_state/1";

  std::vector<double> mean;
  std::vector<std::vector<double>> factor;  ///< by column
};

struct Machine {
  std::string name;
  std::array<MachineAxis, 3> axes;                         ///< by Axis
  std::vector<Axis> ram_chain{Axis::x, Axis::y, Axis::z};  ///< from the base to the ram
  std::vector<Axis> table_chain;                           ///< from the base to the part
  Vec3 mount_offset_mm;                                    ///< mounting point in the frame of the last ram-side axis
  std::vector<std::string> offsets_not_given;  ///< keys of "offsets_mm" that the file leaves out: they count as zeros
  int harmonics = 7;
  std::array<ComponentSpec, kComponents> components;
  /// ISO 230-1; known, the same for every virtual machine
  double squareness_cwy_rad = 0, squareness_bwz_rad = 0, squareness_awz_rad = 0;
  Specification specification;
  HeadSpec head;
  ProbeSpec probe;
  MotionSpec motion;
  std::map<std::string, NamedSensor, LabelOrder> sensors;
  std::vector<EffectSetting> effects;
  std::vector<InfluenceBound> bounds;  ///< on influences that are not propagated
  std::optional<KnownState> known_state;

  const MachineAxis& operator[](Axis a) const { return axes[static_cast<int>(a)]; }
  ComponentSpec& operator[](Component c) { return components[static_cast<int>(c)]; }
  const ComponentSpec& operator[](Component c) const { return components[static_cast<int>(c)]; }
  /// Sum of the offsets of the ram side and the mount: scale readings + this + tip from mount = tip in W
  /// (paper eq. 17).
  Vec3 home_offset() const;
  /// Whether styli are turned: the file describes a head, or gives a stylus angles of one. Else all are fixed to the ram.
  bool has_head() const;
};

/// Reads a machine file, or a shipped machine by name ("coord3-mc16"). Throws UserError: unreadable, not
/// JSON, unknown key (named, with its place and the nearest known one), impossible value (negative travel,
/// contradictory MPE, ...).
Machine read_machine(const std::string& name_or_path);
/// The text of the file that read_machine reads. Throws UserError when there is none.
std::string machine_text(const std::string& name_or_path);
/// Names of the shipped machines, in alphabetical order.
std::vector<std::string> shipped_machines();

/// What is suspect in a machine that can be used: scale positions that are not given, so that Abbe errors are
/// wrong; test lengths shorter than the standard asks for, so that worse machines pass.
std::vector<Diagnostic> machine_warnings(const Machine&);

/// Parses the text of a machine file; `file` names it in messages. Throws UserError as read_machine does.
Machine parse_machine(const std::string& file, const std::string& text);

}  // namespace abbe
