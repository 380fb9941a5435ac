// A property of the noise that a recording may show, one file each: how it is judged, and from which size on a plan would
// show it. None shifts a mean: all change the scatter, or a few touches.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/diagnose/findings/noise/scatter.hpp"
#include "engine/diagnose/findings/noise/scatter_design.hpp"
#include "engine/diagnose/findings/search.hpp"

namespace abbe::diagnose {

/// Whether repeats of one touch, with the same stylus at the same place, differ in what scatters more, or agree: they have
/// half of it or more in common.
enum class Repeats { too_few, differ, agree };

struct NoiseFinding {
  const Effect* effect = nullptr;
  double p = 1;
  std::vector<DiagnosedParameter> parameters;
  std::string sentence;
  bool certain = true;  ///< that it is noise: what scatters may else be a pattern too fine for this recording
  Repeats repeats = Repeats::too_few;
  std::optional<Factor> factor = {};  ///< in which it shows; none of what is everywhere
  std::vector<std::pair<std::string, std::string>> where = {};
};

/// What the noise of a recording is judged by.
struct Scatter {
  const Case& c;
  const SearchResult& result;
  Residuals residuals;  ///< none where an imperfect explanation was found: what that leaves is no scatter
  Vector quiet;         ///< by residual, 1: it scatters no more than others, as far as is judged yet
};

struct NoiseProperty {
  const Effect* effect;
  bool of_scatter;  ///< judged by residuals; the others are told by single touches
  std::optional<NoiseFinding> (*judge)(Scatter&);
  /// Appends the smallest size that shows to `smallest_detectable`; to `cannot_judge`, where columns are missing for it.
  void (*plan)(const ScatterDesign&, Diagnosis&);
};
extern const NoiseProperty kJudgedResolution, kJudgedOutliers, kJudgedUnequal, kJudgedVibration;

/// All of them. Groups that scatter more come before what is the same for all.
std::span<const NoiseProperty* const> noise_properties();

/// A figure of an effect of the noise. Its interval ends at 0: none of these changes its sign.
DiagnosedParameter figure(const char* name, const char* unit, double value, double u);
/// What the machine file says of it already; nothing where it does not have the effect.
std::optional<EffectSetting::Value> in_machine_file(const Case&, const Effect&, const std::string& parameter);
/// What repeats say where these rows scatter more, by this share of their variance. It is noise only where they differ.
Repeats repeats_of(const Case&, const Residuals&, const Vector& in, double share);
void ask_repeats(const Scatter&, const Vector& in, double share, NoiseFinding&);

}  // namespace abbe::diagnose
