#include "engine/diagnose/values/value_patterns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "engine/diagnose/explanations/patterns/families.hpp"
#include "engine/diagnose/words.hpp"

namespace abbe::diagnose {

namespace {

constexpr const char *kOneRun = "one run", *kOneRunByLength = "one run, in proportion to length",
                     *kFromRunToRun = "from run to run",
                     *kFromRunToRunByLength = "from run to run, in proportion to length";

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

void add_over_runs(const ValueCase& c, const Vector& deviation, Explanations& out) {
  constexpr std::size_t kLeastInRun = 3, kLeastRuns = 3;
  std::map<int, std::size_t> runs;
  for (const Eigen::Index k : moved_alike(c)) ++runs[run_of(c, k)];
  if (runs.size() < 2) return;
  patterns::Family family(Factor::run, out);
  const auto same = [](Eigen::Index) { return 1.0; };
  const auto by_length = [&](Eigen::Index k) { return length_m(c, k); };
  std::vector<patterns::Family::Told> one, one_by_length;
  for (const auto& [run, count] : runs) {
    if (count < kLeastInRun) continue;  // single values that stray
    const auto in_it = [run = run](int r) { return r == run ? 1.0 : 0.0; };
    one.push_back({fmt::format("run {}", run), column_over_runs(c, deviation, in_it, same)});
    one_by_length.push_back({one.back().what, column_over_runs(c, deviation, in_it, by_length)});
  }
  const auto add = [&](const char* shape, const std::vector<patterns::Family::Told>& variants) {
    if (!variants.empty()) family.add(shape, variants);
  };
  const bool lengths = length_m(c, moved_alike(c).front()) > 0;
  add(kOneRun, one);
  if (lengths) add(kOneRunByLength, one_by_length);
  if (runs.size() < kLeastRuns) return;
  // What grows from the first run on, or fades until the last.
  const auto place = [&](int run) {
    return double(std::distance(runs.begin(), runs.find(run))) / double(runs.size() - 1);
  };
  const auto from_last = [&](int run) { return 1 - place(run); };
  const auto add_change = [&](const char* shape, auto&& of) {
    const std::vector<Matrix> grows_or_fades = {column_over_runs(c, deviation, place, of),
                                                column_over_runs(c, deviation, from_last, of)};
    family.add(shape, grows_or_fades);
  };
  add_change(kFromRunToRun, same);
  if (lengths) add_change(kFromRunToRunByLength, by_length);
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
  const bool by_length = e.shape == kOneRunByLength || e.shape == kFromRunToRunByLength;
  const std::vector<Eigen::Index> moved = moved_alike(c);
  const auto rank = [&](Eigen::Index k) {
    return variant.told.empty() ? run_of(c, k) : variant.told == fmt::format("run {}", run_of(c, k)) ? 1 : 0;
  };
  const auto [from, to] = std::minmax_element(moved.begin(), moved.end(),
                                              [&](Eigen::Index a, Eigen::Index b) { return rank(a) < rank(b); });
  const auto of = [&](Eigen::Index k) { return by_length ? predicted(k) / length_m(c, k) : predicted(k); };
  const double more = of(*to) - of(*from);
  const std::string by = fmt::format("{} {}{} {}", by_length ? "in proportion to their lengths, by" : "all by",
                                     more < 0 ? "-" : "+", two_digits(std::abs(more)),
                                     by_length                  ? "um per m"
                                         : length_m(c, *to) > 0 ? "um"
                                                                : "urad");
  InWords out;
  if (!variant.told.empty()) out.run = run_of(c, *to);
  out.what = variant.told.empty()
      ? fmt::format("values change from run to run, {} from the first to the last", by)
      : fmt::format("the values of {} stray from those of the other runs, {}", variant.told, by);
  out.otherwise = by_length
      ? "Machine and part are the same in all runs, so see how warm the part and the scales were in each: 11.5 um per m are 1 K of steel. Give the touches themselves, with time_s and temperatures, and effects can be told that come and go."
      : "Machine and part are the same in all runs, so see what was done between them: a stylus qualified anew, dirt on it, a part clamped otherwise. Give the touches themselves, with time_s and run, and effects can be told that come and go.";
  return out;
}

}  // namespace abbe::diagnose
