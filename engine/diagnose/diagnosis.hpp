// What a diagnosis says, as plain data (docs/diagnosis_method.md explains every figure), and the one function that makes it.
//
// A recording is compared with what a machine of this specification may do. If they agree, that is all, with
// the list of what could have been seen. If not, the mismatch is located by factor and named over the
// catalogue of effects plus OTHER. What cannot be told apart is named together; what the catalogue does not
// explain is described and modelled empirically; what the recording cannot judge is listed with the columns
// that are missing.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/base/progress.hpp"
#include "engine/machine/machine.hpp"
#include "engine/recording/recording.hpp"

namespace abbe {

struct Workpiece;

enum class Verdict { no_mismatch, named, one_of, unexplained, cannot_judge };
std::string_view name(Verdict);  ///< as in the JSON: "no_mismatch"

/// A value of a list that the data do not rule out beside the one that is told.
struct OtherValue {
  std::string value;  ///< in words: "y", "50 mm", the name of a stylus
  double probability = 0;
};

struct DiagnosedParameter {
  std::string name, unit = {};
  double value = 0, u = 0;
  double low = 0, high = 0;  ///< 95 % interval
  std::string word = {};     ///< of a choice: "x"; then the numbers mean nothing
  bool plausible = true;     ///< some of the interval is inside the range that the catalogue gives
  /// what a number stands for, where that has a name: the stylus, the run of a moment; how far a word holds
  std::string called = {};
  /// of a value out of a list: how sure it is among them, and which others are left, the likeliest first
  double probability = 1;
  std::vector<OtherValue> others = {};
};

/// A length between two touches, and how wrong it is.
struct LengthError {
  double length_mm = 0, error_mm = 0, mpe_mm = 0;
};

/// How something differs between runs: it is new in one, or gone from one on, or both. 0: neither; it is the same in all.
struct RunChange {
  int from = 0, until = 0;
  /// It goes on in time, and its clock begins anew in each file, as that of a warm-up every morning.
  bool in_each_file = false;
  bool any() const { return from > 0 || until > 0; }
  bool gone() const { return until > 0; }
  bool acts_in(int run) const { return run >= from && (until == 0 || run < until); }
  /// The run that comes first.
  int& first() { return from > 0 ? from : until; }
  int first() const { return from > 0 ? from : until; }
  /// Whether both are changes that differ in nothing but that.
  bool is_like(const RunChange& other) const {
    return any() && other.any() && (from > 0) == (other.from > 0) && (from == 0 || until == other.until);
  }
  bool operator==(const RunChange&) const = default;
};

/// One member of a set of names, by itself.
struct DiagnosedMember {
  double probability = 0;
  std::vector<DiagnosedParameter> parameters;
  std::optional<double> largest_um = {};  ///< DiagnosedEffect::largest_um
};

struct DiagnosedEffect {
  /// several: cannot be told apart by this recording; the likeliest first, but those that cannot be judged after those
  /// that can
  std::vector<std::string> members;
  double probability = 0;                      ///< that it is one of these
  std::vector<DiagnosedParameter> parameters;  ///< of the first member
  std::string sentence;
  std::vector<RunChange> change = {};  ///< by member; none: in all runs
  /// of what the first member does along the normal at a touch; nothing of scatter and of values
  std::optional<double> largest_um = {};
  /// of several members, what each would be; of the least likely ones there may be no sizes
  std::vector<DiagnosedMember> by_member = {};
};

struct Location {
  std::string factor;                                      ///< "time", "position", ...
  std::vector<std::pair<std::string, std::string>> where;  ///< factor or coordinate, and its values; none: everywhere
  double share = 0;  ///< of what the best explanation of any factor describes that the best one of this factor does
  double p = 1;      ///< that so much appears by chance, the whole search considered
};

/// A mismatch that the catalogue does not explain, and the pattern that stands for it.
struct Unexplained {
  std::string factor, shape;
  double amplitude_um = 0, amplitude_u_um = 0;
  double low_um = 0, high_um = 0;  ///< 95 % interval of the amplitude
  std::string sentence;
  std::string model = {};  ///< the effect in `model_effects` that stands for it; empty: none was made
  /// the factor of which that is a function, where the pattern is one of several; else empty
  std::string model_follows = {};
  std::optional<double> largest_um = {};  ///< the most that it is at a touch, as estimated; nothing of values
};

struct Improvement {
  std::string scheme;                 ///< "leave-one-setup-out"
  double log_score_gain = 0, se = 0;  ///< nats, on data that the model did not see
  double rms_before_um = 0, rms_after_um = 0;
  double bias_before_um = 0, bias_after_um = 0;
  double chi2_per_dof_before = 0, chi2_per_dof_after = 0;
};

struct RunnerUp {
  std::vector<std::string> members;
  double log_score_gain = 0;
};

struct CannotJudge {
  std::string effect;
  /// columns that were not logged or do not differ enough; empty: the effect does nothing to these touches, or what is
  /// unknown of the part hides it
  std::vector<std::string> missing = {};
  std::vector<std::string> constant = {};  ///< of these, those that are the same throughout
  std::vector<std::string> too_few = {};   ///< and those that differ, but too seldom
  std::string too_few_of = {};             ///< what there is too little of then: "fewer than three indexings"
};

/// The smallest size of an effect that this recording can detect, and the smallest that it can name.
struct Detectable {
  std::string effect, parameter, unit;
  double detect = 0;
  std::optional<double> name = {};  ///< nothing: it cannot be told from `confounded_with` at any size
  double detect_um = 0;             ///< the same as the largest displacement that it makes at one of the touches
  std::optional<double> name_um = {};
  std::vector<std::string> confounded_with = {};
  /// what is there in all runs does not show: these are the sizes of what is new in one of them
  bool only_new = false;
  /// which form of the effect that is: the values of its parameters that are no sizes, of those that were tried
  std::vector<DiagnosedParameter> form = {};
  bool scatter = false;  ///< of the noise: detect_um and name_um are standard deviations, of outliers their size
};

struct NextMeasurement {
  std::string change;
  std::string instruction;  ///< what the operator does beside running the program
  std::vector<std::string> separates;
  double expected_probability = 0;  ///< of the truth, once it is made
  double minutes = 0;
  std::string program;  ///< DMIS
};

struct BaselineSummary {
  bool known = false;
  bool rougher = false;       ///< the recording fits machines better whose errors are rougher than harmonics
  bool uneven = false;        ///< or of which an error function, a guide or a rail is more uneven than the rest
  double geometry_scale = 1;  ///< of such machines
  double noise_um = 0;
  double stated_noise_um = 0;  ///< the same of the machine file, with the rounding of positions
  bool noisier = false;        ///< by so much more that it is worth telling, and no effect says why
  std::vector<std::pair<std::string, double>> noise_by_sensor;
  double correlation = 0;
  std::vector<std::string> outliers;  ///< "SPH1 touch 7"
};

/// What simpler methods say of the same recording; for comparison.
struct OtherMethods {
  double chi2_p = 1;
  std::vector<std::string> stepwise_bic;
  std::string best_bayes_factor;
  double best_bayes_probability = 0;
};

struct ResidualRow {
  std::string feature;
  int touch = 1, setup = 1, run = 1;
  double time_s = 0;
  double x_mm = 0, y_mm = 0, z_mm = 0;
  double before_um = 0, after_um = 0;  ///< after: held out
};

/// One value of a recording of values, by itself; lengths mm, angles degrees.
struct JudgedValue {
  std::string characteristic, program, unit;
  int run = 1, occurrence = 1;
  double value = 0, reference = 0, deviation = 0;
  double u = 0;              ///< standard deviation over the virtual machines, with that of the reference
  double z = 0;              ///< deviation from the mean of the virtual machines, in units of u
  double p = 1;              ///< share of virtual machines that are at least as far out
  double low = 0, high = 0;  ///< 95 % of the deviations of virtual machines lie between these
  bool beyond_all = false;   ///< no virtual machine is as far out: p is less than it says
};

/// Geometric errors of so many times those of the specification are told: such a machine may still pass an acceptance
/// test, but nobody should take it for one of its specification.
inline constexpr double kLargeErrors = 2;
/// From so many times on it is one that nobody should pass. Of 1600 recordings without a mismatch, half of them of machines
/// with errors up to twice their specification's size, rougher or noisier, 55 ask for twice the
/// harmonics or more, and none of these for more than 2.4 times the errors that fit it better.
inline constexpr double kOutOfSpecification = 4;

/// Adequacy below which the names are doubted.
inline constexpr double kInadequate = 0.05;

/// Whether a recording was judged, or why not: then its p_value means nothing.
enum class Judged {
  yes,
  plan,                ///< its values were not looked at; there is no verdict either
  hidden_by_unknowns,  ///< what is unknown of the part explains whatever it holds
  targets_only,        ///< it holds targets in the place of measured positions
  styli_unlogged,      ///< what several unlogged styli or orientations do may be all of it
};

struct Diagnosis {
  Judged judged = Judged::yes;
  Verdict verdict = Verdict::no_mismatch;
  double p_value = 1;
  std::optional<double> adequacy_p;  ///< that the named effects leave so much by chance; nothing where none were named
  int touches = 0;
  std::vector<DiagnosedEffect> effects;
  std::vector<Location> location;  ///< the one that describes most first
  std::optional<Unexplained> unexplained;
  std::optional<Improvement> improvement;
  std::optional<RunnerUp> runner_up;
  std::vector<CannotJudge> cannot_judge;
  std::vector<Detectable> smallest_detectable;
  std::vector<NextMeasurement> next_measurement;
  std::string otherwise;  ///< what to do next where no measurement of the menu helps; else empty
  BaselineSummary baseline;
  /// What the machine does beside what was found, over what an earlier recording left open, where that is too
  /// much for the same machine.
  std::optional<double> beyond_known;
  /// The third worst length between touches, as a share of its MPE; none where no lengths can be compared.
  std::optional<LengthError> worst_length;
  std::optional<LengthError> beyond;          ///< it, where no machine of the specification makes it so wrong
  std::optional<OtherMethods> other_methods;  ///< none where nothing was judged
  std::vector<ResidualRow> residuals;
  std::vector<JudgedValue> values;  ///< of a recording of values, in its order; then there are no touches
  std::vector<Diagnostic> messages;
  /// What --model-out adds to the machine file: effects, and the JSON text of known_state.
  std::vector<EffectSetting> model_effects;
  /// effects of the machine file, by index, that some of `model_effects` stand for or that are gone
  std::vector<std::size_t> superseded;
  std::string known_state;
};

/// Whether something is wrong, with a name or without: a mismatch, or a machine that is not the one it is taken for.
inline bool is_mismatch(const Diagnosis& d) {
  const bool large = !d.baseline.known && d.baseline.geometry_scale >= kOutOfSpecification;
  return d.judged == Judged::yes && (d.verdict != Verdict::no_mismatch || d.beyond || d.beyond_known || large);
}

/// Whether it says from which size on an effect shows, or that it cannot be judged.
bool tells_of(const Diagnosis&, std::string_view effect);

struct DiagnoseOptions {
  std::uint64_t seed = 1;
  int threads = 1;
  bool design_only = false;
  bool keep_state = false;               ///< fill known_state
  const Workpiece* workpiece = nullptr;  ///< what is known of the part; none: as the recording says
  Progress progress;
};

/// Judges a recording (several files joined) on a machine; `file` names it in messages. Throws UserError:
/// data that cannot be used.
Diagnosis diagnose_recording(const Recording&, const Machine&, const DiagnoseOptions&, const std::string& file);

/// What is wrong with a recording before anything is judged: another unit, swapped axes, touches paired with other targets,
/// a tip's radius too much. Throws UserError; returns what it warns of. Wherever the part stood, and whatever its sizes where it says so (`# surfaces`).
std::vector<Diagnostic> recording_problems(const Recording&, const Machine&, const std::string& file);

}  // namespace abbe
