#include "engine/diagnose/findings/one_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "engine/diagnose/explanations/patterns/touch_factors.hpp"
#include "engine/diagnose/findings/coordinate.hpp"
#include "engine/diagnose/model/sizes_by_group.hpp"

namespace abbe::diagnose {

namespace {

struct Grouping {
  Factor factor;
  std::vector<int> group;                                     ///< by row
  std::function<std::string(const std::vector<int>&)> where;  ///< of the rows of a group
};

/// Thirds of the touches along something, in order; touches of one value are in one.
std::vector<int> thirds(const std::vector<double>& value) {
  std::vector<double> sorted = value;
  std::sort(sorted.begin(), sorted.end());
  std::vector<int> out;
  for (const double v : value) {
    const auto below = std::lower_bound(sorted.begin(), sorted.end(), v) - sorted.begin();
    out.push_back(static_cast<int>(3 * below / static_cast<std::ptrdiff_t>(sorted.size())));
  }
  return out;
}

class Groupings {
 public:
  explicit Groupings(const Case& c) : c_(c), f_(c.touches, c.rows) {
    along(Factor::time, c.recording->rows.front().time_s ? kClock : kTouchNumber);
    since(Factor::setup, "after the part was put down", f_.clamped);
    since(Factor::head, "after the head was turned", f_.settled);
    for (const Coordinate& place : kPosition) along(Factor::position, place);
    if (patterns::differ(f_.part_above_20)) along(Factor::temperature, kThermometers[0]);
    as_touched(Factor::direction, sides(), [](const TouchScene& s) {
      return fmt::format("normal {}{}", s.normal[largest_of(s.normal)] > 0 ? '+' : '-', "xyz"[largest_of(s.normal)]);
    });
    as_touched(Factor::head, f_.orientation, [](const TouchScene& s) {
      return fmt::format("A {:.1f} B {:.1f}", in_degrees(s.stylus.head_a_rad), in_degrees(s.stylus.head_b_rad));
    });
    as_touched(Factor::sensor, f_.sensor, [](const TouchScene& s) { return std::string(s.stylus.name); });
    as_touched(Factor::feature, f_.feature, [this](const TouchScene& s) { return c_.touches.features[s.feature]; });
    as_touched(Factor::setup, f_.setup, [](const TouchScene& s) { return fmt::format("setup {}", s.setup); });
    as_touched(Factor::run, f_.run, [](const TouchScene& s) { return fmt::format("run {}", s.run); });
    as_touched(Factor::speed, f_.speed, [](const TouchScene& s) { return fmt::format("{:g} mm/s", s.speed_mm_s); });
  }

  const std::vector<Grouping>& all() const { return all_; }

 private:
  static int largest_of(const Vec3& n) {
    int axis = 0;
    for (const int k : {1, 2})
      if (std::abs(n[k]) > std::abs(n[axis])) axis = k;
    return axis;
  }

  void along(Factor factor, const Coordinate& coordinate) {
    std::vector<double> value;
    for (const int i : c_.rows) value.push_back(coordinate.of(c_.touches.touches[i].scene));
    add({factor, thirds(value), [value, coordinate](const std::vector<int>& rows) {
           double low = value[rows.front()], high = low;
           for (const int i : rows) low = std::min(low, value[i]), high = std::max(high, value[i]);
           return fmt::format("{} {}", coordinate.name, in_words(coordinate, low, high));
         }});
  }

  void since(Factor factor, const char* event, const patterns::Points& points) {
    std::vector<double> value;
    for (const auto& p : points) value.push_back(p.front());
    const std::vector<int> group = thirds(value);
    add({factor, group, [group, event](const std::vector<int>& rows) {
           constexpr std::array kThird = {"first", "second", "last"};
           return fmt::format("the {} third of the time {}", kThird[static_cast<std::size_t>(group[rows.front()])],
                              event);
         }});
  }

  template <class Label>
  void as_touched(Factor factor, const std::vector<int>& group, Label label) {
    add({factor, group, [this, label](const std::vector<int>& rows) { return label(c_.scene(rows.front())); }});
  }

  std::vector<int> sides() const {
    std::vector<int> out;
    for (const Vec3& n : f_.normal) out.push_back(2 * largest_of(n) + (n[largest_of(n)] > 0 ? 1 : 0));
    return out;
  }

  void add(Grouping g) {
    if (patterns::several(g.group)) all_.push_back(std::move(g));
  }

  const Case& c_;
  patterns::TouchFactors f_;
  std::vector<Grouping> all_;
};

/// The rows of each group, in the order of their numbers.
std::vector<std::vector<int>> rows_of_groups(const std::vector<int>& group) {
  std::map<int, std::vector<int>> rows;
  for (std::size_t i = 0; i < group.size(); ++i) rows[group[i]].push_back(static_cast<int>(i));
  std::vector<std::vector<int>> out;
  for (auto& [number, list] : rows) out.push_back(std::move(list));
  return out;
}

/// Where the size is largest and smallest, of the groups that tell it.
void tell_extremes(const Grouping& g, const SizesByGroup& sizes, SizeDifference& out) {
  constexpr double kTells = 0.7;  // standard uncertainty up to which a size says something
  const std::vector<std::vector<int>> rows = rows_of_groups(g.group);
  std::vector<Eigen::Index> told;
  for (Eigen::Index k = 0; k < sizes.size.size(); ++k)
    if (sizes.u(k) < kTells) told.push_back(k);
  if (told.size() < 2) return;
  const auto [least, most] = std::minmax_element(
      told.begin(), told.end(), [&](Eigen::Index a, Eigen::Index b) { return sizes.size(a) < sizes.size(b); });
  const auto size = [&](Eigen::Index k) {
    return SizeDifference::Size{g.where(rows[static_cast<std::size_t>(k)]), sizes.size(k), sizes.u(k)};
  };
  out.largest = size(*most);
  out.smallest = size(*least);
}

}  // namespace

std::optional<SizeDifference> size_difference(const Case& c, const std::vector<const Matrix*>& found, std::size_t which,
                                              const Hyperparameters& hyper) {
  const OneShape shape(likelier_ensemble(c, c.model), hyper, found, which);
  const Groupings groupings(c);
  std::optional<SizeDifference> out;
  int looked_at = 0;
  for (const Grouping& g : groupings.all()) {
    const SizesByGroup sizes = shape.by(g.group);
    if (sizes.dof == 0) continue;
    ++looked_at;
    SizeDifference d{g.factor, g.group, sizes.p(), sizes.chi2 / std::max(shape.explains(), 1e-12), {}, {}};
    tell_extremes(g, sizes, d);
    const bool matters = d.share >= kOneSize && d.largest.times - d.smallest.times >= kApart;
    if (matters && (!out || d.p < out->p)) out = std::move(d);
  }
  if (out) out->p = std::min(1.0, out->p * looked_at);
  return out;
}

bool of_several_sizes(const std::optional<SizeDifference>& d) { return d && d->p < kAlarm; }

std::string in_words(const SizeDifference& d) {
  return fmt::format("differs: {:.1f} ± {:.1f} times that of all touches at {}, {:.1f} ± {:.1f} times at {}",
                     d.largest.times, 2 * d.largest.u, d.largest.where, d.smallest.times, 2 * d.smallest.u,
                     d.smallest.where);
}

}  // namespace abbe::diagnose
