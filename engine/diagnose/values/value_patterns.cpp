#include "engine/diagnose/values/value_patterns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <tuple>

#include "engine/diagnose/explanations/patterns/families.hpp"
#include "engine/diagnose/words.hpp"

namespace abbe::diagnose {

namespace {

constexpr std::string_view kOneRun = "one run", kFromOneRunOn = "from one run on", kFromRunToRun = "from run to run",
                           kEachRun = "each run by itself", kByLength = ", in proportion to length";

/// A column by label, as far as values deviate: all repeats by the same, since they tell each other to a fraction of that.
std::vector<patterns::Family::Told> by_characteristic(const ValueCase& c, const Vector& deviation) {
  const std::vector<std::string> labels = labels_of(c);
  std::map<std::string, Matrix> columns;
  for (std::size_t k = 0; k < labels.size(); ++k) {
    Matrix& column = columns.try_emplace(labels[k], Matrix::Zero(deviation.size(), 1)).first->second;
    const auto row = static_cast<Eigen::Index>(k);
    column(row, 0) = column.isZero() ? deviation(row) : column.maxCoeff();
  }
  std::vector<patterns::Family::Told> out;
  for (const auto& [label, column] : columns) out.push_back({label, column});
  return out;
}

/// What is measured in several places: of one tolerance label, one reference and one artefact. All by the same, among others.
std::vector<patterns::Family::Told> by_reference(const ValueCase& c, const Vector& deviation) {
  constexpr double kSame = 1e-3;  // mm or degrees: what rounding leaves of a program's nominals
  struct Rows {
    std::set<std::tuple<int, int, int>> places;
    std::vector<Eigen::Index> list;
  };
  std::map<std::tuple<std::string, long long, std::string>, Rows> of;
  for (std::size_t k = 0; k < c.ensemble.values.size(); ++k) {
    const RecordedValue& v = c.ensemble.values[k];
    const ValueRow& row = c.recording->rows[k];
    Rows& rows = of[{abbe::labels_of(row.characteristic).back(), std::llround(v.reference / kSame), row.artefact}];
    rows.places.insert({v.program, v.characteristic.value, v.occurrence});
    rows.list.push_back(static_cast<Eigen::Index>(k));
  }
  std::vector<patterns::Family::Told> out;
  if (of.size() < 2) return out;
  for (const auto& [which, rows] : of) {
    if (rows.places.size() < 2) continue;
    Matrix column = Matrix::Zero(deviation.size(), 1);
    column(rows.list, 0).setConstant(deviation(rows.list).maxCoeff());
    const RecordedValue& first = c.ensemble.values[static_cast<std::size_t>(rows.list.front())];
    out.push_back({fmt::format("{} ({:.9g} {} by reference) strays alike in all {} places where it was measured",
                               std::get<0>(which), first.reference, first.angle ? "degrees" : "mm", rows.places.size()),
                   column});
  }
  return out;
}

int run_of(const ValueCase& c, Eigen::Index value) { return c.recording->rows[static_cast<std::size_t>(value)].run; }

/// m, of a length; 0: none, as of a form.
double length_m(const ValueCase& c, Eigen::Index value) {
  const RecordedValue& v = c.ensemble.values[static_cast<std::size_t>(value)];
  return v.angle ? 0 : std::abs(v.reference) / 1000;
}

/// The values that a change of machine, part or stylus between runs moves alike.
std::vector<Eigen::Index> moved_alike(const ValueCase& c) {
  std::vector<Eigen::Index> figures = of_figures(c.ensemble.values), lengths;
  std::copy_if(figures.begin(), figures.end(), std::back_inserter(lengths),
               [&](Eigen::Index k) { return length_m(c, k) > 0; });
  return lengths.empty() ? figures : lengths;
}

/// A column by run of what moves values in proportion to `of`, as far as values deviate.
Vector column_over_runs(const ValueCase& c, const Vector& deviation, auto&& in_run, auto&& of) {
  Vector column = Vector::Zero(deviation.size()), alike = column;
  const std::vector<Eigen::Index> moved = moved_alike(c);
  for (const Eigen::Index k : moved) alike(k) = of(k), column(k) = in_run(run_of(c, k)) * of(k);
  const double typical = deviation(moved).norm() / std::max(alike.norm(), 1e-300);
  return typical * column;
}

std::string called(int run) { return fmt::format("run {}", run); }

/// Everything that may differ between runs; `column` makes one of what each run has, by its place among all. `names`: of runs
/// that may be told by themselves, else empty.
void add_changes(std::string_view by, std::size_t runs, const std::vector<std::string>& names, auto&& column,
                 patterns::Family& family) {
  constexpr std::size_t kLeastRuns = 3;
  const double last = double(runs - 1);
  const auto add = [&](std::string_view shape, const auto& variants) {
    if (!variants.empty()) family.add(fmt::format("{}{}", shape, by), variants);
  };
  std::vector<patterns::Family::Told> one, from_one_on;
  for (std::size_t k = 0; k < runs; ++k) {
    if (names[k].empty()) continue;  // single values that stray
    one.push_back({names[k], column([&](std::size_t place) { return place == k ? 1.0 : 0.0; })});
    if (k > 1 && k + 1 < runs)  // or all but the first differ, or the last alone
      from_one_on.push_back({names[k], column([&](std::size_t place) { return place >= k ? 1.0 : 0.0; })});
  }
  add(kOneRun, one);
  add(kFromOneRunOn, from_one_on);
  if (runs < kLeastRuns) return;
  // What grows from the first run on, or fades until the last.
  add(kFromRunToRun,
      std::vector<Matrix>{column([&](std::size_t place) { return double(place) / last; }),
                          column([&](std::size_t place) { return 1 - double(place) / last; })});
  Matrix each(column([](std::size_t) { return 0.0; }).rows(), static_cast<Eigen::Index>(runs));
  for (std::size_t k = 0; k < runs; ++k)
    each.col(static_cast<Eigen::Index>(k)) = column([&](std::size_t place) { return place == k ? 1.0 : 0.0; });
  add(kEachRun, std::vector<Matrix>{each});
}

void add_over_runs(const ValueCase& c, const Vector& deviation, Explanations& out) {
  constexpr std::size_t kLeastInRun = 3;
  const std::vector<Eigen::Index> moved = moved_alike(c);
  std::map<int, std::vector<Eigen::Index>> runs;
  for (const Eigen::Index k : moved) runs[run_of(c, k)].push_back(k);
  if (runs.size() < 2) return;
  std::vector<std::string> names;
  for (const auto& [run, values] : runs) names.push_back(values.size() < kLeastInRun ? "" : called(run));
  patterns::Family family(Factor::run, out);
  const auto add = [&](std::string_view by, auto&& of) {
    const auto column = [&](auto&& in_run) {
      return Matrix(column_over_runs(
          c, deviation,
          [&](int run) { return in_run(static_cast<std::size_t>(std::distance(runs.begin(), runs.find(run)))); }, of));
    };
    add_changes(by, runs.size(), names, column, family);
  };
  add("", [](Eigen::Index) { return 1.0; });
  if (length_m(c, moved.front()) > 0) add(kByLength, [&](Eigen::Index k) { return length_m(c, k); });
  std::vector<patterns::Family::Told> scatter;
  for (const auto& [run, values] : runs) {
    if (values.size() < kLeastInRun) continue;
    Vector own = Vector::Zero(deviation.size());
    own(values) = deviation(values);
    scatter.push_back({called(run), Matrix(own.asDiagonal())(Eigen::all, values)});
  }
  if (!scatter.empty()) family.add(kScatterOfRun, scatter);
}

}  // namespace

void add_value_patterns(ValueCase& c) {
  Explanations& out = c.ensemble.explanations;
  const std::size_t catalogue = out.list.size();
  const Vector deviation = c.judges.covariance.diagonal().cwiseSqrt();
  const std::vector<patterns::Family::Told> each = by_characteristic(c, deviation);
  constexpr std::size_t kOthers = 2;  // for one of fewer nobody knows which it is
  patterns::Family in_values(Factor::feature, out);
  if (each.size() > kOthers) in_values.add(kOneCharacteristic, each);
  if (const std::vector<patterns::Family::Told> references = by_reference(c, deviation); !references.empty())
    in_values.add(kOneReference, references);
  in_values.add("single values", Matrix(deviation.asDiagonal()));
  patterns::Family(Factor::position, out).add("larger errors", Cholesky(c.judges.covariance).lower());
  add_over_runs(c, deviation, out);
  for (std::size_t k = 0; k < out.list.size(); ++k)
    out.list[k].prior =
        k < catalogue ? kPriorCatalogue / double(catalogue) : kPriorOther / double(out.list.size() - catalogue);
}

bool is_located(const Explanation& e) {
  return e.shape == kOneCharacteristic || e.shape == kOneReference || is_over_runs(e);
}

bool is_over_runs(const Explanation& e) { return !e.effect && e.factor == Factor::run; }

InWords over_runs(const ValueCase& c, const Explanation& e, const Variant& variant, const Vector& predicted) {
  const bool by_length = e.shape.ends_with(kByLength);
  const std::vector<Eigen::Index> moved = moved_alike(c);
  const std::string unit = by_length ? "um per m" : c.ensemble.values[moved.front()].angle ? "urad" : "um";
  std::map<int, double> amount;
  double squares = 0, of_run = 0;
  InWords out;
  for (const Eigen::Index k : moved) {
    const int run = run_of(c, k);
    amount[run] = by_length ? predicted(k) / length_m(c, k) : predicted(k);
    if (variant.told != called(run)) continue;
    out.run = run, squares += predicted(k) * predicted(k), of_run += 1;
  }
  const auto with_sign = [&](double value) {
    return fmt::format("{}{} {}", value < 0 ? "-" : "+", two_digits(std::abs(value)), unit);
  };
  const std::string how = by_length ? "in proportion to their lengths" : "all", &told = variant.told;
  out.otherwise = by_length
      ? "Machine and part are the same in all runs, so see how warm the part and the scales were in each: 11.5 um per m are 1 K of steel. Give the touches themselves, with time_s and temperatures, and effects can be told that come and go."
      : "Machine and part are the same in all runs, so see what was done between them: a stylus qualified anew, dirt on it, a part clamped otherwise. Give the touches themselves, with time_s and run, and effects can be told that come and go.";
  if (e.shape == kScatterOfRun) {
    out.what = fmt::format("the values of {} scatter by {} {}, each by itself", told,
                           two_digits(std::sqrt(squares / of_run)), unit);
    out.otherwise = fmt::format("See what was loose, dirty or shaking in {}, and measure it again.", told);
  } else if (e.shape.starts_with(kOneRun)) {
    out.what = fmt::format("the values of {} stray from those of the other runs, {} by {}", told, how,
                           with_sign(amount[*out.run]));
  } else if (e.shape.starts_with(kFromOneRunOn)) {
    out.what =
        fmt::format("from {} on values are others than before, {} by {}", told, how, with_sign(amount[*out.run]));
  } else if (e.shape.starts_with(kEachRun)) {
    constexpr std::size_t kMost = 8;
    const auto in_run = [&](const auto& of) { return fmt::format("{} in {}", with_sign(of.second), called(of.first)); };
    std::vector<std::string> each;
    for (const auto& of : amount) each.push_back(in_run(of));
    const auto [least, most] = std::minmax_element(amount.begin(), amount.end(),
                                                   [](const auto& a, const auto& b) { return a.second < b.second; });
    out.what =
        fmt::format("values change from run to run, {} by {}", how,
                    each.size() > kMost ? fmt::format("what lies between {} and {}", in_run(*least), in_run(*most))
                                        : fmt::format("{}", fmt::join(each, ", ")));
  } else {
    out.what = fmt::format("values change from run to run, {} by {} from the first to the last", how,
                           with_sign(amount.rbegin()->second - amount.begin()->second));
  }
  return out;
}

}  // namespace abbe::diagnose
