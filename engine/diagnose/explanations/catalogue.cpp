// No physics here, only the effects' own displacements on the recorded scenes.
#include "engine/diagnose/explanations/catalogue.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "engine/diagnose/explanations/parameter_grid.hpp"
#include "engine/diagnose/explanations/patterns/patterns.hpp"
#include "engine/diagnose/explanations/run_changes.hpp"
#include "engine/diagnose/explanations/same_phase.hpp"
#include "engine/diagnose/levels.hpp"
#include "engine/run/recorded/logged.hpp"

namespace abbe::diagnose {

namespace {

/// Covariates that must not only be known but differ, or nothing of the effect can be told from a constant.
constexpr unsigned kMustVary = Covariate::time | Covariate::speed | Covariate::acceleration |
    Covariate::part_temperature | Covariate::scale_temperature | Covariate::air_temperature | Covariate::load;
/// Covariates that a scene has by itself, whatever was logged.
constexpr unsigned kImplied = Covariate::gradients | Covariate::qualification | Covariate::visit;

std::size_t visits_in(const RecordedTouches& t) {
  std::set<int> visits;
  for (const RecordedTouch& touch : t.touches) visits.insert(touch.scene.visit);
  return visits.size();
}

/// Of one difference, as between two indexings, nobody can tell that it is a spread. Without a head there are none.
bool spread_hidden(const Effect& effect, const RecordedTouches& t) {
  constexpr std::size_t kLeastVisits = 3;
  const bool turns = std::any_of(t.touches.begin(), t.touches.end(),
                                 [](const RecordedTouch& touch) { return touch.scene.stylus.indexed; });
  return turns && effect.draws > 0 && effect.draws_per == DrawsPer::visit && visits_in(t) < kLeastVisits;
}

unsigned missing_of(const Effect& effect, const RecordedTouches& t) {
  const unsigned absent = effect.needs & ~(t.known | kImplied);
  const unsigned constant = effect.needs & kMustVary & t.known & ~t.varying;
  return absent | constant;
}

constexpr double kNobodyWeighed_kg = 100, kNobodyNoted_C = 21;

/// Scenes in which what was not logged has a value that lets the effect act, so that it stays an explanation,
/// though one that cannot be judged: a deviation from 20 degrees C that nobody noted, a load that nobody
/// weighed. A part or a scale without a thermometer follows those that have one: what expands with it would else be taken
/// for what has one.
TouchScene with_surrogates(TouchScene scene, const RecordedTouches& t) {
  const auto unknown = [&](Covariate c) { return (t.known & static_cast<unsigned>(c)) == 0; };
  const auto varies = [&](Covariate c) { return (t.varying & static_cast<unsigned>(c)) != 0; };
  auto& [x, y, z] = scene.temperature.scale;
  const double room = varies(Covariate::air_temperature) ? scene.temperature.air : kNobodyNoted_C;
  const double scales = varies(Covariate::scale_temperature) ? (x + y + z) / 3 : room;
  const double part = varies(Covariate::part_temperature) ? scene.temperature.part : room;
  if (unknown(Covariate::part_temperature)) scene.temperature.part = scales;
  if (unknown(Covariate::scale_temperature)) x = y = z = part;
  if (unknown(Covariate::load)) scene.load_kg = kNobodyWeighed_kg;
  return scene;
}

/// The component along the normals of an effect's displacement, um.
class Evaluation {
 public:
  Evaluation(const Effect& effect, const RecordedTouches& t, const std::vector<int>& rows) : effect_(effect) {
    std::map<int, double> begin_s;  // by file; touches stand in the order of time
    const bool assumes = (effect.needs & kMayBeAssumed & ~t.known) != 0;
    for (std::size_t p = 0; p < effect.parameters.size(); ++p)
      if (effect.parameters[p].sought == Sought::setup && effect.parameters[p].unless_logged)
        one_setup_ = static_cast<int>(p);
    for (const int i : rows) {
      const TouchScene scene = scene_for(effect, t.touches[i]);
      if (assumes) logged_.push_back(scene);
      scenes_.push_back(with_surrogates(scene, t));
      if (one_setup_ >= 0) {
        assumed_.push_back(with_part(scene, kNobodyWeighed_kg, kNobodyNoted_C));
        plain_.push_back(with_part(scene, 0, kReferenceTemperature_C));
      }
      start_s_.push_back(begin_s.try_emplace(t.touches[i].file, scenes_.back().time_s).first->second);
    }
  }

