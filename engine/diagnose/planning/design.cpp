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
#include "engine/diagnose/explanations/catalogue.hpp"
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

/// An explanation that is believed by so many nats less than another is no rival of it.
constexpr double kNoRival = 40;

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
  /// What a square of a shift along them tells: a row by size, in nats, and the share of the information of each that it imitates.
  Matrix per_square;
  Eigen::Index first = 0;  ///< of its columns among those of all variants
};

/// Variants or sizes that follow each other.
struct Stretch {
  Eigen::Index first = 0, count = 0;
};

class Design {
 public:
  Design(const Case& c, const EvidenceSearch& search, const Power& power)
      : all_(c.explanations),
        touches_(c.touches),
        rows_(c.rows),
        search_(search),
        power_(power),
        diagonal_(all_.variants.size()) {
    std::vector<double> log_belief;
    for (const Explanation& e : all_.list) {
      const auto first_variant = static_cast<Eigen::Index>(variants_.size()),
                 first = static_cast<Eigen::Index>(log_belief.size());
      for (const int b : e.variants) add(b, std::log(e.prior), log_belief);
      variants_of_.push_back({first_variant, static_cast<Eigen::Index>(variants_.size()) - first_variant});
      sizes_of_.push_back({first, static_cast<Eigen::Index>(log_belief.size()) - first});
    }
    log_belief_ = Eigen::Map<const Vector>(log_belief.data(), static_cast<Eigen::Index>(log_belief.size()));
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
    for (const Form& f : forms) columns.push_back(search_.first_column(f.variant) + f.column);
    Matrix seen = search_.against_all(columns);
    for (std::size_t i = 0; i < forms.size(); ++i) {
      forms[i].place = static_cast<Eigen::Index>(i);
      seen.col(forms[i].place) /= std::sqrt(diagonal_[forms[i].variant](forms[i].column));
    }
    const std::vector<Shift> shifts = shifts_of(seen);
    for (Form& f : forms) {
      const Shift& shift = shifts[f.place];
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
    const double seen_from = detected_from(told, k, shifts[told.place]);
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
    Vector gain;  ///< by explanation, variant and size: nats
    Vector left;  ///< by explanation: the share of the information that it cannot imitate
  };

  /// A further variant, with its belief before the shift by size, and the determinant.
  void add(int b, double log_prior, std::vector<double>& log_belief) {
    const Matrix g = search_.between(b, b);
    diagonal_[b] = g.diagonal();
    const Spectrum of_g = spectrum(g);
    const Vector information = of_g.values.cwiseMax(1e-9 * (g.trace() + 1e-300));
    const std::vector<Size> sizes = search_.sizes(b);
    Matrix per_square(sizes.size() + 1, information.size());
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const double s2 = sizes[i].factor * sizes[i].factor;
      const Eigen::ArrayXd more = 1 + s2 * information.array();
      per_square.row(static_cast<Eigen::Index>(i)) = 0.5 * s2 / more;
      log_belief.push_back(log_prior + std::log(std::max(all_.variants[b].weight, 1e-300)) + sizes[i].log_prior -
                           0.5 * more.log().sum());
    }
    per_square.bottomRows(1) = information.cwiseInverse().transpose();
    variants_.push_back({of_g.vectors, std::move(per_square), search_.first_column(b)});
  }

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
          !matters(variant, effect, p, grid.tried, touches_, rows_))
        continue;
      const double value = variant.theta[p];
      if (value == 0 && parameter.sought == Sought::speed) continue;  // none in particular
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

  /// `seen`: a column H' P h for each form h at a signal-to-noise of 1.
  std::vector<Shift> shifts_of(const Matrix& seen) const {
    Matrix gain(log_belief_.size(), seen.cols());
    Matrix left = Matrix::Ones(static_cast<Eigen::Index>(all_.list.size()), seen.cols());
    Matrix told;
    for (std::size_t k = 0; k < all_.list.size(); ++k) {
      Eigen::Index row = sizes_of_[k].first;
      for (Eigen::Index i = 0; i < variants_of_[k].count; ++i) {
        const VariantView& b = variants_[variants_of_[k].first + i];
        told = b.per_square * (b.axes.transpose() * seen.middleRows(b.first, b.axes.rows())).cwiseAbs2();
        const Eigen::Index sizes = told.rows() - 1;
        gain.middleRows(row, sizes) = told.topRows(sizes);
        left.row(k) = left.row(k).cwiseMin((1 - told.row(sizes).array()).cwiseMax(0).matrix());
        row += sizes;
      }
    }
    std::vector<Shift> out;
    for (Eigen::Index i = 0; i < seen.cols(); ++i) out.push_back({gain.col(i), left.col(i)});
    return out;
  }

  /// By variant and size of an explanation: the logarithm of what is believed in it, for the shift alone.
  auto log_beliefs(std::size_t k, const Shift& shift, double snr) const {
    const auto [first, count] = sizes_of_[k];
    return log_belief_.segment(first, count) + snr * snr * shift.gain.segment(first, count);
  }

  /// The logarithm of prior and Bayes factor of an explanation, for the shift alone; minus infinity where it is less
  /// than `least`.
  double log_belief(std::size_t k, const Shift& shift, double snr, double least = -kNever) const {
    const Vector terms = log_beliefs(k, shift, snr);
    const bool is_less = terms.size() == 0 || terms.maxCoeff() + std::log(double(terms.size())) < least;
    return is_less ? -kNever : log_sum_exp(terms);
  }

  /// Whether the set of names would be this one alone, and it be preferred to patterns without a name, with a
  /// power of 80 %.
  bool named(std::size_t truth, const Shift& shift, double snr) const {
    const double own = log_belief(truth, shift, snr), over_patterns = std::log(kAsWell), most = 1 / kCredible - 1;
    double against = 0;
    for (std::size_t j = 0; j < all_.list.size() && against <= most; ++j) {
      if (j == truth) continue;
      const double chance = kPowerDeviations * snr * std::sqrt(shift.left(static_cast<Eigen::Index>(j))),
                   rival = log_belief(j, shift, snr, own - chance - kNoRival), odds = own - rival - chance;
      if (all_.list[j].effect)
        against += std::exp(-odds);
      else if (odds < over_patterns)
        return false;
    }
    return against <= most;
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
      if (all_.list[j].effect)
        sum += out[j] = std::exp(std::min(50.0, log_belief(j, shift, snr, own - kNoRival) - own));
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
  const std::vector<int>& rows_;
  const EvidenceSearch& search_;
  const Power& power_;
  std::vector<VariantView> variants_;  ///< by explanation
  std::vector<Stretch> variants_of_;   ///< by explanation
  std::vector<Stretch> sizes_of_;      ///< of all variants of an explanation
  Vector log_belief_;                  ///< before the shift, by explanation, variant and size
  std::vector<Vector> diagonal_;       ///< by variant: the information on each column
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
