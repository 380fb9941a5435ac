#include "engine/report/budget.hpp"

#include <cmath>
#include <map>

namespace abbe {

namespace {

using Line = CharacteristicReport::BudgetLine;

double significant(double u, Unit unit) { return u < smallest_u(unit) ? 0 : u; }

/// The values of the machines that are in every one of three samples.
struct Matched {
  std::vector<double> all, alignment, feature;
};

Matched matched(const Samples& all, const Samples& alignment, const Samples& feature) {
  const auto by_machine = [](const Samples& s) {
    std::map<std::uint32_t, double> values;
    for (std::size_t i = 0; i < s.value.size(); ++i) values[s.machine[i]] = s.value[i];
    return values;
  };
  const auto a = by_machine(alignment), f = by_machine(feature);
  Matched m;
  for (std::size_t i = 0; i < all.value.size(); ++i) {
    const auto in_a = a.find(all.machine[i]), in_f = f.find(all.machine[i]);
    if (in_a == a.end() || in_f == f.end()) continue;
    m.all.push_back(all.value[i]);
    m.alignment.push_back(in_a->second);
    m.feature.push_back(in_f->second);
  }
  return m;
}

double covariance(const std::vector<double>& x, const std::vector<double>& y) {
  const double n = static_cast<double>(x.size());
  double mean_x = 0, mean_y = 0, sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) mean_x += x[i] / n, mean_y += y[i] / n;
  for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - mean_x) * (y[i] - mean_y);
  return sum / (n - 1);
}

}  // namespace

std::vector<Line> variance_budget(const std::vector<ContributorRun>& alone, const std::vector<Samples>& samples,
                                  std::size_t index, Unit unit, double factor) {
  std::vector<Line> lines;
  double total = 0;
  for (const ContributorRun& run : alone) {
    const Samples* own = counterpart(samples, index, run.result);
    if (!own || own->value.size() < 2) return {};
    const double u = significant(summarize(own->value).u, unit);
    lines.push_back({run.name, u * u, factor * u});
    total += u * u;
  }
  if (total > 0)
    for (Line& line : lines) line.share /= total;
  return lines;
}

std::vector<Line> alignment_split(const Samples& all, const Samples& alignment, const Samples& feature, Unit unit,
                                  double factor) {
  const Matched m = matched(all, alignment, feature);
  if (m.all.size() < 2) return {};
  const double variance = covariance(m.all, m.all);
  const bool varies = significant(std::sqrt(variance), unit) > 0;
  const auto line = [&](const char* name, const std::vector<double>& part) {
    const double u = significant(std::sqrt(covariance(part, part)), unit);
    return Line{name, varies && u > 0 ? covariance(part, m.all) / variance : 0, factor * u};
  };
  std::vector<Line> lines{line("alignment", m.alignment), line("feature", m.feature)};
  const double rest = 1 - lines[0].share - lines[1].share;
  if (varies && std::fabs(rest) > kSmallestInteraction) {
    std::vector<double> left;
    for (std::size_t i = 0; i < m.all.size(); ++i) left.push_back(m.all[i] - m.alignment[i] - m.feature[i]);
    lines.push_back({"interaction", rest, factor * std::sqrt(covariance(left, left))});
  }
  return lines;
}

}  // namespace abbe
