#include "engine/run/recorded/logged.hpp"

#include <initializer_list>
#include <optional>
#include <variant>

#include "engine/effects/effect.hpp"

namespace abbe {

namespace {

struct CovariateColumns {
  Covariate covariate;
  std::vector<std::string> columns;
};

const std::vector<CovariateColumns>& covariate_columns() {
  static const std::vector<CovariateColumns> all = {
      {Covariate::position, {"x", "y", "z"}},
      {Covariate::normal, {"nx", "ny", "nz"}},
      {Covariate::time, {"time_s"}},
      {Covariate::speed, {"speed_mm_s"}},
      {Covariate::acceleration, {"accel_mm_s2"}},
      {Covariate::direction, {"ax", "ay", "az"}},
      {Covariate::head, {"head_A_deg", "head_B_deg"}},
      {Covariate::sensor, {"sensor"}},
      {Covariate::part_temperature, {"temp_part_C"}},
      {Covariate::scale_temperature, {"temp_x_C", "temp_y_C", "temp_z_C"}},
      {Covariate::air_temperature, {"temp_air_C"}},
      {Covariate::gradients, {}},
      {Covariate::raw_reading, {"enc_x", "enc_y", "enc_z"}},
      {Covariate::load, {"load_kg"}},
      {Covariate::visit, {"visit"}},
      {Covariate::qualification, {"qualification"}},
      {Covariate::part_frame, {"tx", "ty", "tz"}},
      {Covariate::feature, {"feature"}},
  };
  return all;
}

/// What a covariate holds: a figure, or the name of a sensor or feature.
using CovariateValue = std::variant<double, std::string>;
using CovariateValues = std::vector<CovariateValue>;

/// The values of a covariate in a row; empty when it was not logged.
CovariateValues values(Covariate c, const RecordingRow& r, const Sensor& sensor, const RecordedStyli& styli) {
  const auto given = [](std::initializer_list<std::optional<double>> list) {
    CovariateValues v;
    for (const auto& x : list)
      if (x) v.emplace_back(*x);
    return v.size() == list.size() ? v : CovariateValues{};
  };
  const auto of = [](const std::optional<int>& v) { return v ? std::optional<double>(*v) : std::nullopt; };
  const auto of_vector = [](const std::optional<Vec3>& v) {
    return v ? CovariateValues{v->x, v->y, v->z} : CovariateValues{};
  };
  switch (c) {
    case Covariate::position: return of_vector(r.target_mm);
    case Covariate::part_frame: return of_vector(r.target_mm);
    case Covariate::normal: return of_vector(r.normal);
    case Covariate::time: return given({r.time_s});
    case Covariate::speed: return given({r.speed_mm_s});
    case Covariate::acceleration: return given({r.accel_mm_s2});
    case Covariate::direction: return of_vector(r.travel);
    case Covariate::head:
      return styli.tells_head(r) ? CovariateValues{sensor.head_a_rad, sensor.head_b_rad} : CovariateValues{};
    case Covariate::sensor: return styli.tells_stylus(r) ? CovariateValues{sensor.name} : CovariateValues{};
    case Covariate::part_temperature: return given({r.temp_part_C});
    case Covariate::scale_temperature: return given({r.temp_x_C, r.temp_y_C, r.temp_z_C});
    case Covariate::air_temperature: return given({r.temp_air_C});
    case Covariate::gradients: return {};
    case Covariate::raw_reading: return of_vector(r.reading_mm);
    case Covariate::load: return given({r.load_kg});
    case Covariate::visit:
      return styli.tells_head(r) ? CovariateValues{double(r.visit.value_or(0))} : CovariateValues{};
    case Covariate::qualification: return given({of(r.qualification)});
    case Covariate::feature: return {r.feature};
  }
  return {};
}

}  // namespace

Logged logged_covariates(const Recording& recording, const std::vector<const Sensor*>& sensors,
                         const RecordedStyli& styli) {
  Logged out;
  for (const CovariateColumns& entry : covariate_columns()) {
    bool known = true, varying = false;
    const CovariateValues first = values(entry.covariate, recording.rows.front(), *sensors.front(), styli);
    for (std::size_t i = 0; i < recording.rows.size(); ++i) {
      const CovariateValues v = values(entry.covariate, recording.rows[i], *sensors[i], styli);
      known = known && !v.empty();
      if (known && v != first) varying = true;
    }
    if (known) out.known = out.known | entry.covariate;
    if (known && varying) out.varying = out.varying | entry.covariate;
  }
  return out;
}

std::vector<std::string> columns_of(unsigned covariates) {
  std::vector<std::string> columns;
  for (const CovariateColumns& entry : covariate_columns())
    if (covariates & static_cast<unsigned>(entry.covariate))
      columns.insert(columns.end(), entry.columns.begin(), entry.columns.end());
  return columns;
}

}  // namespace abbe
