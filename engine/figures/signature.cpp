#include "engine/figures/signature.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "engine/base/ids.hpp"
#include "engine/figures/scenes.hpp"
#include "engine/lanes/random.hpp"
#include "engine/math/units.hpp"

namespace abbe {

namespace {

constexpr int kLineSamples = 480, kPointSamples = 600;
constexpr double kMatters = 0.1;  ///< share of the largest |r| from which a change is worth a figure
constexpr int kRandomTouches = 400;

struct Face {
  const char* name;
  double azimuth_deg, elevation_deg;
};
constexpr Face kFaces[] = {{"+x", 0, 0}, {"+y", 90, 0}, {"+z", 0, 90}};

struct Extent {
  double low = 0, high = 0;
  double width() const { return high - low; }
  double largest() const { return std::max(std::abs(low), std::abs(high)); }
};

Extent extent(const std::vector<double>& y) {
  const auto [low, high] = std::minmax_element(y.begin(), y.end());
  return {*low, *high};
}

/// One effect on standard touches.
class Signature {
 public:
  Signature(const Effect& effect, const Machine& machine) : effect_(effect), machine_(machine) {
    for (const EffectParameter& p : effect.parameters) {
      const bool first = theta_.empty(), size = p.linear;
      theta_.push_back(first || (!size && p.choices.empty()) ? p.typical : p.standard);
    }
  }

  Chart chart() {
    choose_abscissa();
    Chart c;
    c.title = effect_.title;
    c.x_title = x_->title;
    c.y_title = "r, µm";
    c.mark = draws_touches() ? Chart::Mark::points : Chart::Mark::lines;
    add_series(c);
    c.subtitle = subtitle();
    return c;
  }

 private:
  bool draws_touches() const { return effect_.draws_per == DrawsPer::touch; }
  bool needed(const Sweep& sweep) const { return effect_.needs & static_cast<unsigned>(sweep.needs); }

  std::vector<double> draws(std::uint32_t machine, std::uint32_t site) const {
    std::vector<double> z;
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(effect_.draws); ++k)
      z.push_back(normal_quantile(uniform_pair({1, machine, stream_of(effect_.name), site, 0, k}).a));
    return z;
  }

  /// r of one touch, um; `touch` is its number, for what is drawn touch by touch.
  double r_um(const StandardTouch& at, std::uint32_t machine, std::uint32_t touch) const {
    const TouchScene scene = scene_of(at, machine_);
    std::uint32_t site = 0;
    if (effect_.draws_per == DrawsPer::visit) site = static_cast<std::uint32_t>(scene.visit);
    if (draws_touches()) site = touch;
    return kUmPerMm * dot(scene.normal, effect_.displace(scene, theta_.data(), draws(machine, site).data()));
  }

  /// What r amounts to at a touch: itself, or its root mean square where it is drawn every time.
  double amount_um(const StandardTouch& at) const {
    if (!draws_touches()) return r_um(at, 1, 0);
    double squares = 0;
    for (std::uint32_t k = 0; k < kRandomTouches; ++k) squares += r_um(at, 1, k) * r_um(at, 1, k);
    return std::sqrt(squares / kRandomTouches);
  }

  static double position(const Sweep& sweep, int i, int samples) {
    return sweep.from + (sweep.to - sweep.from) * i / (samples - 1);
  }

  std::vector<double> amounts(const StandardTouch& base, const Sweep& sweep) const {
    const int samples = draws_touches() ? 9 : kLineSamples + 1;
    std::vector<double> y;
    for (int i = 0; i < samples; ++i) {
      StandardTouch at = base;
      sweep.set(at, position(sweep, i, samples));
      y.push_back(amount_um(at));
    }
    return y;
  }

  static StandardTouch touching(const Face& face) {
    StandardTouch t;
    t.azimuth_deg = face.azimuth_deg, t.elevation_deg = face.elevation_deg;
    return t;
  }

  /// The face on which r changes most along the sweep; of constant ones that with the largest r.
  const Face& best_face(const Sweep& sweep) const {
    const auto worth = [&](const Face& face) {
      const Extent e = extent(amounts(touching(face), sweep));
      return std::pair(e.width(), e.largest());
    };
    return *std::max_element(std::begin(kFaces), std::end(kFaces),
                             [&](const Face& a, const Face& b) { return worth(a) < worth(b); });
  }

