#include "engine/diagnose/findings/noise/touch_groups.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "engine/effects/noise/noise.hpp"

namespace abbe::diagnose {

namespace {

using Groups = std::vector<TouchGroup>;

DiagnosedParameter limit(const char* name, const char* unit, double value) {
  return {.name = name, .unit = unit, .value = value, .low = value, .high = value};
}

Eigen::Index count(const Case& c) { return static_cast<Eigen::Index>(c.touches.touches.size()); }

const TouchScene& scene_of(const Case& c, Eigen::Index touch) {
  return c.touches.touches[static_cast<std::size_t>(touch)].scene;
}

template <class Of>
Vector by_touch(const Case& c, Of of) {
  Vector out(count(c));
  for (Eigen::Index k = 0; k < out.size(); ++k) out(k) = of(scene_of(c, k));
  return out;
}

TouchGroup touches_with(const char* kind, Factor factor, Vector in, std::vector<DiagnosedParameter> which) {
  return {kind, fmt::format("touches with {}", kind), {"group", kind}, factor, std::move(in), std::move(which)};
}

double middle_of(const Vector& v) { return (v.minCoeff() + v.maxCoeff()) / 2; }

Groups long_styli(const Case& c) {
  const Vector length = by_touch(c, [](const TouchScene& s) { return s.stylus.length_mm; });
  const double long_mm = middle_of(length) + 1;
  return {touches_with("long styli", Factor::sensor, (length.array() > long_mm).cast<double>(),
                       {limit("longer_than_mm", "mm", long_mm)})};
}

Groups tilted_head(const Case& c) {
  return {touches_with("tilted head", Factor::head,
                       by_touch(c, [](const TouchScene& s) { return std::abs(s.stylus.head_a_rad) > kUpright_rad; }),
                       {})};
}

Groups fast_probing(const Case& c) {
  const Vector speed = by_touch(c, [](const TouchScene& s) { return s.speed_mm_s; });
  const double fast_mm_s = middle_of(speed) + 1e-6;
  return {touches_with("fast probing", Factor::speed, (speed.array() > fast_mm_s).cast<double>(),
                       {limit("faster_than_mm_s", "mm/s", fast_mm_s)})};
}

Groups orientations(const Case& c) {
  Groups out;
  for (Eigen::Index first = 0; first < count(c); ++first) {
    if (std::any_of(out.begin(), out.end(), [&](const TouchGroup& g) { return g.in(first) == 1; })) continue;
    const StylusScene& head = scene_of(c, first).stylus;
    const double a = in_degrees(head.head_a_rad), b = in_degrees(head.head_b_rad);
    const std::string orientation = fmt::format("A {:.1f} B {:.1f}", a, b);
    out.push_back(
        {"one orientation",
         "touches with the head at " + orientation,
         {"head", orientation},
         Factor::head,
         by_touch(c, [&](const TouchScene& s) { return same_orientation(s.stylus, head.head_a_rad, head.head_b_rad); }),
         {limit("head_a_deg", "deg", a), limit("head_b_deg", "deg", b)}});
  }
  return out;
}

/// One for each number that touches have of it.
template <class Make>
Groups numbered(const Case& c, int TouchScene::*number, Make make) {
  std::map<int, Vector> touches;
  for (Eigen::Index k = 0; k < count(c); ++k) {
    Vector& in = touches[scene_of(c, k).*number];
    if (in.size() == 0) in = Vector::Zero(count(c));
    in(k) = 1;
  }
  Groups out;
  for (auto& [value, in] : touches) {
    out.push_back(make(value));
    out.back().in = std::move(in);
  }
  return out;
}

Groups features(const Case& c) {
  return numbered(c, &TouchScene::feature, [&](int feature) {
    const std::string& label = c.touches.features[static_cast<std::size_t>(feature)];
    DiagnosedParameter which = limit("feature", "code", feature + 1);
    which.called = label;
    return TouchGroup{"one feature",     "touches on " + label, {"feature", label}, Factor::feature, {},
                      {std::move(which)}};
  });
}

/// `column`: as recordings call it.
TouchGroup of_number(const char* kind, const char* column, Factor factor, int number) {
  return {kind,
          fmt::format("touches of {} {}", column, number),
          {column, std::to_string(number)},
          factor,
          {},
          {limit(column, "code", number)}};
}

Groups setups(const Case& c) {
  return numbered(c, &TouchScene::setup, [](int n) { return of_number("one setup", "setup", Factor::setup, n); });
}

Groups runs(const Case& c) {
  return numbered(c, &TouchScene::run, [](int n) { return of_number("one run", "run", Factor::run, n); });
}

/// The touches of `order` from one up to, but not including, another.
TouchGroup stretch(const Case& c, const std::vector<std::size_t>& order, std::size_t from, std::size_t to) {
  TouchGroup out{"a stretch of time", "", {}, Factor::time, Vector::Zero(count(c)), {}};
  for (std::size_t k = from; k < to; ++k) out.in(static_cast<Eigen::Index>(order[k])) = 1;
  const double from_s = c.touches.touches[order[from]].scene.time_s,
               to_s = c.touches.touches[order[to - 1]].scene.time_s;
  out.touches = fmt::format("touches from {:.0f} s to {:.0f} s", from_s, to_s);
  out.where = {"time", fmt::format("{:.0f} to {:.0f} s", from_s, to_s)};
  out.which = {limit("from_s", "s", from_s), limit("to_s", "s", to_s)};
  return out;
}

/// Halves, quarters, eighths ... of the touches in the order of their times, and those halfway between.
Groups stretches(const Case& c) {
  Groups out;
  if ((c.touches.known & static_cast<unsigned>(Covariate::time)) == 0) return out;
  const std::vector<std::size_t> order = by_time(c.touches);
  for (std::size_t length = order.size() / 2; length >= kEnoughOfGroup; length /= 2)
    for (std::size_t from = 0; from + length <= order.size(); from += length / 2)
      out.push_back(stretch(c, order, from, from + length));
  return out;
}

bool parts(const Vector& in) { return in.sum() >= kEnoughOfGroup && double(in.size()) - in.sum() >= kEnoughOfGroup; }

/// Its ends moved to where it explains most.
TouchGroup sharpened(const Case& c, const Residuals& r, const TouchGroup& found) {
  const std::vector<std::size_t> order = by_time(c.touches);
  const auto in = [&](std::size_t k) { return found.in(static_cast<Eigen::Index>(order[k])) == 1; };
  std::size_t from = 0;
  while (!in(from)) ++from;
  std::size_t to = from + static_cast<std::size_t>(found.in.sum());
  TouchGroup best = found;
  double most = excess_along(r, among_rows(c, best.in)).chi2;
  const auto try_it = [&](std::size_t a, std::size_t b) {
    if (b > order.size() || a >= b) return false;
    TouchGroup moved = stretch(c, order, a, b);
    const Vector rows = among_rows(c, moved.in);
    const double chi2 = parts(rows) ? excess_along(r, rows).chi2 : 0;
    if (chi2 <= most) return false;
    most = chi2, from = a, to = b;
    moved.of_its_kind = found.of_its_kind;
    best = std::move(moved);
    return true;
  };
  for (std::size_t step = (to - from) / 2; step > 0; step /= 2)
    while (try_it(from + step, to) || (from >= step && try_it(from - step, to)) || try_it(from, to + step) ||
           (to >= step && try_it(from, to - step))) {
    }
  return best;
}

/// Upper tail of a binomial law.
double at_least_of(int n, int many, double share) {
  double sum = 0;
  for (int k = n; k <= many; ++k)
    sum += std::exp(std::lgamma(many + 1.0) - std::lgamma(k + 1.0) - std::lgamma(many - k + 1.0) + k * std::log(share) +
                    (many - k) * std::log1p(-share));
  return sum;
}

}  // namespace

Vector among_rows(const Case& c, const Vector& by_touch) {
  Vector out(static_cast<Eigen::Index>(c.rows.size()));
  for (std::size_t k = 0; k < c.rows.size(); ++k) out(static_cast<Eigen::Index>(k)) = by_touch(c.rows[k]);
  return out;
}

std::vector<TouchGroup> touch_groups(const Case& c) {
  constexpr Groups (*kKinds[])(const Case&) = {long_styli, tilted_head, fast_probing, orientations,
                                               features,   setups,      runs,         stretches};
  static_assert(std::size(kKinds) == kGroupKinds);
  Groups out;
  const auto known = [&](const TouchGroup& g) {
    return !parts(g.in) ||
        std::any_of(out.begin(), out.end(), [&](const TouchGroup& other) { return other.in == g.in; });
  };
  for (const auto groups_of : kKinds) {
    Groups of_a_kind = groups_of(c);
    std::erase_if(of_a_kind, known);
    for (TouchGroup& g : of_a_kind) g.of_its_kind = static_cast<int>(of_a_kind.size());
    std::move(of_a_kind.begin(), of_a_kind.end(), std::back_inserter(out));
  }
  return out;
}

double relative_u(const Vector& in) {
  const double inside = in.sum(), outside = double(in.size()) - inside;
  return std::sqrt(1 / (2 * inside) + 1 / (2 * outside));
}

std::optional<NoisyGroup> noisiest(const Case& c, const Residuals& r) {
  std::optional<NoisyGroup> best;
  double along_axes = 0;  // chi2 of what scatters along one of them: a group that faces that way scatters more, too
  for (int axis = 0; axis < 3; ++axis)
    if (const std::optional<Vector> share = share_along(c, axis))
      along_axes = std::max(along_axes, excess_along(r, *share).chi2);
  const auto measured = [&](TouchGroup group, double p) {
    const Vector in = among_rows(c, group.in);
    NoisyGroup out{std::move(group), excess_along(r, in), p};
    out.ratio = std::sqrt(1 + out.excess.size), out.u = out.ratio * relative_u(in);
    return out;
  };
  for (TouchGroup& group : touch_groups(c)) {
    if (!parts(among_rows(c, group.in))) continue;
    // One whose own noise explained more than any explanation has been chosen already, and by more than its scatter.
    const auto& names = c.baseline.noise_names;
    const double alarm =
        std::find(names.begin(), names.end(), group.touches) == names.end() ? kNoiseAlarm : kAlarm / kLooks;
    const int looks = group.of_its_kind;
    NoisyGroup g = measured(std::move(group), 1);
    g.p = looks * chance_of_excess(g.excess.chi2);
    if (g.excess.chi2 <= along_axes || g.p > alarm || g.ratio - 2 * g.u < kLeastRatio || (best && best->p <= g.p))
      continue;
    best = std::move(g);
  }
  if (best && best->group.factor == Factor::time) best = measured(sharpened(c, r, best->group), best->p);
  return best;
}

std::optional<TouchGroup> struck_most(const Case& c) {
  constexpr double kChance = 0.005;
  const auto struck = static_cast<int>(std::count(c.masked.begin(), c.masked.end(), 1));
  std::optional<TouchGroup> best;
  double least = kChance;
  for (TouchGroup& group : touch_groups(c)) {
    int here = 0;
    for (std::size_t i = 0; i < c.masked.size(); ++i)
      here += c.masked[i] && group.in(static_cast<Eigen::Index>(i)) == 1 ? 1 : 0;
    const double chance = at_least_of(here, struck, group.in.mean()) * group.of_its_kind;
    if (chance >= least) continue;
    least = chance;
    best = std::move(group);
  }
  return best;
}

}  // namespace abbe::diagnose
