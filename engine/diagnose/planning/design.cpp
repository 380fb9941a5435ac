// What a recording can tell, from its plan alone: the smallest size of each effect that would be detected,
// and the smallest that would be named (minimal detectable and minimal identifiable bias: Baarda 1968;
// Zaminpardaz & Teunissen 2024).
//
// An effect has forms: its variants (which axis, which moment) and in each its columns. Each in turn counts
// as what is there, at a signal-to-noise s, and goes through the evidence of all explanations as a recording
// does: with the complexity that a rival pays for, so that a simple effect is named although a richer one
// could imitate it. What is told is the median form: half of them are named from that size on, with a power of 80 %,
// or, where the median form is not named at any size, are seen. From what size on it is seen, simulated recordings
// say (model/power.hpp).
#include "engine/diagnose/planning/design.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/base/on_threads.hpp"
#include "engine/diagnose/explanations/parameter_grid.hpp"
#include "engine/diagnose/explanations/value_called.hpp"
#include "engine/diagnose/levels.hpp"
#include "engine/diagnose/model/log_sums.hpp"
#include "engine/diagnose/model/power.hpp"

namespace abbe::diagnose {

namespace {

/// An effect that would have to move a touch by more than this to be seen does, for these touches, nothing.
constexpr double kNothing_um = 1e4;
constexpr double kNever = std::numeric_limits<double>::infinity();
/// Signal-to-noise: what is larger is not told by evidence but seen by eye.
constexpr double kSeenByEye = 100;

/// One form of an effect: a column of a variant.
struct Form {
  int variant = 0;
  Eigen::Index column = 0, place = 0;  ///< in the variant, and among the forms
  double per_snr = 0, um_per_snr = 0;  ///< size and largest displacement of a touch at a signal-to-noise of 1
  double named = kNever;               ///< signal-to-noise from which on it is named
};

/// What a variant makes of a shift: all that its evidence needs.
struct VariantView {
  Matrix axes;
  Vector information;  ///< along them
  std::vector<Size> sizes;
  Eigen::Index first = 0;          ///< of its columns among those of all variants
  std::vector<double> log_belief;  ///< by size: before the shift, with the determinant
};

class Design {
 public:
  Design(const Case& c, const EvidenceSearch& search, const Power& power)
      : all_(c.explanations), touches_(c.touches), search_(search), power_(power) {
    for (int b = 0; b < static_cast<int>(all_.variants.size()); ++b) {
      const Matrix g = search.between(b, b);
      const Spectrum of_g = spectrum(g);
      VariantView view{
          of_g.vectors, of_g.values.cwiseMax(1e-9 * (g.trace() + 1e-300)), search.sizes(b), search.first_column(b), {}};
      const double log_weight = std::log(std::max(all_.variants[b].weight, 1e-300));
      for (const Size& size : view.sizes)
        view.log_belief.push_back(log_weight + size.log_prior -
                                  0.5 * (1 + size.factor * size.factor * view.information.array()).log().sum());
      variants_.push_back(std::move(view));
      diagonal_.push_back(g.diagonal());
    }
  }

