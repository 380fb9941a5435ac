// The case of a recording: everything that the steps of a diagnosis share.
#pragma once

#include <optional>
#include <string>

#include "engine/diagnose/baseline/baseline.hpp"
#include "engine/diagnose/diagnosis.hpp"
#include "engine/diagnose/levels.hpp"
#include "engine/diagnose/model/explanation.hpp"

namespace abbe::diagnose {

struct Case {
  const Recording* recording = nullptr;
  const Machine* machine = nullptr;
  DiagnoseOptions options;
  RecordedTouches touches;
  bool styli_unlogged = false;  ///< more than one stylus or orientation touched, and no row says which
  Baseline baseline;
  double step_um = 0;        ///< of which all positions of the file are multiples
  double rounding_um = 0;    ///< standard uncertainty by that, where it counts beside the probe's
  std::vector<char> masked;  ///< by touch: a gross outlier
  Vector off_um;             ///< by touch: how far a masked one lies from what the others predict
  std::vector<int> rows;     ///< touches that take part: not masked, and others say something of them
  LinearModel model;         ///< of `rows`
  Hyperparameters hyper;
  bool rough = false;         ///< the machine's errors are rougher than the specification's ensemble
  Explanations explanations;  ///< on `rows`

  /// Of a row of `model`.
  const TouchScene& scene(Eigen::Index row) const { return touches.touches[rows[row]].scene; }
};

/// The touches, what the part is, and what a machine in order may do to them. `surfaces`: what they count as; without,
/// they are what the targets say unless half of them is not. Messages, and lengths beyond the specification, go to the
/// diagnosis.
Case case_of(const Recording&, const Machine&, const DiagnoseOptions&, std::optional<Surfaces> surfaces,
             const std::string& file, Diagnosis&);
/// Positions are multiples of a step. Rounding is noise too: without it, what is rounded coarsely would lie on its steps
/// without any.
void judge_rounding(double step_um, Case&);

/// Whether several runs share one placement of the part.
bool runs_share_a_setup(const Case&);

/// Whether a change between runs began, or ended, while the part stayed where it was.
bool begins_within_a_setup(const Case&, const RunChange&);

/// The touches in the order of their times.
std::vector<std::size_t> by_time(const RecordedTouches&);

/// A model of this case with the ensemble of error functions that its recording fits better: the
/// specification's, or the rougher one.
inline LinearModel likelier_ensemble(const Case& c, const LinearModel& m) {
  return c.rough && m.rough.cols() > 0 ? rougher(m) : m;
}

}  // namespace abbe::diagnose
