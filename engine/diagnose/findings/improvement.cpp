// Whether the named model predicts data that it has not seen better than the baseline does: grouped leave-one-out.
//
// log p(y_g | rest, model) - log p(y_g | rest, baseline) = log B(all) - log B(all but g), B the Bayes factor
// of the explanation with all its variants and sizes: so a held-out group enters neither the choice among the
// variants nor of a size, and terms of improper priors cancel. Which variants are in question (those that a round keeps,
// search.cpp), and the other findings, are those of the whole recording. Model and baseline have each their own noise and
// size of the machine's errors: those of the whole recording with what was found and without. The scheme is
// the hardest that the recording and what was found allow: setups, runs, orientations, else parts of the sequence in time. The
// residuals that are shown are those of the same predictions: of each group from the others, by the machine
// as they show it, without and with what was found.
#include "engine/diagnose/findings/improvement.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "engine/diagnose/model/precision.hpp"
#include "engine/diagnose/model/prediction.hpp"
#include "engine/diagnose/model/restricted_likelihood.hpp"

namespace abbe::diagnose {

namespace {

struct Scheme {
  std::string name;
  std::vector<int> group;  ///< by row of the model
};

std::map<int, double> count_by_group(const std::vector<int>& group) {
  std::map<int, double> count;
  for (const int g : group) count[g] += 1;
  return count;
}

/// Whether its groups can be predicted from one another: at least three, none of which is most of the recording.
bool comparable(const Scheme& s) {
  const std::map<int, double> count = count_by_group(s.group);
  const auto largest =
      std::max_element(count.begin(), count.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return count.size() >= 3 && 2 * largest->second <= double(s.group.size());
}

/// What was told, in its order: the names, and the pattern that no name explains.
struct Told {
  int explanation = 0, variant = 0;
};
std::vector<Told> all_told(const SearchResult& result) {
  std::vector<Told> list;
  for (const Finding& f : result.findings) list.push_back({f.explanation, f.variant});
  if (result.other) list.push_back({result.other->explanation, result.other->variant});
  return list;
}

/// Whether so much of it is in one group that the others do not tell how large it is there.
bool in_one_group(const Scheme& s, const Vector& squares) {
  constexpr double kInOne = 0.95;
  std::map<int, double> by_group;
  for (std::size_t k = 0; k < s.group.size(); ++k) by_group[s.group[k]] += squares(static_cast<Eigen::Index>(k));
  return std::any_of(by_group.begin(), by_group.end(),
                     [&](const auto& group) { return group.second > kInOne * squares.sum(); });
}

/// Whether other groups tell what was told of one. Not where it acts in that one alone, nor where it shows in that one alone
/// because the placement of the part takes it up in the others.
bool predictable(const Scheme& s, const Case& c, const std::vector<Told>& told) {
  return std::none_of(told.begin(), told.end(), [&](const Told& t) {
    const Matrix& signature = c.explanations.variants[t.variant].signature;
    Vector shows = Vector::Zero(signature.rows());
    for (const auto& column : signature.colwise()) shows += beside_free(c.model, column).cwiseAbs2();
    return in_one_group(s, signature.rowwise().squaredNorm()) || in_one_group(s, shows);
  });
}

Scheme scheme_of(const Case& c, const std::vector<Told>& told) {
  const auto by = [&](const char* name, auto key) {
    Scheme s{name, {}};
    for (const int i : c.rows) s.group.push_back(key(c.touches.touches[i].scene));
    return s;
  };
  std::map<std::pair<double, double>, int> orientation;
  const Scheme candidates[] = {
      by("leave-one-setup-out", [](const TouchScene& s) { return s.setup; }),
      by("leave-one-run-out", [](const TouchScene& s) { return s.run; }),
      by("leave-one-orientation-out", [&](const TouchScene& s) {
        return orientation.emplace(std::pair{s.stylus.head_a_rad, s.stylus.head_b_rad}, int(orientation.size()))
            .first->second;
      })};
  for (const Scheme& s : candidates)
    if (comparable(s) && predictable(s, c, told)) return s;
  // Every fifth stretch of three touches, not one stretch: what happened once can be learnt from no other stretch.
  constexpr int kFolds = 5;
  Scheme s{"leave-one-fifth-out", {}};
  for (std::size_t k = 0; k < c.rows.size(); ++k) s.group.push_back(static_cast<int>(k / 3) % kFolds);
  return s;
}

std::vector<char> of_group(const Scheme& s, int group) {
  std::vector<char> rows;
  for (const int g : s.group) rows.push_back(g == group);
  return rows;
}

std::vector<Eigen::Index> outside(const Scheme& s, int group) {
  std::vector<Eigen::Index> rows;
  for (std::size_t k = 0; k < s.group.size(); ++k)
    if (s.group[k] != group) rows.push_back(static_cast<Eigen::Index>(k));
  return rows;
}

/// What one explanation gains on every group, and what it was taken for there.
struct HeldOut {
  std::vector<double> gain;
  std::vector<double> null;     ///< log likelihood of the group without it
  std::vector<Matrix> columns;  ///< by group, over all rows, um per standard deviation
};

/// The likeliest variant of the one explanation of a search at its likeliest size, over all rows.
Matrix likeliest(const EvidenceSearch& search, const Explanations& on_all_rows) {
  const int variant = best_variant(on_all_rows, 0, search.evidence());
  return likeliest_size(search.information(variant), search.sizes(variant)).factor *
      on_all_rows.variants[variant].signature;
}

HeldOut held_out(const Case& c, const Scheme& scheme, int explanation, const LinearModel& model,
                 const Hyperparameters& h) {
  Explanations all = only(c.explanations, {explanation});
  const EvidenceSearch sizes(model, h, all);
  // one prior for all groups
  for (std::size_t b = 0; b < all.variants.size(); ++b) all.variants[b].sizes = sizes.sizes(static_cast<int>(b));
  const EvidenceSearch whole(model, h, all);
  const Evidence& complete = whole.evidence();
  HeldOut out;
  for (const int g : std::set<int>(scheme.group.begin(), scheme.group.end())) {
    const EvidenceSearch search = whole.without(of_group(scheme, g), rows_of(all, outside(scheme, g)));
    out.gain.push_back(complete.log_bayes[0] - search.evidence().log_bayes[0]);
    out.null.push_back(complete.log_null - search.evidence().log_null);
    out.columns.push_back(likeliest(search, all));
  }
  return out;
}

/// What columns, each with a coefficient of standard deviation 1, are expected to do to all rows, given those
/// outside of a group.
Vector expected(const LinearModel& m, const Hyperparameters& h, const Scheme& scheme, int group,
                const Matrix& columns) {
  const Precision precision(without_rows(m, of_group(scheme, group)), h);
  const Precision::Seen seen = precision.seen(columns(outside(scheme, group), Eigen::all));
  return columns * Cholesky(inner(seen, seen), 1).solve(inner(seen, precision.y()));
}

double rms(const Vector& v) { return std::sqrt(v.squaredNorm() / double(v.size())); }

/// How large what is predicted must be to be in the fifth of the touches where it is largest; all that are as large but
/// for rounding are.
double largest_fifth(const Vector& predicted) {
  constexpr double kAsLarge = 1 - 1e-9;
  std::vector<double> size;
  for (const double p : predicted) size.push_back(std::abs(p));
  std::sort(size.begin(), size.end());
  return kAsLarge * size[size.size() * 4 / 5];
}

/// Mean residual along what is predicted, of the touches of which it is not 0.
double bias(const Vector& residual, const Vector& predicted) {
  double sum = 0, n = 0;
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    if (predicted(i) == 0) continue;
    sum += residual(i) * (predicted(i) > 0 ? 1 : -1);
    n += 1;
  }
  return n > 0 ? sum / n : 0;
}

double sum(const std::vector<double>& v) {
  double s = 0;
  for (const double x : v) s += x;
  return s;
}

void tell_residuals(const Case& c, const Vector& before, const Vector& after, Diagnosis& out) {
  for (std::size_t k = 0; k < c.rows.size(); ++k) {
    const RecordedTouch& t = c.touches.touches[c.rows[k]];
    const RecordingRow& row = c.recording->rows[t.row];
    const auto at = static_cast<Eigen::Index>(k);
    out.residuals.push_back({row.feature, row.touch, row.setup, row.run, t.scene.time_s, t.scene.point.x,
                             t.scene.point.y, t.scene.point.z, before(at), after(at)});
  }
}

/// By group: what all that was told gains there, each beside those before it, and what it was taken for.
struct GroupGains {
  std::vector<double> gain;
  std::vector<Matrix> columns;
};
/// `baseline`: log likelihood of every group with nothing told, by the noise and errors without it.
GroupGains gains_of(const Case& c, const Scheme& scheme, const std::vector<Told>& told, const Hyperparameters& beside,
                    const std::vector<double>& baseline) {
  GroupGains out{std::vector<double>(baseline.size(), 0),
                 std::vector<Matrix>(baseline.size(), Matrix(c.model.y.size(), 0))};
  std::vector<const Matrix*> found;
  for (const Told& t : told) {
    const HeldOut h = held_out(c, scheme, t.explanation, with_free(c.model, found), beside);
    for (std::size_t g = 0; g < baseline.size(); ++g) {
      out.gain[g] += h.gain[g] + (found.empty() ? h.null[g] - baseline[g] : 0);
      out.columns[g] = side_by_side(out.columns[g], h.columns[g]);
    }
    found.push_back(&c.explanations.variants[t.variant].signature);
  }
  return out;
}

/// Every group by what the others show of what was told.
struct Corrected {
  Vector residual;  ///< beyond the prediction of machine and what was told
  /// Beside each touch's prediction from all others, all less what the others than its group show of what was told, in
  /// standard deviations. A correction is that of one group throughout: what changed after a run may be taken for its
  /// opposite before it, and half of each is neither.
  Vector standardised;
  /// What was told, where it acts most. Each group asks the others alone: chosen among the predictions of all groups, the
  /// touches would be those of the group of which the others expect too much.
  Vector most;
};
Corrected corrected(const LinearModel& machine, const Hyperparameters& hyper, const Scheme& scheme,
                    const std::vector<Matrix>& columns) {
  Corrected out;
  out.residual = out.standardised = out.most = Vector::Zero(machine.y.size());
  std::size_t at = 0;
  for (const int g : std::set<int>(scheme.group.begin(), scheme.group.end())) {
    const Vector predicted = expected(machine, hyper, scheme, g, columns[at++]);
    LinearModel improved = machine;
    improved.y -= predicted;
    out.residual += beyond_prediction(improved, hyper, of_group(scheme, g));
    const Vector beside_others = leave_one_out(improved, hyper);
    const Vector shows = beside_free(machine, predicted);
    const double limit = largest_fifth(shows);
    for (std::size_t k = 0; k < scheme.group.size(); ++k) {
      if (scheme.group[k] != g) continue;
      const auto row = static_cast<Eigen::Index>(k);
      out.standardised(row) = beside_others(row);
      if (std::abs(shows(row)) >= limit) out.most(row) = shows(row);
    }
  }
  return out;
}

/// The best effect that no set holds, with what it gains by itself.
std::optional<RunnerUp> runner_up(const Case& c, const SearchResult& result, const Scheme& scheme, int first_told,
                                  const std::vector<double>& baseline) {
  const auto in_a_set = [&](int k) {
    return std::any_of(result.findings.begin(), result.findings.end(),
                       [&](const Finding& f) { return std::find(f.set.begin(), f.set.end(), k) != f.set.end(); });
  };
  int best = -1;
  for (int k = 0; k < static_cast<int>(c.explanations.list.size()); ++k) {
    if (in_a_set(k) || !c.explanations.list[k].effect || k == first_told) continue;
    if (best < 0 || result.first.log_bayes[k] > result.first.log_bayes[best]) best = k;
  }
  if (best < 0) return {};
  const int variant = best_variant(c.explanations, best, result.first);
  const Matrix& signature = c.explanations.variants[variant].signature;
  const HeldOut h = held_out(c, scheme, best, c.model, estimate(with_free(c.model, {&signature})));
  return RunnerUp{{c.explanations.list[best].name}, sum(h.gain) + sum(h.null) - sum(baseline)};
}

}  // namespace

double standard_error_of_sum(const std::vector<double>& gain, const std::vector<int>& group) {
  const double n = double(gain.size()), per_row = sum(gain) / double(group.size());
  double square = 0;
  std::size_t k = 0;
  for (const auto& [g, size] : count_by_group(group)) square += std::pow(gain[k++] - per_row * size, 2);
  return n > 1 ? std::sqrt(n * square / (n - 1)) : 0;
}

void show_improvement(const Case& c, const SearchResult& result, Diagnosis& out) {
  const std::vector<Told> told = all_told(result);
  const Scheme scheme = scheme_of(c, told);
  const LinearModel machine = likelier_ensemble(c, c.model);
  const Hyperparameters& hyper = result.hyper_of_likelier;
  // Before and after by one machine, as it is beside what was told: one that takes the mismatch for its own
  // errors predicts worse than none.
  Vector before = Vector::Zero(machine.y.size());
  for (const int g : std::set<int>(scheme.group.begin(), scheme.group.end()))
    before += beyond_prediction(machine, hyper, of_group(scheme, g));
  if (told.empty()) return tell_residuals(c, before, before, out);
  const std::vector<double> baseline = held_out(c, scheme, told.front().explanation, c.model, c.hyper).null;
  const GroupGains gains = gains_of(c, scheme, told, result.hyper, baseline);
  const Corrected after = corrected(machine, hyper, scheme, gains.columns);
  const auto chi2_per_dof = [](const Vector& standardised) {
    return standardised.squaredNorm() / double(standardised.size());
  };
  Improvement i;
  i.scheme = scheme.name;
  i.log_score_gain = sum(gains.gain);
  i.se = standard_error_of_sum(gains.gain, scheme.group);
  i.rms_before_um = rms(before);
  i.rms_after_um = rms(after.residual);
  i.bias_before_um = bias(before, after.most);
  i.bias_after_um = bias(after.residual, after.most);
  i.chi2_per_dof_before = chi2_per_dof(leave_one_out(machine, hyper));
  i.chi2_per_dof_after = chi2_per_dof(after.standardised);
  out.improvement = i;
  tell_residuals(c, before, after.residual, out);
  out.runner_up = runner_up(c, result, scheme, told.front().explanation, baseline);
}

}  // namespace abbe::diagnose