  std::optional<Detectable> of(std::size_t k) const {
    const Explanation& e = all_.list[k];
    std::vector<Form> forms = forms_of(e, false);
    const bool only_new = forms.empty();
    if (only_new) forms = forms_of(e, true);
    if (forms.empty()) return std::nullopt;
    const EffectParameter& parameter = e.effect->parameters[parameter_of(e)];
    std::vector<double> belief(all_.list.size(), 0.0);
    std::vector<Eigen::Index> columns;
    for (const Form& f : forms) columns.push_back(variants_[f.variant].first + f.column);
    const Matrix seen = search_.against_all(columns);
    const auto shift_of_form = [&](const Form& f) {
      return shift_of(seen.col(f.place) / std::sqrt(diagonal_[f.variant](f.column)));
    };
    for (std::size_t i = 0; i < forms.size(); ++i) {
      Form& f = forms[i];
      f.place = static_cast<Eigen::Index>(i);
      const Shift shift = shift_of_form(f);
      f.named = named_from(k, shift);
      const std::vector<double> at = beliefs(k, shift, 2 * kDetects);
      for (std::size_t j = 0; j < at.size(); ++j) belief[j] += at[j] / double(forms.size());
    }
    Detectable d{.effect = e.name,
                 .parameter = std::string(parameter.name),
                 .unit = std::string(parameter.unit),
                 .only_new = only_new};
    Form told = median_form(forms, [](const Form& f) { return f.per_snr * f.named; });
    const bool is_named = std::isfinite(told.named);
    if (!is_named) told = median_form(forms, [](const Form& f) { return f.per_snr; });
    const double seen_from = detected_from(told, k, shift_of_form(told));
    if (std::isinf(seen_from)) return std::nullopt;
    // No effect is larger than the catalogue takes it for possible: what shows from there on does not show.
    const auto possible = [&](double snr) { return snr * told.per_snr <= parameter.high; };
    if (!possible(seen_from)) return std::nullopt;
    d.detect = seen_from * told.per_snr, d.detect_um = seen_from * told.um_per_snr;
    if (const double from = std::max(told.named, seen_from); is_named && possible(from))
      d.name = from * told.per_snr, d.name_um = from * told.um_per_snr;
    d.confounded_with = likeliest(belief, k);
    d.form = form_of(*e.effect, all_.variants[told.variant]);
    return d;
  }

 private:
  /// What all variants see of a form, at a signal-to-noise of 1.
  struct Shift {
    std::vector<std::vector<double>> gain;  ///< by variant and size: nats
    std::vector<double> left;               ///< by explanation: the share of the information that it cannot imitate
  };

  /// The signal-to-noise from which on a form is seen.
  double detected_from(const Form& f, std::size_t explanation, const Shift& shift) const {
    const Variant& variant = all_.variants[f.variant];
    const Vector& information = diagonal_[f.variant];
    if (variant.joined)  // no other explanation makes all that may be drawn
      return power_.detected_from(variant.signature / std::sqrt(information.sum()), static_cast<int>(explanation), 1,
                                  kSeenByEye);
    std::vector<double> belief;
    for (std::size_t j = 0; j < all_.list.size(); ++j) belief.push_back(log_belief(j, shift, kDetects));
    return power_.detected_from(variant.signature.col(f.column) / std::sqrt(information(f.column)),
                                static_cast<int>(explanation), std::exp(belief[explanation] - log_sum_exp(belief)),
                                kSeenByEye);
  }

  /// The values that a variant has of lists and grids.
  std::vector<DiagnosedParameter> form_of(const Effect& effect, const Variant& variant) const {
    std::vector<DiagnosedParameter> out;
    for (std::size_t p = 0; p < effect.parameters.size(); ++p) {
      const EffectParameter& parameter = effect.parameters[p];
      const ParameterGrid grid = grid_of(parameter, touches_);
      if (parameter.linear || grid.kind != ParameterGrid::Kind::tried || grid.tried.size() < 2 ||
          !counts(effect, parameter, variant.theta))
        continue;
      const double value = variant.theta[p];
      out.push_back({.name = std::string(parameter.name),
                     .unit = std::string(parameter.unit),
                     .value = value,
                     .low = value,
                     .high = value,
                     .word = word_of(parameter, value, touches_)});
    }
    return out;
  }

  /// The size that is told: of the column that shows most.
  int parameter_of(const Explanation& e) const {
    const auto most = [&](int b) { return diagonal_[b].maxCoeff(); };
    const int strongest =
        *std::max_element(e.variants.begin(), e.variants.end(), [&](int a, int b) { return most(a) < most(b); });
    const Variant& variant = all_.variants[strongest];
    Eigen::Index column = 0;
    diagonal_[strongest].maxCoeff(&column);
    if (!variant.joined) return std::max(0, variant.columns[column].parameter);
    const auto& p = e.effect->parameters;
    const auto linear = std::find_if(p.begin(), p.end(), [](const EffectParameter& x) { return x.linear; });
    return linear == p.end() ? 0 : static_cast<int>(linear - p.begin());
  }

