#include "engine/diagnose/baseline/known_state.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/machine/geometry.hpp"

namespace abbe::diagnose {

namespace {

constexpr const char* kSchema = "abbe.known_state/1";

[[noreturn]] void refuse(const Machine& machine, const std::string& what) {
  throw UserError(diagnostic(Code::E0706,
                             fmt::format("the known_state of machine '{}' cannot be used: {}", machine.name, what),
                             "make it anew: abbe diagnose CALIBRATION.csv --machine M --model-out KNOWN.json"));
}

Vector vector_of(const Machine& machine, const nlohmann::json& list, Eigen::Index size) {
  if (!list.is_array() || static_cast<Eigen::Index>(list.size()) != size)
    refuse(machine, fmt::format("a list of {} numbers is expected", size));
  Vector v(size);
  for (Eigen::Index k = 0; k < size; ++k) {
    if (!list[static_cast<std::size_t>(k)].is_number()) refuse(machine, "a list holds something that is no number");
    v(k) = list[static_cast<std::size_t>(k)].get<double>();
    constexpr double kMost = 1e6;  // standard deviations of the specification
    if (!(std::abs(v(k)) < kMost)) refuse(machine, fmt::format("{:g} is no coefficient of an error function", v(k)));
  }
  return v;
}

nlohmann::ordered_json list_of(const Vector& v) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const double x : v) list.push_back(x);
  return list;
}

}  // namespace

std::optional<KnownGeometry> read_known_state(const Machine& machine) {
  if (machine.known_state.empty()) return std::nullopt;
  const nlohmann::json state = nlohmann::json::parse(machine.known_state, nullptr, false);
  const auto schema = state.find("schema");
  if (schema == state.end() || *schema != nlohmann::json(kSchema))
    refuse(machine, fmt::format("\"schema\": \"{}\" is missing", kSchema));
  for (const auto& [key, value] : state.items())
    if (key != "schema" && key != "geometry_scale" && key != "mean" && key != "factor")
      refuse(machine, fmt::format("\"{}\" is no key of it", key));
  const Eigen::Index size = kComponents * basis_size(machine.harmonics);
  for (const char* key : {"mean", "factor"})
    if (!state.contains(key)) refuse(machine, fmt::format("\"{}\" is missing", key));
  KnownGeometry out;
  out.mean = vector_of(machine, state["mean"], size);
  if (!state["factor"].is_array() || state["factor"].empty()) refuse(machine, "\"factor\" is a list of columns");
  out.factor.resize(size, static_cast<Eigen::Index>(state["factor"].size()));
  for (std::size_t k = 0; k < state["factor"].size(); ++k)
    out.factor.col(static_cast<Eigen::Index>(k)) = vector_of(machine, state["factor"][k], size);
  return out;
}

std::string write_known_state(const KnownGeometry& known, const Hyperparameters& hyper) {
  nlohmann::ordered_json state;
  state["schema"] = kSchema;
  state["geometry_scale"] = hyper.scale;
  state["mean"] = list_of(known.mean);
  state["factor"] = nlohmann::ordered_json::array();
  for (Eigen::Index k = 0; k < known.factor.cols(); ++k)
    if (known.factor.col(k).squaredNorm() > 0) state["factor"].push_back(list_of(known.factor.col(k)));
  return state.dump();
}

}  // namespace abbe::diagnose