  Vector column(const std::vector<double>& theta, RunChange change, const std::vector<double>& draws,
                int visit = -1) const {
    return column(in_one_setup(theta) ? assumed_ : scenes_, theta, change, draws, visit);
  }

  /// Whether it does anything only by what nobody logged.
  bool is_assumed(const std::vector<double>& theta, RunChange change) const {
    const std::vector<TouchScene>& without = in_one_setup(theta) ? plain_ : logged_;
    return !without.empty() && column(without, theta, change, {}, -1).cwiseAbs().maxCoeff() < kNothing_um;
  }

  static constexpr double kNothing_um = 1e-6;

  std::set<int> visits() const {
    std::set<int> list;
    for (const TouchScene& s : scenes_) list.insert(s.visit);
    return list;
  }

 private:
  /// Whether a load or a warmth of one placement is meant, of which nothing or one for all was logged.
  bool in_one_setup(const std::vector<double>& theta) const { return one_setup_ >= 0 && theta[one_setup_] != 0; }

  static TouchScene with_part(TouchScene scene, double load_kg, double part_C) {
    scene.load_kg = load_kg, scene.temperature.part = part_C;
    return scene;
  }

  Vector column(const std::vector<TouchScene>& scenes, const std::vector<double>& theta, RunChange change,
                const std::vector<double>& draws, int visit) const {
    Vector r = Vector::Zero(static_cast<Eigen::Index>(scenes.size()));
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      if (!change.acts_in(scenes[i].run)) continue;
      if (visit >= 0 && scenes[i].visit != visit) continue;  // no draw, no displacement
      const auto along_normal = [&](const TouchScene& s) {
        return kUmPerMm * dot(s.normal, effect_.displace(s, theta.data(), draws.data()));
      };
      if (change.in_each_file) {
        TouchScene since_its_start = scenes[i];
        since_its_start.time_s -= start_s_[i];
        r(static_cast<Eigen::Index>(i)) = along_normal(since_its_start);
      } else {
        r(static_cast<Eigen::Index>(i)) = along_normal(scenes[i]);
      }
    }
    return r;
  }

  const Effect& effect_;
  std::vector<TouchScene> scenes_;
  std::vector<TouchScene> logged_;           ///< without surrogates, if the effect has any
  std::vector<TouchScene> assumed_, plain_;  ///< with the load and warmth of one placement, and without
  int one_setup_ = -1;                       ///< the parameter that tells in which placement
  std::vector<double> start_s_;              ///< of the file that each is of
};

/// Every combination of the values tried, with what each stands for.
std::vector<Variant> settings(const Effect& effect, const std::vector<ParameterGrid>& grids) {
  std::vector<Variant> list(1);
  for (std::size_t p = 0; p < effect.parameters.size(); ++p) {
    const bool linear = effect.parameters[p].linear, varied = !linear && grids[p].kind == ParameterGrid::Kind::tried;
    const double fixed = linear ? 0 : grids[p].fixed;
    list = with_each(list, varied ? grids[p].tried : std::vector<TriedValue>{{fixed, {fixed, fixed}, 1}});
  }
  return list;
}

/// The same with all parameters, and with those of each group alone.
std::vector<Variant> by_groups(const std::vector<Variant>& all, const Effect& effect) {
  std::set<std::string_view> groups{""};
  for (const EffectParameter& p : effect.parameters) groups.insert(p.group);
  std::vector<Variant> list;
  for (const std::string_view group : groups) {
    for (const Variant& variant : all) {
      list.push_back(variant);
      list.back().group = group;
    }
  }
  return list;
}

/// The same along any direction, and along each axis.
std::vector<Variant> by_directions(const std::vector<Variant>& all, const std::vector<ParameterGrid>& grids) {
  const bool directed = std::any_of(grids.begin(), grids.end(), [](const ParameterGrid& grid) {
    return grid.kind == ParameterGrid::Kind::direction;
  });
  std::vector<Variant> list;
  for (int axis = -1; axis < (directed ? 3 : 0); ++axis)
    for (const Variant& variant : all) list.push_back(variant), list.back().axis = axis;
  return list;
}

/// The columns of one variant: each linear parameter by itself, along each direction and phase that is spanned.
class VariantColumns {
 public:
  VariantColumns(const Effect& effect, const std::vector<ParameterGrid>& grids, const Evaluation& evaluate)
      : effect_(effect), evaluate_(evaluate) {
    for (std::size_t p = 0; p < grids.size(); ++p) {
      if (grids[p].kind == ParameterGrid::Kind::direction) direction_ = static_cast<int>(p);
      if (grids[p].kind == ParameterGrid::Kind::phase) phases_.push_back(static_cast<int>(p));
    }
  }