  /// Some of its variants, those in all runs or those that change between runs, from the one that shows most to the one
  /// that shows least, with the columns of the size that is told. Any direction has those of the axes, which count once.
  std::vector<Form> forms_of(const Explanation& e, bool changing) const {
    constexpr std::size_t kVariants = 7;
    std::vector<int> variants;
    for (const int b : e.variants)
      if (diagonal_[b].maxCoeff() > 1e-12 && all_.variants[b].axis < 0 && all_.variants[b].change.any() == changing)
        variants.push_back(b);
    std::stable_sort(variants.begin(), variants.end(),
                     [&](int a, int b) { return diagonal_[a].maxCoeff() > diagonal_[b].maxCoeff(); });
    const std::size_t n = variants.size(), m = std::min(n, kVariants);
    std::vector<Form> out;
    if (variants.empty()) return out;
    const int told = parameter_of(e);
    for (std::size_t i = 0; i < m; ++i) {
      const int b = variants[m == 1 ? 0 : i * (n - 1) / (m - 1)];
      const Variant& variant = all_.variants[b];
      for (Eigen::Index j = 0; j < variant.signature.cols(); ++j) {
        const double information = diagonal_[b](j);
        const int p = variant.joined ? told : variant.columns[j].parameter;
        if (information <= 1e-12 || (p >= 0 && p != told)) continue;
        const double unit = variant.joined ? e.effect->parameters[told].typical : variant.columns[j].unit;
        Form f{b, j, 0, unit / std::sqrt(information),
               variant.signature.col(j).cwiseAbs().maxCoeff() / std::sqrt(information)};
        if (variant.joined) {  // draws come together: all columns at the spread that is told
          const double all = std::sqrt(diagonal_[b].sum());
          f.per_snr = unit / all, f.um_per_snr = variant.signature.rowwise().norm().maxCoeff() / all;
        }
        if (kDetects * f.um_per_snr <= kNothing_um) out.push_back(f);
      }
    }
    return out;
  }

  /// `u`: H' P h of a form h at a signal-to-noise of 1.
  Shift shift_of(const Vector& u) const {
    Shift out;
    std::vector<double> imitated;
    for (const VariantView& b : variants_) {
      const Eigen::ArrayXd squares = (b.axes.transpose() * u.segment(b.first, b.axes.rows())).array().square();
      imitated.push_back((squares / b.information.array()).sum());
      std::vector<double>& gain = out.gain.emplace_back();
      for (const Size& size : b.sizes) {
        const double s2 = size.factor * size.factor;
        gain.push_back(0.5 * s2 * (squares / (1 + s2 * b.information.array())).sum());
      }
    }
    for (const Explanation& e : all_.list) {
      double left = 1;
      for (const int b : e.variants) left = std::min(left, 1 - imitated[b]);
      out.left.push_back(std::max(0.0, left));
    }
    return out;
  }

  /// The logarithm of prior and Bayes factor of an explanation, for the shift alone.
  double log_belief(std::size_t k, const Shift& shift, double snr) const {
    std::vector<double> terms;
    for (const int index : all_.list[k].variants) {
      const auto b = static_cast<std::size_t>(index);
      for (std::size_t i = 0; i < variants_[b].sizes.size(); ++i)
        terms.push_back(variants_[b].log_belief[i] + snr * snr * shift.gain[b][i]);
    }
    return std::log(all_.list[k].prior) + log_sum_exp(terms);
  }

  /// Whether the set of names would be this one alone, and it be preferred to patterns without a name, with a
  /// power of 80 %.
  bool named(std::size_t truth, const Shift& shift, double snr) const {
    const double own = log_belief(truth, shift, snr), over_patterns = std::log(kAsWell);
    double against = 0;
    for (std::size_t j = 0; j < all_.list.size(); ++j) {
      if (j == truth) continue;
      const double odds = own - log_belief(j, shift, snr) - kPowerDeviations * snr * std::sqrt(shift.left[j]);
      if (all_.list[j].effect)
        against += std::exp(-odds);
      else if (odds < over_patterns)
        return false;
    }
    return 1 / (1 + against) >= kCredible;
  }

