#include "engine/diagnose/baseline/known_state.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace abbe::diagnose {

namespace {

Vector vector_of(const std::vector<double>& list) {
  return Eigen::Map<const Vector>(list.data(), static_cast<Eigen::Index>(list.size()));
}

nlohmann::ordered_json list_of(const Vector& v) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const double x : v) list.push_back(x);
  return list;
}

}  // namespace

KnownGeometry known_geometry(const KnownState& state) {
  // A machine of which nothing is open has one column, of zeros.
  const std::size_t columns = std::max<std::size_t>(1, state.factor.size());
  KnownGeometry out{vector_of(state.mean), Matrix::Zero(state.mean.size(), columns)};
  for (std::size_t k = 0; k < state.factor.size(); ++k)
    out.factor.col(static_cast<Eigen::Index>(k)) = vector_of(state.factor[k]);
  return out;
}

std::string write_known_state(const KnownGeometry& known, const Hyperparameters& hyper) {
  nlohmann::ordered_json state;
  state["schema"] = KnownState::kSchema;
  state["geometry_scale"] = hyper.scale;
  state["mean"] = list_of(known.mean);
  state["factor"] = nlohmann::ordered_json::array();
  for (Eigen::Index k = 0; k < known.factor.cols(); ++k)
    if (known.factor.col(k).squaredNorm() > 0) state["factor"].push_back(list_of(known.factor.col(k)));
  return state.dump();
}

}  // namespace abbe::diagnose