  void fill(Variant& variant) const {
    for (std::size_t p = 0; p < effect_.parameters.size(); ++p)
      if (effect_.parameters[p].linear && (variant.group.empty() || variant.group == effect_.parameters[p].group))
        add_parameter(static_cast<int>(p), variant);
    if (effect_.draws > 0) {
      variant.signature = compressed(variant.signature);
      variant.joined = true;
    }
  }

 private:
  void add_parameter(int p, Variant& variant) const {
    const double unit = effect_.parameters[p].typical;
    for (int d = 0; d < (direction_ >= 0 && variant.axis < 0 ? 3 : 1); ++d) {
      for (int phase = 0; phase < (phases_.empty() ? 1 : 2); ++phase) {
        std::vector<double> theta = variant.theta;
        theta[p] = unit;
        if (direction_ >= 0) theta[direction_] = variant.axis < 0 ? d : variant.axis;
        for (const int at : phases_) theta[at] = 90.0 * phase;
        Column column{p, d + 3 * phase, unit};
        if (effect_.draws > 0) {
          add_draws(theta, column, variant);
          continue;
        }
        column.assumed = evaluate_.is_assumed(theta, variant.change);
        append(variant, column, evaluate_.column(theta, variant.change, {}));
      }
    }
  }

  void add_draws(const std::vector<double>& theta, const Column& column, Variant& variant) const {
    const std::set<int> visits = effect_.draws_per == DrawsPer::visit ? evaluate_.visits() : std::set<int>{-1};
    for (int j = 0; j < effect_.draws; ++j) {
      std::vector<double> z(effect_.draws, 0.0);
      z[j] = 1;
      for (const int visit : visits)
        append(variant, {-1, column.part, column.unit}, evaluate_.column(theta, variant.change, z, visit));
    }
  }

  static void append(Variant& variant, const Column& column, const Vector& values) {
    if (values.cwiseAbs().maxCoeff() < Evaluation::kNothing_um) return;
    variant.columns.push_back(column);
    variant.signature.conservativeResize(values.size(), variant.signature.cols() + 1);
    variant.signature.col(variant.signature.cols() - 1) = values;
  }

  const Effect& effect_;
  const Evaluation& evaluate_;
  int direction_ = -1;
  std::vector<int> phases_;
};

/// Variants of an effect on these touches. Where all places of one direction are at one phase of a scale by plan, as those
/// of a step gauge are, they are at different ones only by what is wrong with each, and a period would explain any
/// mismatch by the mismatch itself: all get the planned phase then.
class Variants {
 public:
  Variants(const Effect& effect, const std::vector<ParameterGrid>& grids, const RecordedTouches& t,
           const std::vector<int>& rows)
      : evaluate_(effect, t, rows), columns_(effect, grids, evaluate_) {
    if (needs_raw_reading(effect)) planned_.emplace(effect, grids, t, rows);
  }
  Variants(const Variants&) = delete;
  Variants& operator=(const Variants&) = delete;