  double named_from(std::size_t truth, const Shift& shift) const {
    constexpr int kHalvings = 7;
    if (!named(truth, shift, kSeenByEye)) return kNever;
    double low = kDetects, high = kSeenByEye;
    if (named(truth, shift, low)) return low;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = std::sqrt(low * high);
      (named(truth, shift, middle) ? high : low) = middle;
    }
    return high;
  }

  /// Of the effects, given the shift.
  std::vector<double> beliefs(std::size_t truth, const Shift& shift, double snr) const {
    const double own = log_belief(truth, shift, snr);
    std::vector<double> out(all_.list.size(), 0.0);
    double sum = 0;
    for (std::size_t j = 0; j < out.size(); ++j)
      if (all_.list[j].effect) sum += out[j] = std::exp(std::min(50.0, log_belief(j, shift, snr) - own));
    for (double& b : out) b /= sum;
    return out;
  }

  std::vector<std::string> likeliest(const std::vector<double>& belief, std::size_t besides) const {
    constexpr double kWorthNaming = 0.03;
    constexpr std::size_t kToName = 4;
    std::vector<std::size_t> order;
    for (std::size_t j = 0; j < belief.size(); ++j)
      if (j != besides && belief[j] > kWorthNaming) order.push_back(j);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return belief[a] > belief[b]; });
    std::vector<std::string> out;
    for (std::size_t i = 0; i < std::min(kToName, order.size()); ++i) out.push_back(all_.list[order[i]].name);
    return out;
  }

  /// Of an even number the better one.
  template <class By>
  static Form median_form(std::vector<Form> forms, By by) {
    std::stable_sort(forms.begin(), forms.end(), [&](const Form& a, const Form& b) { return by(a) < by(b); });
    return forms[(forms.size() - 1) / 2];
  }

  const Explanations& all_;
  const RecordedTouches& touches_;
  const EvidenceSearch& search_;
  const Power& power_;
  std::vector<VariantView> variants_;
  std::vector<Vector> diagonal_;  ///< by variant: the information on each column
};

}  // namespace

std::vector<Detectable> smallest_detectable(const Case& c, const EvidenceSearch& search) {
  constexpr int kRecordings = 160;
  constexpr double kLeastLarger = 1.1, kMostLarger = 2;
  // A plan has no values that would say how rough the machine may be: those of a machine in order. How large its errors
  // and its noise are is stated, and not what these few values happen to be.
  const auto reckons_with = [&](double larger) {
    LinearModel model = c.model;
    model.y = search.in_order(larger, c.options.seed, 0);
    Hyperparameters hyper = c.hyper;
    hyper.scale *= larger;
    return EvidenceSearch(model, hyper, c.explanations);
  };
  std::optional<EvidenceSearch> of_plan;
  if (c.model.y.squaredNorm() == 0) of_plan.emplace(reckons_with(1));
  const double larger = std::clamp(c.model.largest_scale / c.hyper.scale, kLeastLarger, kMostLarger);
  const EvidenceSearch of_larger = reckons_with(larger);
  const Power power(of_plan ? *of_plan : search, {of_larger, larger}, search, kRecordings, c.options.seed,
                    c.options.threads);
  const Design design(c, search, power);
  std::vector<std::optional<Detectable>> of(c.explanations.list.size());
  on_threads(static_cast<int>(of.size()), c.options.threads, [&](int k) {
    const auto index = static_cast<std::size_t>(k);
    if (c.explanations.list[index].effect && !c.explanations.list[index].missing) of[index] = design.of(index);
  });
  std::vector<Detectable> out;
  for (std::optional<Detectable>& d : of)
    if (d) out.push_back(std::move(*d));
  return out;
}

}  // namespace abbe::diagnose
