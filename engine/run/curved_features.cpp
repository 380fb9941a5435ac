#include "engine/run/curved_features.hpp"

#include <algorithm>

#include "engine/math/round_fit.hpp"

namespace abbe {

namespace {

constexpr double kOnePlace_mm = 0.02;  // what rounding and the form of a real surface make of one

/// Whether so many points say that they lie on one ball: it has four unknowns, and the faces of a cube are six.
bool on_one_ball(const std::vector<Vec3>& points, const std::vector<Vec3>& normals) {
  constexpr std::size_t kLeast = 7;
  constexpr double kSpread = 1e-3;
  if (points.size() < kLeast) return false;
  const RoundFit ball = round_fit(points, normals);
  if (ball.spread < kSpread) return false;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (norm(ball.rest(points[i], normals[i])) > kOnePlace_mm) return false;
  return true;
}

}  // namespace

void CurvedFeatures::add(const std::string& feature, int setup, const Vec3& point, const Vec3& normal) {
  constexpr double kParallel = 0.1;  // sine of 6 degrees: faces are wavy, vectors are rounded
  touched_.insert(feature);
  InSetup& f = by_setup_[setup].try_emplace(feature, InSetup{point, normal}).first->second;
  if (norm(cross(f.normal, normal)) > kParallel) f.curved = true;
  if (norm(point - f.point) > kOnePlace_mm) f.single = false;
}

std::set<std::string> CurvedFeatures::curved() const {
  std::set<std::string> out;
  for (const auto& [setup, features] : by_setup_) {
    std::vector<Vec3> points, normals;
    std::vector<std::string> single;
    for (const auto& [label, f] : features) {
      if (f.curved)
        out.insert(label);
      else if (f.single)
        points.push_back(f.point), normals.push_back(f.normal), single.push_back(label);
    }
    if (on_one_ball(points, normals)) out.insert(single.begin(), single.end());
  }
  return out;
}

}  // namespace abbe