  void fill(Variant& variant) const {
    Variant as_planned = variant;
    columns_.fill(variant);
    if (!planned_) return;
    planned_->columns.fill(as_planned);
    if (as_planned.signature.cols() > 0 && planned_->direction.is_alike(as_planned.signature))
      variant = std::move(as_planned);
  }

 private:
  static RecordedTouches without_deviations(RecordedTouches t) {
    for (RecordedTouch& touch : t.touches) touch.beyond_target_mm = {};
    return t;
  }

  struct Planned {
    Planned(const Effect& effect, const std::vector<ParameterGrid>& grids, const RecordedTouches& t,
            const std::vector<int>& rows)
        : evaluate(effect, without_deviations(t), rows), columns(effect, grids, evaluate), direction(t, rows) {}
    Evaluation evaluate;
    VariantColumns columns;
    SameDirection direction;
  };

  Evaluation evaluate_;
  VariantColumns columns_;
  std::optional<Planned> planned_;
};

/// A variant stands for what another one with the same columns stands for too, where nothing lies between: no touch
/// tells the values apart.
void cover(Variant& variant, const Variant& same) {
  if (variant.change != same.change) return;
  for (std::size_t p = 0; p < variant.cells.size(); ++p)
    if (!adjoin(variant.cells[p], same.cells[p])) return;
  for (std::size_t p = 0; p < variant.cells.size(); ++p) {
    variant.cells[p].low = std::min(variant.cells[p].low, same.cells[p].low);
    variant.cells[p].high = std::max(variant.cells[p].high, same.cells[p].high);
  }
}

/// In what an effect shows first: what it needs, the rarest covariate first.
Factor factor_of(const Effect& effect) {
  const std::pair<unsigned, Factor> order[] = {
      {Covariate::part_temperature | Covariate::scale_temperature | Covariate::air_temperature, Factor::temperature},
      {0u | Covariate::speed, Factor::speed},
      {Covariate::direction | Covariate::acceleration, Factor::direction},
      {0u | Covariate::time, Factor::time},
      {Covariate::head | Covariate::visit, Factor::head},
      {0u | Covariate::sensor, Factor::sensor},
      {0u | Covariate::part_frame, Factor::feature},
      {Covariate::position | Covariate::raw_reading, Factor::position}};
  for (const auto& [covariates, factor] : order)
    if (effect.needs & covariates) return factor;
  return Factor::direction;
}

/// The names share their belief, and so do the patterns.
void share_priors(Explanations& all) {
  double named = 0, patterns = 0;
  for (const Explanation& e : all.list) (e.effect ? named : patterns) += e.share;
  for (Explanation& e : all.list) e.prior = e.share * (e.effect ? kPriorCatalogue / named : kPriorOther / patterns);
}

std::vector<ParameterGrid> grids_of(const Effect& effect, const RecordedTouches& t, double least_period_um = 0) {
  std::vector<ParameterGrid> list;
  for (const EffectParameter& p : effect.parameters) list.push_back(grid_of(p, t, least_period_um));
  return list;
}

void add_effect(const Effect& effect, const RecordedTouches& t, const std::vector<int>& rows, Explanations& out,
                double least_period_um = 0) {
  if (spread_hidden(effect, t)) {
    constexpr auto kVisit = static_cast<unsigned>(Covariate::visit);
    const unsigned known = kVisit & t.known;
    out.unjudged.push_back(visits_in(t) > 1 ? Explanations::Unjudged{&effect, kVisit, 0, known}
                                            : Explanations::Unjudged{&effect, kVisit, known});
    return;
  }
  Explanation explanation;
  explanation.name = std::string(effect.name);
  explanation.effect = &effect;
  explanation.factor = factor_of(effect);
  explanation.missing = missing_of(effect, t);
  const std::vector<ParameterGrid> grids = grids_of(effect, t, least_period_um);
  const Variants variants(effect, grids, t, rows);
  const std::vector<Variant> in_all =
      with_beginnings(by_directions(by_groups(settings(effect, grids), effect), grids), effect, t, rows);
  ColumnsSeen seen;
  for (Variant& variant : with_changes(in_all, effect, later_runs(t, rows))) {
    variant.explanation = static_cast<int>(out.list.size());
    variants.fill(variant);
    if (variant.signature.cols() == 0) continue;
    // Two with the same columns differ in what has no influence here.
    if (const int before = seen.find(variant.signature, out.variants); before >= 0) {
      cover(out.variants[before], variant);
      continue;
    }
    const auto number = static_cast<int>(out.variants.size());
    seen.add(variant.signature, number);
    explanation.variants.push_back(number);
    out.variants.push_back(std::move(variant));
  }
  share_belief(explanation, out.variants);
  if (explanation.missing || explanation.variants.empty())
    out.unjudged.push_back({&effect, explanation.missing, explanation.missing & t.known});
  if (!explanation.variants.empty()) out.list.push_back(std::move(explanation));
}

void add_catalogue(const RecordedTouches& t, const std::vector<int>& rows, bool of_readings, Explanations& out,
                   double least_period_um = 0) {
  for (const Effect* effect : effects())
    // The noise is judged by the variance (findings/noise).
    if (!is_noise(*effect) && needs_raw_reading(*effect) == of_readings)
      add_effect(*effect, t, rows, out, least_period_um);
}

}  // namespace