  void try_abscissa(const Sweep& sweep) {
    const Face* face = sweep.turns_normal ? nullptr : &best_face(sweep);
    const StandardTouch base = face ? touching(*face) : StandardTouch{};
    const Extent e = extent(amounts(base, sweep));
    const bool changes = e.width() > kMatters * e.largest();
    if (x_ && !changes) return;
    x_ = &sweep, face_ = face, base_ = base, found_ = changes;
  }

  void choose_abscissa() {
    for (const Sweep& sweep : sweeps())
      if (!found_ && needed(sweep)) try_abscissa(sweep);
    ABBE_CHECK(x_ != nullptr);
  }

  bool differ(const StandardTouch& a, const StandardTouch& b) const {
    const std::vector<double> ya = amounts(a, *x_), yb = amounts(b, *x_);
    double difference = 0, largest = 0;
    for (std::size_t i = 0; i < ya.size(); ++i) {
      difference = std::max(difference, std::abs(ya[i] - yb[i]));
      largest = std::max({largest, std::abs(ya[i]), std::abs(yb[i])});
    }
    return difference > kMatters * largest;
  }

  Chart::Series series(std::string name, const StandardTouch& base, std::uint32_t machine) const {
    const int samples = draws_touches() ? kPointSamples : kLineSamples + 1;
    Chart::Series s{std::move(name), {}, {}};
    for (int i = 0; i < samples; ++i) {
      StandardTouch at = base;
      s.x.push_back(position(*x_, i, samples));
      x_->set(at, s.x.back());
      s.y.push_back(r_um(at, machine, static_cast<std::uint32_t>(i)));
    }
    return s;
  }

  void add_series(Chart& c) {
    if (effect_.draws_per == DrawsPer::machine) {
      c.series_title = "virtual machine";
      c.series = {series("1", base_, 1), series("2", base_, 2)};
    } else if (const Face* other = second_face()) {
      c.series_title = "touches on a face";
      c.series = {series(face_->name, base_, 1), series(other->name, touching(*other), 1)};
      face_ = nullptr;  // the legend names both
    } else if (const Sweep* second = second_sweep()) {
      c.series_title = second->title;
      for (const double value : {second->low, second->high}) {
        StandardTouch at = base_;
        second->set(at, value);
        c.series.push_back(series(fmt::format("{:g}", value), at, 1));
      }
    } else {
      c.series = {series("", base_, 1)};
    }
  }

  /// Another face on which r is neither nothing nor the same.
  const Face* second_face() const {
    if (!face_ || draws_touches()) return nullptr;
    const double largest = extent(amounts(base_, *x_)).largest();
    for (const Face& face : kFaces) {
      if (&face == face_) continue;
      if (extent(amounts(touching(face), *x_)).largest() > kMatters * largest && differ(base_, touching(face)))
        return &face;
    }
    return nullptr;
  }

  const Sweep* second_sweep() const {
    for (const Sweep& sweep : sweeps()) {
      if (!needed(sweep) || &sweep == x_ || (sweep.turns_normal && face_)) continue;
      StandardTouch low = base_, high = base_;
      sweep.set(low, sweep.low), sweep.set(high, sweep.high);
      if (differ(low, high)) return &sweep;
    }
    return nullptr;
  }

  std::string subtitle() const {
    std::vector<std::string> parts{std::string(effect_.name)};
    if (!theta_.empty()) parts[0] += fmt::format(", {} = {:g}", effect_.parameters.front().name, theta_.front());
    if (face_) parts.push_back(fmt::format("touches on a face {}", face_->name));
    if (draws_touches()) parts.push_back(fmt::format("{} touches", kPointSamples));
    return fmt::format("{}", fmt::join(parts, "; "));
  }

  const Effect& effect_;
  const Machine& machine_;
  std::vector<double> theta_;
  const Sweep* x_ = nullptr;
  const Face* face_ = nullptr;  ///< none when the abscissa turns the normal
  StandardTouch base_;
  bool found_ = false;  ///< an abscissa along which r changes
};

}  // namespace

Chart signature(const Effect& effect, const Machine& machine) { return Signature(effect, machine).chart(); }

}  // namespace abbe
