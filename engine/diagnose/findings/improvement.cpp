// Whether the named model predicts data that it has not seen better than the baseline does: grouped leave-one-out.
//
// log p(y_g | rest, model) - log p(y_g | rest, baseline) = log B(all) - log B(all but g), B the Bayes factor of the explanation with all its
// variants and sizes: so nothing of a held-out group enters the choice of a variant or of a size, and terms of improper priors cancel.
// The scheme is the hardest that the recording allows: setups, runs, orientations, else parts of the sequence in time.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "engine/diagnose/case.hpp"

namespace abbe::diagnose {

namespace {

struct Scheme {
  std::string name;
  std::vector<int> group;            ///< by row of the model
};

Scheme scheme_of(const Case& c) {
  const auto by = [&](const char* name, auto key) {
    Scheme s{name, {}};
    for (const int i : c.rows) s.group.push_back(key(c.touches.touches[i].scene));
    return s;
  };
  std::map<std::pair<double, double>, int> orientation;
  const Scheme candidates[] = {
      by("leave-one-setup-out", [](const TouchScene& s) { return s.setup; }), by("leave-one-run-out", [](const TouchScene& s) { return s.run; }),
      by("leave-one-orientation-out", [&](const TouchScene& s) {
        return orientation.emplace(std::pair{s.stylus.head_a_rad, s.stylus.head_b_rad}, int(orientation.size())).first->second;
      })};
  for (const Scheme& s : candidates)
    if (std::set<int>(s.group.begin(), s.group.end()).size() >= 3) return s;
  // Every sixth stretch of the sequence, not one stretch: what happened once can be learnt from no other stretch.
  constexpr int kFolds = 5;
  Scheme s{"leave-one-fifth-out", {}};
  for (std::size_t k = 0; k < c.rows.size(); ++k) s.group.push_back(static_cast<int>(k / 3) % kFolds);
  return s;
}

std::vector<Eigen::Index> outside(const Scheme& s, int group) {
  std::vector<Eigen::Index> rows;
  for (std::size_t k = 0; k < s.group.size(); ++k)
    if (s.group[k] != group) rows.push_back(static_cast<Eigen::Index>(k));
  return rows;
}

/// What one explanation gains on every group, and what it predicts there.
struct HeldOut {
  std::vector<double> gain;
  Vector predicted_um;
};

/// The likeliest prediction of an explanation from a search: its best block at its best size, as a pattern over all rows.
Vector prediction(const EvidenceSearch& search, const Evidence& evidence, const Explanations& on_all_rows) {
  const auto best = std::max_element(evidence.block_log_bayes.begin(), evidence.block_log_bayes.end()) - evidence.block_log_bayes.begin();
  const auto info = search.information(static_cast<int>(best));
  const Matrix precision = info.g + Matrix::Identity(info.g.rows(), info.g.cols()) / 9;
  return on_all_rows.blocks[static_cast<std::size_t>(best)].signature * Eigen::LLT<Matrix>(precision).solve(info.u);
}

HeldOut held_out(const Case& c, const Scheme& scheme, int explanation, const LinearModel& model) {
  const Explanations all = only(c.explanations, {explanation});
  const double complete = EvidenceSearch(model, c.hyper, all).evidence().log_bayes[0];
  HeldOut out{{}, Vector::Zero(model.y.size())};
  for (const int g : std::set<int>(scheme.group.begin(), scheme.group.end())) {
    std::vector<char> dropped;
    for (const int k : scheme.group) dropped.push_back(k == g);
    const EvidenceSearch search(without_rows(model, dropped), c.hyper, rows_of(all, outside(scheme, g)));
    out.gain.push_back(complete - search.evidence().log_bayes[0]);
    const Vector predicted = prediction(search, search.evidence(), all);
    for (std::size_t k = 0; k < scheme.group.size(); ++k)
      if (scheme.group[k] == g) out.predicted_um(static_cast<Eigen::Index>(k)) = predicted(static_cast<Eigen::Index>(k));
  }
  return out;
}

/// Residuals free of the placement of the part, um.
Vector placed(const LinearModel& m, const Hyperparameters& h, const Vector& y) {
  const Rotated rotated(m, h);
  Vector r = rotated.project(y);
  for (Eigen::Index i = 0; i < r.size(); ++i) r(i) *= m.noise_um(i) * h.noise(m.noise_group[i]);
  return r;
}

double rms(const Vector& v) { return std::sqrt(v.squaredNorm() / double(v.size())); }

/// Mean residual along the prediction, in the fifth of the touches where it is largest.
double bias(const Vector& residual, const Vector& predicted) {
  std::vector<double> size;
  for (const double p : predicted) size.push_back(std::abs(p));
  std::sort(size.begin(), size.end());
  const double limit = size[size.size() * 4 / 5];
  double sum = 0, n = 0;
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    if (std::abs(predicted(i)) < limit || predicted(i) == 0) continue;
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

/// Standard error of the sum over groups of different gains.
double standard_error(const std::vector<double>& gain) {
  const double n = double(gain.size()), mean = sum(gain) / n;
  double square = 0;
  for (const double g : gain) square += (g - mean) * (g - mean);
  return n > 1 ? std::sqrt(n * square / (n - 1)) : 0;
}

void tell_residuals(const Case& c, const Vector& before, const Vector& after, Diagnosis& out) {
  for (std::size_t k = 0; k < c.rows.size(); ++k) {
    const RecordedTouch& t = c.touches.touches[c.rows[k]];
    const RecordingRow& row = c.recording->rows[t.row];
    const auto at = static_cast<Eigen::Index>(k);
    out.residuals.push_back({row.feature, row.touch, row.setup, row.run, t.scene.time_s, t.scene.point.x, t.scene.point.y, t.scene.point.z, before(at), after(at)});
  }
}

}  // namespace

void show_improvement(const Case& c, const SearchResult& result, Diagnosis& out) {
  std::vector<int> named;
  std::vector<int> blocks;
  for (const Finding& f : result.findings) named.push_back(f.explanation), blocks.push_back(f.block);
  if (result.other) named.push_back(result.other->explanation), blocks.push_back(result.other->block);
  if (named.empty()) {
    const Vector as_recorded = placed(c.model, c.hyper, c.model.y);
    return tell_residuals(c, as_recorded, as_recorded, out);
  }
  const Scheme scheme = scheme_of(c);
  std::vector<double> gain;
  Vector predicted = Vector::Zero(c.model.y.size());
  for (std::size_t k = 0; k < named.size(); ++k) {
    std::vector<const Matrix*> before;
    for (std::size_t j = 0; j < k; ++j) before.push_back(&c.explanations.blocks[blocks[j]].signature);
    const HeldOut h = held_out(c, scheme, named[k], with_free(c.model, before));
    gain.resize(h.gain.size(), 0);
    for (std::size_t g = 0; g < gain.size(); ++g) gain[g] += h.gain[g];
    predicted += h.predicted_um;
  }
  const Vector before = placed(c.model, c.hyper, c.model.y), after = placed(c.model, c.hyper, c.model.y - predicted);
  const Vector shape = placed(c.model, c.hyper, predicted);
  Improvement i;
  i.scheme = scheme.name;
  i.log_score_gain = sum(gain);
  i.se = standard_error(gain);
  i.rms_before_um = rms(before);
  i.rms_after_um = rms(after);
  i.bias_before_um = bias(before, shape);
  i.bias_after_um = bias(after, shape);
  const Vector loo = leave_one_out(c.model, result.hyper);
  LinearModel improved = c.model;
  improved.y -= predicted;
  i.chi2_per_dof_before = loo.squaredNorm() / double(loo.size());
  i.chi2_per_dof_after = leave_one_out(improved, result.hyper).squaredNorm() / double(loo.size());
  out.improvement = i;
  tell_residuals(c, before, after, out);
  // The runner-up: the best explanation outside the named sets.
  int second = -1;
  for (std::size_t k = 0; k < c.explanations.list.size(); ++k) {
    const bool in_set = std::any_of(result.findings.begin(), result.findings.end(),
                                    [&](const Finding& f) { return std::find(f.set.begin(), f.set.end(), int(k)) != f.set.end(); });
    if (in_set || !c.explanations.list[k].effect || int(k) == named.front()) continue;
    if (second < 0 || result.first.log_bayes[k] > result.first.log_bayes[static_cast<std::size_t>(second)]) second = static_cast<int>(k);
  }
  if (second >= 0) out.runner_up = RunnerUp{{c.explanations.list[static_cast<std::size_t>(second)].name}, sum(held_out(c, scheme, second, c.model).gain)};
}

}  // namespace abbe::diagnose
