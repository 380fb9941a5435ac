#include "engine/diagnose/planning/path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "engine/diagnose/planning/shape.hpp"

namespace abbe::diagnose {

namespace {

constexpr double kBack_mm = 20;    // from a touch, where there is room
constexpr double kMargin_mm = 30;  // about the box of all touches
constexpr double kGap_mm = 2;      // between ball and feature on the way to the next touch

/// Where two surfaces that face each other meet, as the distance from each along its normal: s = (q - p) . (n
/// - m) / |n - m|^2, the radius of a bore, half the width of a slot. Infinite where one of them does not lie
/// in front of the other.
double meeting_mm(const TouchScene& a, const TouchScene& b) {
  constexpr double kParallel = 0.01, kFlush_mm = 1e-3;  // |n - m|^2 of six degrees
  const Vec3 apart = a.normal - b.normal, between = b.point - a.point;
  const double square = dot(apart, apart);
  const bool faces = square > kParallel && dot(between, a.normal) > kFlush_mm && dot(between, b.normal) < -kFlush_mm;
  return faces ? dot(between, apart) / square : std::numeric_limits<double>::infinity();
}

struct Box {
  Vec3 low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  void add(const Vec3& p) {
    for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  }
};

/// How far from a point inside a box to its side.
double to_side_mm(const Box& box, const Vec3& from, const Vec3& direction) {
  double out = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k)
    if (std::abs(direction[k]) > 1e-9)
      out = std::min(out, ((direction[k] > 0 ? box.high[k] : box.low[k]) - from[k]) / direction[k]);
  return std::max(0.0, out);
}

class Planner {
 public:
  explicit Planner(const Longer& longer) : all_(longer.touches.touches), first_(longer.first) {
    Touched touched;
    for (std::size_t k = first_; k < all_.size(); ++k)
      touched.points.push_back(scene(k).point), touched.normals.push_back(scene(k).normal);
    const std::optional<Ball> ball = ball_of(touched);
    one_ball_ = ball && ball->radius_mm > 0;
    for (std::size_t k = first_; k < all_.size(); ++k) features_[key(k)].touches.push_back(k);
    for (auto& [which, feature] : features_) feature.hollow = bends_inwards(feature.touches);
    for (std::size_t k = first_; k < all_.size(); ++k) box_.add(centre(k));
    for (int axis = 0; axis < 3; ++axis) {
      const MachineAxis& a = longer.machine[static_cast<Axis>(axis)];
      travel_.low[axis] = a.lowest_mm(), travel_.high[axis] = a.highest_mm();
      box_.low[axis] -= kMargin_mm, box_.high[axis] += kMargin_mm;
    }
    find_height();
  }

  Path path() {
    for (std::size_t k = first_; k < all_.size(); ++k) out_.free_mm.push_back(free_mm(k));
    for (std::size_t k = first_; k < all_.size(); ++k) {
      const bool begins = k == first_;
      if (!begins && straight(k - 1, k)) {
        go(k, clear(k));
      } else {
        if (!begins) leave(k - 1);
        if (begins || scene(k).stylus.tip_ordinal != scene(k - 1).stylus.tip_ordinal)
          out_.steps.push_back({Step::Kind::stylus, k, {}});
        enter(k);
      }
      out_.steps.push_back({Step::Kind::touch, k, {}});
      go(k, clear(k));
    }
    leave(all_.size() - 1);
    return std::move(out_);
  }

 private:
  const TouchScene& scene(std::size_t k) const { return all_[k].scene; }
  Vec3 centre(std::size_t k) const { return scene(k).point + scene(k).stylus.radius_mm * scene(k).normal; }
  Vec3 clear(std::size_t k) const { return centre(k) + out_.free_mm[k - first_] * scene(k).normal; }
  /// Touches of one feature, in one placement of the part.
  struct Feature {
    std::vector<std::size_t> touches;
    bool hollow = false;  ///< some of its normals point towards one another
  };
  std::pair<int, int> key(std::size_t k) const {
    return one_ball_ ? std::pair{0, 0} : std::pair{scene(k).setup, scene(k).feature};
  }

