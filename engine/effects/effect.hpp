// One physical effect: a piece of physics that the geometric model leaves out. Written once, used twice: to
// simulate (as a known error or as a contributor with an uncertain size) and to diagnose (as an explanation
// of recordings). An effect is one .cpp file in the folder of its family, one line in all.cpp there and one in the
// family's header; everything else (machine files, `record --with`, budgets, documentation, the sensitivity matrix of
// the diagnosis) goes through this description.
//
// An effect maps the *scene* of a touch (where, how, when, with what, at which temperatures) and its
// parameters to a displacement d of the tip centre in W with `measured = true + d`. Only n . d reaches a
// reading, so an effect that is naturally a scalar r along the outward normal n returns r * n. Signs: r > 0
// means that the surface seems too far out.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/math/vec.hpp"

namespace abbe {

/// The stylus system of a touch.
struct StylusScene {
  std::string_view name;
  Vec3 tip_from_mount_mm;  ///< in W
  Vec3 to_head{0, 0, 1};   ///< unit vector from the tip towards the head, W
  Mat3 R_WR;               ///< last link of the head in W; the probe body turns with it
  double length_mm = 0;    ///< from the head's centre to the tip
  double radius_mm = 0;
  double shaft_diameter_mm = 0;
  double young_MPa = 0;  ///< N/mm^2
  double cte_per_K = 0;
  double head_a_rad = 0, head_b_rad = 0;
  bool indexed = false;
  int ordinal = 1;  ///< 1, 2, ...: stylus systems in the order of their first use
  /// 1, 2, ...: qualified tips (a stylus system in one orientation) in the order of their first use
  int tip_ordinal = 1;
};

inline constexpr double kReferenceTemperature_C = 20;  ///< ISO 1

/// Temperatures in degrees C; the reference where nothing is known.
struct Temperatures {
  double part = kReferenceTemperature_C, air = kReferenceTemperature_C;
  double scale[3] = {kReferenceTemperature_C, kReferenceTemperature_C, kReferenceTemperature_C};
  double table_top_minus_bottom_K = 0;
  double bridge_gradient_K = 0;  ///< top minus bottom of the beam
  double legs_difference_K = 0;  ///< leg at large y minus leg at small y
};

/// Which covariates of a scene are really known. A recording may lack some; an effect that needs one of these
/// cannot be judged then.
enum class Covariate : unsigned {
  position = 1u << 0,
  normal = 1u << 1,
  time = 1u << 2,
  speed = 1u << 3,
  acceleration = 1u << 4,
  direction = 1u << 5,  ///< direction of travel and the senses of the axes
  head = 1u << 6,
  sensor = 1u << 7,
  part_temperature = 1u << 8,
  scale_temperature = 1u << 9,
  air_temperature = 1u << 10,
  gradients = 1u << 11,
  raw_reading = 1u << 12,
  load = 1u << 13,
  visit = 1u << 14,  ///< which indexing visit
  qualification = 1u << 15,
  part_frame = 1u << 16,  ///< position on the part
  feature = 1u << 17,
};

/// Everything that an effect may know of one touch. Made by the executor for a simulated touch and from a row
/// for a recorded one.
struct TouchScene {
  Vec3 point;    ///< contact point, W, mm
  Vec3 normal;   ///< outward unit normal of the surface, W
  Vec3 travel;   ///< unit vector of the motion just before the touch, W
  Vec3 reading;  ///< scale readings, mm
  Vec3 on_part;  ///< contact point in the part's own coordinates, mm
  Vec3 normal_on_part;
  StylusScene stylus;
  double time_s = 0;                        ///< since the start of the program
  double speed_mm_s = 0;                    ///< of the tip at the touch
  double acceleration_mm_s2 = 0;            ///< of the axes before the approach became steady
  double settled_s = 0;                     ///< time at constant speed before the touch
  int sense[3] = {1, 1, 1};                 ///< last sense of motion of each axis
  double since_reversal_mm[3] = {0, 0, 0};  ///< travel of each axis since its sense last changed
  Temperatures temperature;
  double load_kg = 0;
  int touch = 0;       ///< ordinal in the program or recording
  int feature = 0;     ///< ordinal of the feature measured, in the order of the first touches
  bool curved = true;  ///< of a ball or a bore, as its touches tell (run/curved_features.hpp)
  int setup = 0, run = 0, visit = 0, qualification = 0;
  Vec3 travel_length_mm{1000, 1000, 1000};  ///< of the machine's axes
  /// From the origin of each carriage's frame (x, y, z) to the tip, W: the arm on which a rotation of that
  /// carriage acts. For x it is l_y + l_z + l_m + t of the geometric model (machine/geometry.hpp).
  Vec3 lever_mm[3];
  /// Of each axis: 1 where its carriage carries the ram, -1 where it carries the part. Its lever then runs to
  /// the point on the part.
  double side[3] = {1, 1, 1};
  /// the horizontal axis whose guide lies on the table (or under it), and the one along the bridge
  int on_table = 0, on_bridge = 1;
};

/// Where in the chain of a touch an effect acts. Within a stage displacements add.
enum class Stage { part, thermal, structure, dynamics, head, probe, scale, noise };

/// How a diagnosis seeks the value of a parameter in which the displacement is not linear. Linear ones are solved for,
/// and choices are tried one by one.
enum class Sought {
  not_at_all,     ///< it stays at its standard value
  listed,         ///< one of `tried`
  around_listed,  ///< `tried`, and what lies between
  wavelength,     ///< likewise, but none longer than two parts as large as what was touched: that is no form, mm
  signal_period,  ///< those of `tried` that the readings of a recording resolve, um
  height,         ///< of a plane in the part, whose touches may span no more than a third of its height, mm
  moment,         ///< between two touches
  period,         ///< whole half cycles in the duration of the recording
  time_constant,  ///< shares of that duration
  reading,        ///< of a scale, within what was touched
  phase,          ///< 0 and 90 degrees together span every phase
  direction,      ///< the three axes together span every direction (direction.hpp)
  stylus,         ///< the ordinals of the styli, 0 for all
  tip,            ///< the ordinals of the tips, a stylus in one orientation each; 0 for all
  setup,          ///< the placements of the part, 0 for all
  speed,          ///< one of several probing speeds of a recording, 0 for none, mm/s
};

/// Where a parameter counts: with `choice` at `word`, or at any other of its words (`not_at`); no choice: everywhere.
struct OnlyWith {
  std::string_view choice = "";
  std::string_view word = "";
  bool not_at = false;
};

struct EffectParameter {
  std::string_view name;  ///< carries the unit: "amplitude_um"
  std::string_view unit;
  std::string_view help;
  double typical = 0;  ///< one prior standard deviation of a size (linear), or the prior median (others)
  /// plausible range; values outside are refused in machine files and flagged by the diagnosis
  double low = 0, high = 0;
  double standard = 0;          ///< value when a user gives none
  bool linear = false;          ///< the displacement is linear in all linear parameters jointly
  std::string_view group = "";  ///< of linear ones that often act without those of other groups
  /// names of the codes low, low + 1, ... of a parameter that is a choice
  std::span<const std::string_view> choices = {};
  OnlyWith only_with = {};
  Sought sought = Sought::not_at_all;
  std::span<const double> tried = {};
  /// covariates: it is sought only where they were not logged, or are the same throughout; 0: always
  unsigned unless_logged = 0;
  /// Whether it is a choice or an ordinal: a whole number, and certain.
  constexpr bool is_code() const { return unit == "code"; }
};

/// The names of the codes 0, 1, 2 of every parameter `axis`.
inline constexpr std::string_view kAxisChoices[] = {"x", "y", "z"};

/// Two linear parameters, by their places in the list, that are the same component at neighbouring knots.
struct Neighbours {
  std::size_t one = 0, next = 0;
};

/// How often an effect draws its random numbers (standard normal, see lanes/random.hpp).
enum class DrawsPer { none, machine, visit, touch };

struct Effect {
  std::string_view name;      ///< "thermal.part_expansion", as in machine files; also names its random numbers
  std::string_view title;     ///< a few words
  std::string_view help;      ///< what it is and what it does to measurements, for people
  std::string_view source;    ///< standard, paper, data sheet
  std::string_view separate;  ///< the measurement that tells it from what it is confused with
  std::string_view influence =
      "";  ///< the one that it models, of those that reports declare (engine/influences); "": none
  Stage stage{};
  unsigned needs = 0;  ///< Covariates
  std::span<const EffectParameter> parameters;
  std::span<const Neighbours> neighbours = {};  ///< of a course that is given by its values at knots
  DrawsPer draws_per = DrawsPer::none;
  int draws = 0;                 ///< how many numbers each time
  bool linear_in_draws = false;  ///< for given parameters; no displacement when all draws are zero
  bool only_spread = false;      ///< no law but a spread: of what is drawn so freely, much else may look like it
  bool lasting = false;          ///< of the part itself: seldom new between two runs, or gone
  /// What is impossible about values that are each possible by themselves, "" if nothing; none: any go together.
  std::string_view (*contradiction)(const double* theta) = nullptr;
  /// d of one touch, mm in W. theta: parameter values in the units of `parameters`, in their order; z: the draws.
  Vec3 (*displace)(const TouchScene&, const double* theta, const double* z) = nullptr;
  /// Whether a touch lies where it only prolongs what it was fitted to; none: physics has no such ends.
  bool (*beyond)(const TouchScene&, const double* theta) = nullptr;
};

constexpr unsigned operator|(Covariate a, Covariate b) { return static_cast<unsigned>(a) | static_cast<unsigned>(b); }
constexpr unsigned operator|(unsigned a, Covariate b) { return a | static_cast<unsigned>(b); }

/// Whether it acts within the signal period of a scale.
constexpr bool needs_raw_reading(const Effect& effect) {
  return (effect.needs & static_cast<unsigned>(Covariate::raw_reading)) != 0;
}

/// Whether it changes no mean, only the scatter.
constexpr bool is_noise(const Effect& effect) { return effect.stage == Stage::noise; }
/// False for what is no effect.
bool is_noise(std::string_view name);

/// Every effect, in the order of the catalogue.
std::span<const Effect* const> effects();
const Effect* find_effect(std::string_view name);

/// The index of the parameter that says when in a program the effect begins, s; nothing of one that is there throughout.
std::optional<std::size_t> moment_of(const Effect&);

}  // namespace abbe
