// The grid of the search is as coarse as a small effect allows; a large one tells its moment or period much
// more closely, and on the coarse grid would leave a remainder that no longer looks like it. Where the
// recording speaks for an effect, the cells of its likeliest variants are therefore divided, and again, as in
// adaptive quadrature: the sum of likelihood times cell is the evidence.
#include "engine/diagnose/explanations/refine.hpp"

#include <algorithm>

#include "engine/diagnose/explanations/catalogue.hpp"
#include "engine/diagnose/explanations/parameter_grid.hpp"
#include "engine/diagnose/explanations/run_changes.hpp"

namespace abbe::diagnose {

namespace {

constexpr int kSteps = 4, kMostEffects = 6, kMostCells = 3, kParts = 3;
/// Nats below the likeliest cell from which on one is not worth a closer look.
constexpr double kFarBelow = 3;

/// How many periods far from the likeliest get a closer look, and how much of what speaks for one the middle of its cell may
/// miss: where touches come in blocks, periods that are far from each other fit alike.
constexpr std::size_t kMostPeriods = 16;
constexpr double kMissed = 0.5;

/// Whether a change between runs stands for several of them.
bool of_several_runs(const Variant& b) { return b.runs.high > b.runs.low + 1; }

bool divisible(const Variant& b) {
  return !b.finest && (of_several_runs(b) || std::any_of(b.cells.begin(), b.cells.end(), [](const Cell& cell) {
                         return cell.high > cell.low;
                       }));
}

/// The effects that may be the name, likeliest first. How far they are below a pattern tells nothing yet: on
/// the coarse grid it may be far.
std::vector<int> candidates(const Explanations& all, const Evidence& evidence) {
  std::vector<std::pair<double, int>> order;
  for (std::size_t k = 0; k < all.list.size(); ++k)
    if (all.list[k].effect) order.emplace_back(-evidence.log_bayes[k], static_cast<int>(k));
  std::sort(order.begin(), order.end());
  order.resize(std::min<std::size_t>(order.size(), kMostEffects));
  std::vector<int> list;
  for (const auto& [minus, k] : order) list.push_back(k);
  return list;
}

/// Whether two variants differ in no choice and their cells touch. The moment of what changed between runs is
/// that of the runs.
bool neighbours(const Variant& a, const Variant& b, const Effect& effect) {
  if (a.group != b.group || a.axis != b.axis) return false;
  const bool of_runs = of_several_runs(a) || of_several_runs(b);
  if (a.change != b.change && !(of_runs && a.change.is_like(b.change) && adjoin(a.runs, b.runs))) return false;
  for (std::size_t p = 0; p < a.theta.size(); ++p)
    if (!(of_runs && moment_of(effect) == p) && !adjoin(a.cells[p], b.cells[p])) return false;
  return true;
}

bool has_period(const Effect& effect) {
  return std::any_of(effect.parameters.begin(), effect.parameters.end(),
                     [](const EffectParameter& p) { return p.sought == Sought::period; });
}

/// The likeliest divisible variants, and those beside the likeliest: the value that stands for a cell may be
/// the wrong one.
std::vector<int> cells_to_divide(const Explanations& all, const Explanation& e, const Evidence& evidence) {
  const auto variant = [&](int b) -> const Variant& { return all.variants[b]; };
  const auto belief = [&](int b) { return log_belief(all, evidence, b); };
  std::vector<int> order = e.variants, list;
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return belief(a) != belief(b) ? belief(a) > belief(b) : a < b; });
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool likely = k < kMostCells && belief(order[k]) > belief(order[0]) - kFarBelow;
    if (divisible(variant(order[k])) && (likely || neighbours(variant(order[0]), variant(order[k]), *e.effect)))
      list.push_back(order[k]);
  }
  if (!has_period(*e.effect)) return list;
  std::size_t peaks = 0;  // no likelier one is beside them
  for (auto at = order.begin(); at != order.end() && peaks < kMostPeriods; ++at) {
    if (variant(*at).axis >= 0) continue;  // finer ones are along any direction
    if (belief(*at) < (1 - kMissed) * belief(order[0]) - kFarBelow) break;
    const bool beside = std::any_of(
        order.begin(), at, [&](int likelier) { return neighbours(variant(likelier), variant(*at), *e.effect); });
    if (beside) continue;
    ++peaks;
    if (divisible(variant(*at)) && std::find(list.begin(), list.end(), *at) == list.end()) list.push_back(*at);
  }
  return list;
}