Variant variant_like(const Variant& other, const Effect& effect, const RecordedTouches& t,
                     const std::vector<int>& rows) {
  Variant variant;
  variant.theta = other.theta;
  variant.group = other.group;
  variant.axis = other.axis;
  variant.change = other.change;
  Variants(effect, grids_of(effect, t), t, rows).fill(variant);
  return variant;
}

bool matters(const Variant& variant, const Effect& effect, std::size_t parameter, const std::vector<TriedValue>& tried,
             const RecordedTouches& t, const std::vector<int>& rows) {
  constexpr double kNothing_um = 1e-6;
  Variant at = variant;
  return tried.size() < 2 || std::any_of(tried.begin(), tried.end(), [&](const TriedValue& other) {
           at.theta[parameter] = other.value;
           const Matrix signature = variant_like(at, effect, t, rows).signature;
           return signature.cols() != variant.signature.cols() ||
               (signature - variant.signature).cwiseAbs().maxCoeff() > kNothing_um;
         });
}

Explanations named_explanations(const RecordedTouches& t, const std::vector<int>& rows,
                                const std::vector<std::string>& names) {
  Explanations out;
  for (const std::string& name : names) add_effect(*find_effect(name), t, rows, out);
  for (Explanation& e : out.list) e.prior = 1.0 / double(out.list.size());
  return out;
}

Explanations explanations_without_readings(const RecordedTouches& t, const std::vector<int>& rows) {
  Explanations out;
  add_catalogue(t, rows, false, out);
  add_other(t, rows, out);
  share_priors(out);
  return out;
}

void add_explanations_of_readings(const RecordedTouches& t, const std::vector<int>& rows, double step_um,
                                  Explanations& out) {
  add_catalogue(t, rows, true, out, kLeastStepsInPeriod * step_um);
  share_priors(out);
}

std::vector<CannotJudge> cannot_judge(const Explanations& all) {
  std::vector<CannotJudge> out;
  for (const Effect* effect : effects()) {
    for (const Explanations::Unjudged& u : all.unjudged) {
      if (u.effect == effect)
        out.push_back({std::string(effect->name), columns_of(u.missing), columns_of(u.constant), columns_of(u.too_few),
                       u.too_few ? "fewer than three indexings" : ""});
    }
  }
  return out;
}

void add_hidden(const Explanations& all, Diagnosis& out) {
  for (const Explanation& e : all.list)
    if (e.effect && !tells_of(out, e.name)) out.cannot_judge.push_back({e.name});
}

}  // namespace abbe::diagnose
