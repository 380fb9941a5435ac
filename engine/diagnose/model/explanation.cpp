#include "engine/diagnose/model/explanation.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/diagnose/model/products.hpp"

namespace abbe::diagnose {

std::string_view name(Factor f) {
  constexpr std::string_view names[] = {"time",  "position", "direction", "head",        "sensor",
                                        "setup", "feature",  "run",       "temperature", "speed"};
  return names[static_cast<int>(f)];
}

bool adjoin(const Cell& a, const Cell& b) {
  const double rounding = 1e-9 * (std::abs(a.low) + std::abs(a.high));
  return a.low <= b.high + rounding && b.low <= a.high + rounding;
}

bool alike(const Variant& a, const Variant& b) {
  if (a.change != b.change || a.group != b.group || a.axis != b.axis) return false;
  for (std::size_t p = 0; p < a.theta.size(); ++p)
    if (a.theta[p] != b.theta[p] && a.cells[p].low == a.cells[p].high && b.cells[p].low == b.cells[p].high)
      return false;
  return true;
}

bool in_one_placement(const Effect& effect, const Variant& variant) {
  for (std::size_t p = 0; p < effect.parameters.size(); ++p)
    if (effect.parameters[p].sought == Sought::setup && variant.theta[p] > 0) return true;
  return false;
}

void share_belief(const Explanation& e, std::vector<Variant>& variants) {
  constexpr double kAny = 0.5, kEachAxis = (1 - kAny) / 3;
  const auto of_direction = [](const Variant& b) { return b.axis < 0 ? kAny : kEachAxis; };
  std::map<std::string_view, double> in_group;
  for (const int k : e.variants) in_group[variants[k].group] += of_direction(variants[k]);
  const auto weight = [&](const Variant& b) {
    return (b.change.gone() ? 0.5 : 1) * of_direction(b) / in_group[b.group];
  };
  enum Kind { constant, between_runs, within_a_run, kKinds };
  const bool at_a_moment = e.effect && moment_of(*e.effect);
  const auto kind = [&](const Variant& b) {
    return !b.change.any() ? constant : at_a_moment && b.change.from == 0 ? within_a_run : between_runs;
  };
  double sum[kKinds] = {}, share[kKinds] = {};
  for (const int k : e.variants) sum[kind(variants[k])] += weight(variants[k]);
  // Moments within runs are many, beginnings of runs are few: all of either are as likely together.
  const double changing = e.effect && e.effect->lasting ? kPriorChangeOfLasting : kPriorChange,
               each = sum[between_runs] > 0 && sum[within_a_run] > 0 ? changing / 2 : changing;
  share[constant] = 1 - changing, share[between_runs] = share[within_a_run] = each;
  double there = 0;
  for (int k = 0; k < kKinds; ++k) there += sum[k] > 0 ? share[k] : 0;
  for (const int k : e.variants) {
    Variant& b = variants[k];
    b.weight = weight(b) * share[kind(b)] / there / sum[kind(b)];
  }
}

namespace {

struct WeightedSum {
  double value = 0;
  double of_sizes = 0;  ///< the same of the absolute values: what rounding is in proportion to
};

/// Each number with a weight of its own below 1, so that no order and no sign is lost.
WeightedSum weighted_sum(const Matrix& columns) {
  constexpr double kGolden = 0.6180339887498949;
  WeightedSum sum;
  double weight = 0;
  for (const double x : columns.reshaped()) {
    weight += kGolden;
    if (weight >= 1) weight -= 1;
    sum.value += weight * x, sum.of_sizes += weight * std::abs(x);
  }
  return sum;
}

}  // namespace

void ColumnsSeen::add(const Matrix& columns, int number) {
  number_by_sum_.emplace(weighted_sum(columns).value, number);
}

int ColumnsSeen::find(const Matrix& columns, const std::vector<Variant>& variants) const {
  constexpr double kRounding = 1e-10;
  const WeightedSum sum = weighted_sum(columns);
  const double margin = kSameColumns_um * double(columns.size()) + kRounding * sum.of_sizes;
  int found = -1;
  const auto end = number_by_sum_.upper_bound(sum.value + margin);
  for (auto at = number_by_sum_.lower_bound(sum.value - margin); at != end; ++at)
    if ((found < 0 || at->second < found) && same_columns(variants[at->second].signature, columns)) found = at->second;
  return found;
}

bool same_columns(const Matrix& a, const Matrix& b, double less_than_um) {
  if (a.cols() != b.cols() || a.rows() != b.rows()) return false;
  return std::equal(a.data(), a.data() + a.size(), b.data(),
                    [&](double x, double y) { return std::abs(x - y) < less_than_um; });
}

Matrix compressed(const Matrix& m) {
  if (m.cols() == 0) return m;
  const bool wide = m.cols() > m.rows();
  const auto [values, vectors] = spectrum(wide ? product(m, m.transpose()) : transposed_product(m, m));
  const double least = 1e-6 * values(values.size() - 1);
  Eigen::Index first = 0;
  while (first < values.size() - 1 && values(first) < least) ++first;
  const Eigen::Index kept = values.size() - first;
  if (wide) return vectors.rightCols(kept) * values.tail(kept).cwiseMax(0).cwiseSqrt().asDiagonal();
  return m * vectors.rightCols(kept);
}

Explanations only(const Explanations& all, const std::vector<int>& kept) {
  Explanations out;
  for (const int k : kept) {
    Explanation e = all.list[k];
    for (int& b : e.variants) {
      out.variants.push_back(all.variants[b]);
      out.variants.back().explanation = static_cast<int>(out.list.size());
      b = static_cast<int>(out.variants.size()) - 1;
    }
    out.list.push_back(std::move(e));
  }
  return out;
}

Explanations rows_of(const Explanations& all, const std::vector<Eigen::Index>& rows) {
  Explanations out = all;
  for (Variant& b : out.variants) b.signature = Matrix(b.signature(rows, Eigen::all));
  return out;
}

}  // namespace abbe::diagnose
