// The recording on the bench: everything that the steps of a diagnosis share.
#pragma once

#include "engine/diagnose/baseline/baseline.hpp"
#include "engine/diagnose/diagnosis.hpp"
#include "engine/diagnose/model/evidence.hpp"

namespace abbe::diagnose {

/// False alarms that a diagnosis allows itself.
inline constexpr double kAlarm = 0.01;
/// Standard deviations, predicted from all other touches, beyond which a touch is a gross outlier: one in 40
/// 000 normal ones.
inline constexpr double kOutlier = 4.2;
/// Probability that a set of names must reach.
inline constexpr double kCredible = 0.95;

struct Case {
  const Recording* recording = nullptr;
  const Machine* machine = nullptr;
  DiagnoseOptions options;
  RecordedTouches touches;
  Baseline baseline;
  double step_um = 0;        ///< of which all positions of the file are multiples
  double rounding_um = 0;    ///< standard uncertainty by that, where it counts beside the probe's
  std::vector<char> masked;  ///< by touch: a gross outlier
  Vector off_um;             ///< by touch: how far a masked one lies from what the others predict
  std::vector<int> rows;     ///< touches that take part
  LinearModel model;         ///< of `rows`
  Hyperparameters hyper;
  bool rough = false;         ///< the machine's errors are rougher than the specification's ensemble
  Explanations explanations;  ///< on `rows`
};

/// The model with the signatures of some blocks as unknowns without a prior.
LinearModel with_free(const LinearModel&, const std::vector<const Matrix*>& signatures);
/// A model of this case with the ensemble of error functions that its recording fits better: the
/// specification's, or the rougher one.
LinearModel likelier_ensemble(const Case&, const LinearModel&);
/// The explanations of one kind only; `kept` by index into the list.
Explanations only(const Explanations&, const std::vector<int>& kept);
/// Rows of every signature.
Explanations rows_of(const Explanations&, const std::vector<Eigen::Index>& rows);

/// The likeliest variant of an explanation, given the data and what was believed of it before.
int best_block(const Explanations&, int explanation, const Evidence&);

/// One mismatch that the search has found.
struct Finding {
  int explanation = -1;       ///< the likeliest
  int block = -1;             ///< its likeliest variant
  std::vector<int> variants;  ///< blocks, those of its variants that count; empty: those of its explanation
  std::vector<int> set;       ///< explanations that together reach kCredible, likeliest first
  double probability = 0;     ///< of the set
  Evidence evidence;          ///< given the findings before
};

struct SearchResult {
  double p_value = 1;
  double adequacy = 1;             ///< p-value of what the findings leave; 1 without any
  std::vector<Finding> findings;   ///< of the catalogue
  std::optional<Finding> other;    ///< what the catalogue does not explain
  std::optional<Finding> nearest;  ///< the name that was doubted in favour of `other`
  Evidence first;                  ///< before any finding, with the finer variants of what was found
  Evidence on_grid;                ///< that of the grid alone, as `null` is
  std::vector<Evidence> null;      ///< simulated, before any finding
  /// of the recording beside all that was found: a mismatch passes for noise and for larger errors
  Hyperparameters hyper;
};
/// The smallest set of effects, or of patterns, that holds kCredible of the belief in its own kind; no
/// explanation where there are none of it.
Finding finding_of(const Explanations&, const Evidence&, bool catalogue);
/// A name must be so many times as likely as no name. One that leaves something of the mismatch must be far
/// likelier: physics that the catalogue does not have looks like its nearest effect.
inline constexpr double kNamed = 1, kNamedInDoubt = 100;
bool likelier(const Finding& name, const Finding& pattern, double times);
/// Up to so many times less likely, what was not chosen is told beside what was.
inline constexpr double kAsWell = 3;
/// The signatures of findings; of all that was found, a pattern without a name too.
std::vector<const Matrix*> signatures_of(const Case&, const std::vector<Finding>&);
std::vector<const Matrix*> signatures_of(const Case&, const SearchResult&);
/// `first`: the evidence of the whole recording. Effects that are found get finer variants, in the case and in `first`.
SearchResult search(Case&, EvidenceSearch& first);
/// Finer variants of the effects that a recording speaks for: moments, periods and the like between those of
/// the grid. They are appended to the blocks and take the place of the coarse ones in their explanations; the
/// search judges them too.
void refine(const Case&, Explanations&, EvidenceSearch&);

/// Fits the recording without its gross outliers: fills `masked`, `off_um`, `rows`, `model`, `hyper`.
void mask_outliers(Case&);
/// Takes the noise of each touch out of its raw readings, where there are any (own_noise.cpp). `first`: the
/// evidence of the explanations so far, none of which looks at readings.
void free_readings_of_noise(Case&, const EvidenceSearch& first);

/// Steps that fill parts of the answer.
/// A recording without its exact copies of rows. Throws UserError: one touch with two values.
Recording without_copies(const Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// A recording whose clock began long before its first touch, with times from that touch on (N0721).
void count_from_first_touch(Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// A recording without what was logged in some rows only: what is missing would be taken for its usual value, beside
/// what was logged (W0722).
void leave_out_partly_logged(Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// Throws UserError: another unit, axes or normals.
void check_data(const Recording&, const Machine&, const std::string& file);
/// Throws UserError when many touches lie beside their targets; a few are warned of.
void check_pairing(const Recording&, const RecordedTouches&, const std::string& file,
                   std::vector<Diagnostic>& messages);
/// The factor in which an explanation shows in this recording: its own; or, where all touches are alike in
/// that, what of it they do differ in: the place, where it acts on that, else the direction.
Factor shown_in(const Case&, const Explanation&);
/// Of what the search has found; nothing without.
std::vector<Location> locate(const Case&, const EvidenceSearch& first, const SearchResult&);
struct FoundSize {
  std::vector<DiagnosedParameter> parameters;
  double largest_um = 0;  ///< DiagnosedEffect::largest_um
};
FoundSize estimate_size(const Case&, const SearchResult&, std::size_t finding);
Unexplained describe_unexplained(const Case&, const SearchResult&);
struct NoiseFinding {
  const Effect* effect = nullptr;
  double p = 1;
  std::vector<DiagnosedParameter> parameters;
  std::string sentence;
  bool certain = true;  ///< that it is noise: what scatters may else be a pattern too fine for this recording
  std::optional<Factor> factor = {};  ///< in which it shows; none of what is everywhere
  std::vector<std::pair<std::string, std::string>> where = {};
};
std::vector<NoiseFinding> judge_noise(const Case&, const SearchResult&);
void show_improvement(const Case&, const SearchResult&, Diagnosis&);
std::vector<Detectable> smallest_detectable(const Case&, const EvidenceSearch&);
std::vector<NextMeasurement> next_measurements(const Case&, const SearchResult*, const std::vector<Detectable>&);
std::string otherwise(const Case&, const SearchResult&, const std::vector<NextMeasurement>&);
Rivals rivals(const Case&, const Evidence& first);

}  // namespace abbe::diagnose
