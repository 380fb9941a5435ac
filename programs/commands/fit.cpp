// abbe fit ELEMENT POINTS.csv: the least-squares element of measured points, outside of any program.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "engine/base/diagnostic.hpp"
#include "engine/features/feature.hpp"
#include "engine/features/fit.hpp"
#include "engine/features/points_csv.hpp"
#include "programs/commands/commands.hpp"
#include "programs/terminal.hpp"

namespace abbe {
namespace {

using Json = nlohmann::ordered_json;

/// The name of an element and the names of what its fit reports; an empty name: not reported.
struct ElementNames {
  std::string_view name;
  Shape shape;
  const char *point, *direction, *size;
};
constexpr ElementNames kElements[] = {
    {"line", Shape::line, "point", "direction", ""},           {"plane", Shape::plane, "point", "normal", ""},
    {"circle", Shape::circle, "center", "normal", "radius"},   {"sphere", Shape::sphere, "center", "", "radius"},
    {"cylinder", Shape::cylinder, "point", "axis", "radius"},  {"cone", Shape::cone, "point", "axis", "radius"},
    {"torus", Shape::torus, "center", "axis", "major_radius"},
};

const ElementNames& element_named(std::string word) {
  std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
  std::vector<std::string_view> names;
  for (const ElementNames& e : kElements) {
    if (e.name == word) return e;
    names.push_back(e.name);
  }
  const std::string near = nearest_word(word, names);
  throw UserError(diagnostic(Code::E0504, fmt::format("'{}' is not an element that can be fitted", word),
                             near.empty() ? fmt::format("choose one of {}", fmt::join(names, ", "))
                                          : fmt::format("did you mean '{}'?", near)));
}

std::string needs(const ElementNames& names) {
  const char* spread = names.shape == Shape::line                   ? ""
      : names.shape == Shape::plane || names.shape == Shape::circle ? ", not all on one line"
                                                                    : ", not all in one plane";
  return fmt::format("a {} needs at least {} different points{}, and every coordinate a finite number", names.name,
                     feature_kind(names.shape).minimum_points, spread);
}

Json components(const Vec3& v) { return {v.x, v.y, v.z}; }

Json result_of(const ElementNames& names, const FitSolution& solution, std::size_t points) {
  const Element& e = solution.element;
  Json j{{"schema", "abbe.fit/1"}, {"element", names.name}, {names.point, components(e.point)}};
  if (*names.direction) j[names.direction] = components(e.direction);
  if (names.shape == Shape::cone) j["half_angle_deg"] = e.angle * 180 / kPi;
  if (*names.size) j[names.size] = e.size;
  if (names.shape == Shape::torus) j["minor_radius"] = e.minor_size;
  if (names.shape == Shape::cone) j["apex"] = components(solution.apex);
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

int fit_command(const FitOptions& options) {
  const ElementNames& names = element_named(options.element);
  FitProblem problem{names.shape, points_from_csv(read_source(options.points)), {}};
  if (options.normal) {
    if (names.shape != Shape::circle)
      throw UserError(diagnostic(Code::E0506, fmt::format("--normal has no meaning for a {}", names.name),
                                 "leave it out; only the plane of a circle can be prescribed"));
    const auto& n = *options.normal;
    problem.normal = Vec3{n[0], n[1], n[2]};
  }
  const FitSolution solution = fit_points(problem);
  if (solution.error) {
    Diagnostic d = diagnostic(Code::E0505,
                              fmt::format("no {} can be fitted to {} points: {} ({})", names.name,
                                          problem.points.size(), solution.error->message, solution.error->code),
                              needs(names));
    d.file = options.points;
    throw UserError(d);
  }
  const Json result = result_of(names, solution, problem.points.size());
  const std::string text = options.format == "json" ? result.dump(2) + "\n" : as_text(result);
  print_result(text);
  return kDone;
}

}  // namespace abbe
