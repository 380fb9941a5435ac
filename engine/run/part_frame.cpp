#include "engine/run/part_frame.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include "engine/math/rigid_fit.hpp"
#include "engine/math/round_fit.hpp"
#include "engine/math/units.hpp"

namespace abbe {

namespace {

/// Targets of one point of the part in two placements agree this well: they come from one drawing.
constexpr double kSamePoint_mm = 0.1;

/// The point that lies at one distance behind all touches of a feature. Nothing for a feature that is touched from too
/// few sides (a face, a line), which has no such point.
std::optional<Vec3> centre_of(const std::vector<const AimedTouch*>& touches) {
  std::vector<Vec3> normals, surfaces;
  for (const AimedTouch* t : touches) normals.push_back(t->normal), surfaces.push_back(t->surface);
  const RoundFit round = round_fit(surfaces, normals);
  constexpr double kFlat = 0.05;
  if (touches.size() < 3 || round.spread < kFlat) return std::nullopt;
  for (std::size_t i = 0; i < normals.size(); ++i)
    if (norm(round.rest(surfaces[i], normals[i])) > kSamePoint_mm) return std::nullopt;
  return round.centre;
}

/// What a setup knows of the part: points with a key that is the same in every setup.
using Known = std::map<std::pair<std::string, int>, Vec3>;

/// The transform of the points that both know, if they are the same points of one rigid part.
std::optional<Rigid> carried(const Known& here, const Known& first) {
  std::vector<Vec3> from, to;
  for (const auto& [key, point] : here) {
    const auto same = first.find(key);
    if (same != first.end()) from.push_back(point), to.push_back(same->second);
  }
  std::optional<Rigid> X = rigid_fit(from, to);
  for (std::size_t i = 0; X && i < from.size(); ++i)
    if (norm(*X * from[i] - to[i]) > kSamePoint_mm) X.reset();
  return X;
}

/// Those of features of which the other knows as many: where touches were left out, those after them may be numbered anew.
Known of_whole_features(const Known& here, const Known& other) {
  std::map<std::string, int> more;
  for (const auto& [key, point] : here) ++more[key.first];
  for (const auto& [key, point] : other) --more[key.first];
  Known out;
  for (const auto& [key, point] : here)
    if (more.at(key.first) == 0) out.emplace(key, point);
  return out;
}

/// To 1 um and 1 urad.
std::array<long, 12> rounded(const Rigid& X) {
  std::array<long, 12> key{};
  auto out = key.begin();
  for (const Vec3& column : {X.R.cx, X.R.cy, X.R.cz})
    for (int k = 0; k < 3; ++k) *out++ = std::lround(kUradPerRad * column[k]);
  for (int k = 0; k < 3; ++k) *out++ = std::lround(kUmPerMm * X.p[k]);
  return key;
}

}  // namespace

void FrameCount::add(const Rigid& X_WD, const Vec3& surface_W) {
  sum_ += surface_W;
  const int order = static_cast<int>(used_.size());
  ++used_.try_emplace(rounded(X_WD), Used{X_WD, 0, order}).first->second.touches;
}

Rigid FrameCount::of_part(const Rigid& X_WM) const {
  Used best{X_WM};
  int touches = 0;
  for (const auto& [key, used] : used_) {
    touches += used.touches;
    if (used.touches > best.touches || (used.touches == best.touches && used.order < best.order)) best = used;
  }
  if (touches > 0 && rounded(best.X_WD) == rounded(X_WM)) best.X_WD.p = sum_ / static_cast<double>(touches);
  return best.X_WD;
}

PartFrames::PartFrames(const std::vector<AimedTouch>& touches) {
  std::map<int, Known> points, centres;
  std::map<std::pair<int, std::string>, std::vector<const AimedTouch*>> features;
  for (const AimedTouch& t : touches) {
    points[t.setup][{t.feature, t.index}] = t.surface;
    features[{t.setup, t.feature}].push_back(&t);
  }
  for (const auto& [which, mine] : features)
    if (const std::optional<Vec3> c = centre_of(mine)) centres[which.first][{which.second, 0}] = *c;
  const auto middle = [&](int setup) {
    std::vector<Vec3> all;
    for (const auto& [key, point] : points.at(setup)) all.push_back(point);
    return mean_of(all);
  };
  const int first = points.begin()->first;
  const Rigid X_P1{Mat3{}, -middle(first)};
  for (const auto& [setup, known] : points) {
    std::optional<Rigid> X_1W = carried(known, points[first]);
    if (!X_1W) X_1W = carried(of_whole_features(known, points[first]), points[first]);
    if (!X_1W) X_1W = carried(centres[setup], centres[first]);
    X_PW_[setup] = X_1W ? X_P1 * *X_1W : Rigid{Mat3{}, -middle(setup)};
  }
}

}  // namespace abbe