/// A cell in thirds.
std::vector<TriedValue> thirds(const Cell& cell) {
  std::vector<TriedValue> out;
  const double step = (cell.high - cell.low) / kParts;
  for (int k = 0; k < kParts; ++k)
    out.push_back({cell.low + (k + 0.5) * step, {cell.low + k * step, cell.low + (k + 1) * step}, 1.0 / kParts});
  return out;
}

std::vector<TriedValue> thirds_of_touches(const Cell& cell, const RecordedTouches& t) {
  std::vector<double> ends{cell.low};
  for (const RecordedTouch& touch : t.touches)
    if (touch.scene.time_s > ends.back() && touch.scene.time_s < cell.high) ends.push_back(touch.scene.time_s);
  ends.push_back(cell.high);
  return moments_between(ends, kParts);
}

/// A stretch of runs in thirds; else what stands for one run, or for none, as it is. No parameters yet. Finer ones are along
/// any direction: along an axis alone two names together, each with few columns, would explain what is in no catalogue, as
/// a trend that begins late.
std::vector<Variant> thirds_of_runs(const Variant& whole, const std::vector<LaterRun>& changes) {
  std::vector<LaterRun> stretch;
  for (const LaterRun& c : changes)
    if (c.runs.low >= whole.runs.low && c.runs.high <= whole.runs.high) stretch.push_back(c);
  const std::vector<LaterRun> parts = of_several_runs(whole)
      ? in_stretches(stretch, kParts)
      : std::vector<LaterRun>{{whole.change.first(), whole.runs, {}}};
  std::vector<Variant> list(parts.size());
  for (std::size_t k = 0; k < parts.size(); ++k) {
    list[k].explanation = whole.explanation;
    list[k].group = whole.group;
    list[k].change = whole.change;
    if (whole.change.any()) list[k].change.first() = parts[k].from_run;
    list[k].runs = parts[k].runs;
    list[k].weight = whole.weight / double(parts.size());
  }
  return list;
}

/// What is new in a run happens at the moment of the change that stands for it.
void set_moment(Variant& part, const Effect& effect, const std::vector<LaterRun>& changes) {
  const std::optional<std::size_t> moment = moment_of(effect);
  if (!moment || part.change.from == 0) return;
  for (const LaterRun& c : changes)
    if (c.from_run == part.change.from) part.theta[*moment] = c.between_s(), part.cells[*moment] = c.gap_s;
}

/// The cell in thirds along every parameter that it has an extent in, and along its runs.
std::vector<Variant> parts_of(const Variant& whole, const Effect& effect, const RecordedTouches& t,
                              const std::vector<LaterRun>& changes) {
  std::vector<Variant> list = thirds_of_runs(whole, changes);
  for (std::size_t p = 0; p < whole.theta.size(); ++p) {
    const Cell& cell = whole.cells[p];
    const std::vector<TriedValue> parts = cell.high <= cell.low ? std::vector<TriedValue>{{whole.theta[p], cell, 1}}
        : effect.parameters[p].sought == Sought::moment         ? thirds_of_touches(cell, t)
                                                                : thirds(cell);
    list = with_each(list, parts);
  }
  for (Variant& part : list) set_moment(part, effect, changes);
  return list;
}

/// Divides one variant of an explanation, unless its parts are all the same.
void divide(const Case& c, Explanations& all, int explanation, int which) {
  Explanation& e = all.list[explanation];
  std::vector<Variant> parts = parts_of(all.variants[which], *e.effect, c.touches, later_runs(c.touches, c.rows));
  for (Variant& part : parts) {
    Variant made = variant_like(part, *e.effect, c.touches, c.rows);
    part.columns = std::move(made.columns);
    part.signature = std::move(made.signature);
    part.joined = made.joined;
  }
  std::erase_if(parts, [](const Variant& b) { return b.signature.cols() == 0; });
  if (std::all_of(parts.begin(), parts.end(),
                  [&](const Variant& b) { return same_columns(b.signature, parts.front().signature); })) {
    all.variants[which].finest = true;
    return;
  }
  e.variants.erase(std::find(e.variants.begin(), e.variants.end(), which));
  for (Variant& part : parts) {
    e.variants.push_back(static_cast<int>(all.variants.size()));
    all.variants.push_back(std::move(part));
  }
}

}  // namespace

void refine(const Case& c, Explanations& all, EvidenceSearch& search) {
  for (int step = 0; step < kSteps; ++step) {
    const std::size_t before = all.variants.size();
    for (const int k : candidates(all, search.evidence()))
      for (const int b : cells_to_divide(all, all.list[k], search.evidence())) divide(c, all, k, b);
    if (all.variants.size() == before) return;
    search.extend(all, before);
  }
}

}  // namespace abbe::diagnose
