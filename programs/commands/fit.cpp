// abbe fit ELEMENT POINTS.csv: the least-squares element of measured points, outside of any program.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "engine/base/diagnostic.hpp"
#include "engine/base/file_kind.hpp"
#include "engine/features/feature.hpp"
#include "engine/features/fit.hpp"
#include "engine/features/points_csv.hpp"
#include "engine/math/units.hpp"
#include "programs/commands/commands.hpp"
#include "programs/terminal.hpp"

namespace abbe {
namespace {

using Json = nlohmann::ordered_json;

/// Those that need the fewest points first.
std::vector<const FeatureKind*> fitted_kinds() {
  std::vector<const FeatureKind*> kinds;
  for (const FeatureKind* kind : feature_kinds())
    if (!kind->fit_names.element.empty()) kinds.push_back(kind);
  std::stable_sort(kinds.begin(), kinds.end(),
                   [](const FeatureKind* a, const FeatureKind* b) { return a->minimum_points < b->minimum_points; });
  return kinds;
}

const FeatureKind& element_named(std::string word) {
  std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const FeatureKind* kind : fitted_kinds())
    if (kind->fit_names.element == word) return *kind;
  const std::vector<std::string_view> names = fit_elements();
  const std::string near = nearest_word(word, names);
  throw UserError(diagnostic(Code::E0504, fmt::format("'{}' is not an element that can be fitted", word),
                             near.empty() ? fmt::format("choose one of {}", fmt::join(names, ", "))
                                          : fmt::format("did you mean '{}'?", near)));
}

std::string needs(const FeatureKind& kind) {
  constexpr const char* kSpread[] = {"", "", ", not all on one line", ", not all in one plane"};
  return fmt::format("a {} needs at least {} different points{}, and every coordinate a finite number",
                     kind.fit_names.element, kind.minimum_points, kSpread[kind.spread]);
}

/// The line of the first point of which a coordinate is nan or infinite: points stand on all lines below the header.
std::optional<Span> not_finite(const std::vector<Vec3>& points, const SourceFile& file) {
  const auto finite = [](const Vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); };
  const auto found = std::find_if_not(points.begin(), points.end(), finite);
  if (found == points.end()) return std::nullopt;
  const int line = static_cast<int>(found - points.begin()) + 2;
  const std::uint32_t begin = file.line_begin(line);
  return Span{begin, begin + static_cast<std::uint32_t>(file.line(line).size())};
}

Json components(const Vec3& v) { return {v.x, v.y, v.z}; }

Json result_of(const FitNames& names, const FitSolution& solution, std::size_t points) {
  const Element& e = solution.element;
  Json j{{"schema", "abbe.fit/1"}, {"element", names.element}};
  const auto add = [&j](std::string_view key, const Json& value) {
    if (!key.empty()) j[key] = value;
  };
  add(names.point, components(e.point));
  add(names.direction, components(e.direction));
  add(names.half_angle, in_degrees(e.angle));
  add(names.size, e.size);
  add(names.minor_size, e.minor_size);
  add(names.apex, components(solution.apex));
  j["rms"] = solution.rms;
  j["form"] = solution.form;
  j["n"] = points;
  return j;
}

/// The same result for people: one quantity a line, lengths in mm to the nanometre.
std::string as_text(const Json& result) {
  std::string text;
  for (const auto& [key, value] : result.items()) {
    if (key == "schema") continue;
    std::string shown = value.is_string() ? value.get<std::string>() : value.dump();
    if (value.is_number_float()) shown = fmt::format("{:.6f}", value.get<double>());
    if (value.is_array()) {
      const int decimals = key == "direction" || key == "normal" || key == "axis" ? 9 : 6;
      shown.clear();
      for (const double v : value.get<std::vector<double>>()) shown += fmt::format("{:>18.{}f}", v, decimals);
    }
    text += fmt::format("{:<15} {}\n", key, shown);
  }
  return text;
}

}  // namespace

std::vector<std::string_view> fit_elements() {
  std::vector<std::string_view> names;
  for (const FeatureKind* kind : fitted_kinds()) names.push_back(kind->fit_names.element);
  return names;
}

int fit_command(const FitOptions& options) {
  const FeatureKind& kind = element_named(options.element);
  const std::string_view name = kind.fit_names.element;
  const SourceFile points = read_source(options.points);
  refuse_other_kind(points, FileKind::table);
  FitProblem problem{kind.shape, points_from_csv(points), {}};
  if (options.normal) {
    if (kind.shape != Shape::circle)
      throw UserError(diagnostic(Code::E0506, fmt::format("--normal has no meaning for a {}", name),
                                 "leave it out; only the plane of a circle can be prescribed"));
    const auto& n = *options.normal;
    problem.normal = Vec3{n[0], n[1], n[2]};
  }
  const FitSolution solution = fit_points(problem);
  if (solution.error) {
    const std::string message = fmt::format("no {} can be fitted to {} points: {} ({})", name, problem.points.size(),
                                            solution.error->message, solution.error->code);
    if (const std::optional<Span> line = not_finite(problem.points, points))
      throw UserError(diagnostic_at(points, *line, Code::E0505, message, needs(kind)));
    Diagnostic d = diagnostic(Code::E0505, message, needs(kind));
    d.file = options.points;
    throw UserError(d);
  }
  const Json result = result_of(kind.fit_names, solution, problem.points.size());
  const std::string text = options.format == "json" ? result.dump(2) + "\n" : as_text(result);
  print_result(text);
  return kDone;
}

}  // namespace abbe