  /// To the middle between surfaces that face each other: those of the feature, and those near it that the
  /// ball did fit between.
  double free_mm(std::size_t k) const {
    const double radius = scene(k).stylus.radius_mm, near = 4 * (radius + kBack_mm);
    double out = kBack_mm;
    for (std::size_t j = first_; j < all_.size(); ++j) {
      const double room = meeting_mm(scene(k), scene(j)) - radius;
      if (key(k) == key(j) || (room > 0 && norm(scene(j).point - scene(k).point) < near))
        out = std::min(out, std::max(0.0, room));
    }
    return out;
  }

  /// Whether the tip may go straight from before one touch to before the next. A feature that bends inwards
  /// is free where the ball has room before every one of its touches; any other, where it is before one of
  /// them.
  bool straight(std::size_t a, std::size_t b) const {
    if (key(a) != key(b) || scene(a).stylus.tip_ordinal != scene(b).stylus.tip_ordinal) return false;
    const double radius = scene(a).stylus.radius_mm;
    const Vec3 from = clear(a), by = clear(b) - from;
    constexpr int kSamples = 40;
    const Feature& feature = features_.at(key(a));
    for (int i = 0; i <= kSamples; ++i) {
      const Vec3 at = from + double(i) / kSamples * by;
      double least = std::numeric_limits<double>::infinity(), most = -least;
      for (const std::size_t j : feature.touches) {
        const double before = dot(scene(j).normal, at - scene(j).point) - radius;
        least = std::min(least, before), most = std::max(most, before);
      }
      constexpr double kRounding_mm = 1e-3;
      if (feature.hollow ? least < -kRounding_mm : most < kGap_mm) return false;
    }
    return true;
  }
  bool bends_inwards(const std::vector<std::size_t>& touches) const {
    return std::any_of(touches.begin(), touches.end(), [&](std::size_t i) {
      return std::any_of(touches.begin(), touches.end(),
                         [&](std::size_t j) { return std::isfinite(meeting_mm(scene(i), scene(j))); });
    });
  }

  /// The readings at a position of the tip, with the stylus of a touch.
  Vec3 reading(std::size_t k, const Vec3& tip) const { return tip - centre(k) + scene(k).reading; }

  /// The head's centre goes a stylus length above the box, or as high as the machine reaches.
  void find_height() {
    double wanted = -1e9, reached = 1e9;
    for (std::size_t k = first_; k < all_.size(); ++k) {
      const StylusScene& s = scene(k).stylus;
      wanted = std::max(wanted, box_.high.z + s.length_mm);
      reached = std::min(reached, centre(k).z + s.length_mm * s.to_head.z + travel_.high.z - scene(k).reading.z);
    }
    height_mm_ = std::min(wanted, reached);
    out_.missing_mm = std::max(0.0, wanted - reached);
  }

  /// Outside the box, along the stylus.
  Vec3 outside(std::size_t k) {
    const Vec3 from = clear(k), along = scene(k).stylus.to_head;
    const double wanted = to_side_mm(box_, from, along),
                 reached = std::min(wanted, to_side_mm(travel_, reading(k, from), along));
    out_.missing_mm = std::max(out_.missing_mm, wanted - reached);
    return from + reached * along;
  }
  Vec3 above(std::size_t k, Vec3 at) const {
    at.z = std::max(at.z, height_mm_ - scene(k).stylus.length_mm * scene(k).stylus.to_head.z);
    return at;
  }

  void leave(std::size_t k) {
    const Vec3 out = outside(k);
    go(k, out);
    go(k, above(k, out));
  }
  void enter(std::size_t k) {
    const Vec3 out = outside(k);
    go(k, above(k, out));
    go(k, out);
    go(k, clear(k));
  }
  void go(std::size_t k, const Vec3& to) {
    constexpr double kSame_mm = 1e-6;
    if (!out_.steps.empty() && out_.steps.back().kind == Step::Kind::go && norm(out_.steps.back().to - to) < kSame_mm)
      return;
    out_.steps.push_back({Step::Kind::go, k, to});
  }

  const std::vector<RecordedTouch>& all_;
  std::size_t first_;
  std::map<std::pair<int, int>, Feature> features_;
  bool one_ball_ = false;  ///< every touch is on one ball, whatever its label
  Box box_, travel_;
  double height_mm_ = 0;  ///< of the head's centre
  Path out_;
};

}  // namespace

Path path_of(const Longer& longer) { return Planner(longer).path(); }

}  // namespace abbe::diagnose
