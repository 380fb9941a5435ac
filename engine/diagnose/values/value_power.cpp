#include "engine/diagnose/values/value_power.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/base/on_threads.hpp"
#include "engine/diagnose/levels.hpp"
#include "engine/diagnose/quantile.hpp"
#include "engine/diagnose/values/value_estimate.hpp"

namespace abbe::diagnose {

namespace {

/// One form of an effect: of a variant, the column of which the values tell most.
struct ValueForm {
  int variant = 0;
  Eigen::Index column = 0;
  double information = 0;
};

/// Of the forms that show at all, by what the values tell of them, the one in the middle; of an even number the better one.
std::optional<ValueForm> middle_form(const ValueSearch& s, const Explanation& e) {
  constexpr double kNone = 1e-12;
  std::vector<ValueForm> forms;
  for (const int b : e.variants) {
    Eigen::Index at = 0;
    const double information = s.between(b, b).diagonal().maxCoeff(&at);
    if (information > kNone) forms.push_back({b, at, information});
  }
  if (forms.empty()) return std::nullopt;
  const auto middle = forms.begin() + static_cast<std::ptrdiff_t>(forms.size() / 2);
  std::nth_element(forms.begin(), middle, forms.end(),
                   [](const ValueForm& a, const ValueForm& b) { return a.information < b.information; });
  return *middle;
}

/// What is left of the information on one column once a rival takes what it can, as a share.
double left(const ValueSearch& s, int variant, Eigen::Index column, int rival) {
  const Vector cross = s.between(rival, variant).col(column);
  const double own = s.between(variant, variant)(column, column);
  return 1 - explained(s.between(rival, rival), cross)(0) / own;
}

class Detection {
 public:
  Detection(const ValueCase& c, double alarm)
      : case_(c), options_(*c.options), alarm_(alarm), machines_(first_of(c.ensemble.machines, kMachines)) {
    options_.threads = 1;  // effects are on threads
  }

  /// In units of the column. Sought around the size that would show if it and a machine's errors added up; nothing where
  /// no possible one is so large.
  std::optional<double> from(const Effect& effect, const ValueForm& of) const {
    constexpr double kLeast = 0.5, kFar = 16;
    constexpr int kHalvings = 6;
    const Variant& variant = case_.search->explanations().variants[of.variant];
    const Column& column = variant.columns[of.column];
    const double about = kDetects / std::sqrt(of.information),
                 largest = effect.parameters[column.parameter].high / column.unit;
    double low = kLeast * about, high = std::min(kFar * about, largest);
    const auto detected = [&](double size) {
      return share_of_alarms(effect, variant, size * Vector::Unit(variant.signature.cols(), of.column)) >= kPowerShare;
    };
    if (low >= high || !detected(high)) return std::nullopt;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = std::sqrt(low * high);
      (detected(middle) ? high : low) = middle;
    }
    return high;
  }

 private:
  static constexpr int kMachines = 25;

  double share_of_alarms(const Effect& effect, const Variant& variant, const Vector& sizes) const {
    const Machine with = with_effect(*case_.machine, effect, variant, sizes);
    const Matrix reached =
        complete(simulated_values(case_.ensemble.values, *case_.programs, with, machines_, options_));
    const std::vector<double> statistics =
        statistics_of(*case_.search, as_recorded(reached, case_.recorded, options_.seed));
    const auto alarms =
        std::count_if(statistics.begin(), statistics.end(), [&](double statistic) { return statistic > alarm_; });
    return double(alarms) / std::max(1.0, double(statistics.size()));
  }

  const ValueCase& case_;
  DiagnoseOptions options_;
  double alarm_;
  VirtualMachines machines_;
};

/// With what it is confounded, and from which size on it is named.
void tell_apart(const ValueSearch& s, int explanation, const ValueForm& of, double size, double largest,
                Detectable& d) {
  const Explanations& all = s.explanations();
  double least = 1;
  for (int j = 0; j < static_cast<int>(all.list.size()); ++j) {
    const Explanation& other = all.list[j];
    if (j == explanation || !other.effect) continue;
    double share = 1;
    for (const int b : other.variants) share = std::min(share, left(s, of.variant, of.column, b));
    least = std::min(least, share);
    if (share < 1 - kConfounded * kConfounded && d.confounded_with.size() < 4) d.confounded_with.push_back(other.name);
  }
  if (least <= kInseparable) return;
  const double named = std::max(size, kNames / std::sqrt(of.information * least));
  d.name = d.detect / size * named, d.name_um = largest * named;
}

}  // namespace

std::vector<Detectable> smallest_detectable(const ValueCase& c, std::vector<double> in_order) {
  const ValueSearch& s = *c.search;
  const Detection detection(c, quantile(std::move(in_order), 1 - kAlarm));
  const Explanations& all = s.explanations();
  const int count = static_cast<int>(all.list.size());
  std::vector<std::optional<ValueForm>> form(all.list.size());
  std::vector<std::optional<double>> from(all.list.size());
  on_threads(count, c.options->threads, [&](int k) {
    const Explanation& e = all.list[k];
    const auto at = static_cast<std::size_t>(k);
    if (e.effect && !e.missing) form[at] = middle_form(s, e);
    if (form[at]) from[at] = detection.from(*e.effect, *form[at]);
  });
  std::vector<Detectable> out;
  for (int k = 0; k < count; ++k) {
    const std::optional<double>& size = from[k];
    if (!size) continue;
    const Explanation& e = all.list[k];
    const ValueForm& of = *form[k];
    const Variant& variant = all.variants[of.variant];
    const Column& column = variant.columns[of.column];
    const EffectParameter& p = e.effect->parameters[column.parameter];
    const double largest = variant.signature(of_figures(c.ensemble.values), of.column).cwiseAbs().maxCoeff();
    Detectable d{.effect = e.name, .parameter = std::string(p.name), .unit = std::string(p.unit)};
    d.detect = column.unit * *size, d.detect_um = largest * *size;
    tell_apart(s, k, of, *size, largest, d);
    out.push_back(std::move(d));
  }
  return out;
}

}  // namespace abbe::diagnose
