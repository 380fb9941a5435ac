#include <algorithm>

#include "engine/workpiece/workpiece.hpp"

namespace abbe {

Temperatures Workpiece::temperatures(double time_s) const {
  const auto logged = [&](TemperatureLog::Column c, double otherwise) {
    return log.has(c) ? log.at(c, time_s) : otherwise;
  };
  Temperatures t = other;
  t.air = logged(TemperatureLog::air, other.air);
  t.part = logged(TemperatureLog::part, part_C.value);
  for (int k = 0; k < 3; ++k)
    t.scale[k] = logged(static_cast<TemperatureLog::Column>(TemperatureLog::x + k), scale_C[k].value);
  if (!part_minus_scale_K) return t;
  if (part_follows_scale) {
    t.part = t.scale[0] + part_minus_scale_K->value;
  } else {
    for (double& scale : t.scale) scale = t.part - part_minus_scale_K->value;
  }
  return t;
}

ThermalDraw draw_thermal(const Workpiece& w, DrawFor who) {
  ThermalDraw d;
  d.scale_cte_per_K = w.scale_cte_per_K.value + deviation(w.scale_cte_per_K, "scales.cte", who);
  d.part_cte_per_K = w.part_cte_per_K.value + deviation(w.part_cte_per_K, "material.cte", who);
  if (w.part_cte_from_scale) d.part_cte_per_K += d.scale_cte_per_K;
  d.part_K = deviation(w.part_C, "temperature.part_C", who);
  for (int k = 0; k < 3; ++k) {
    d.scale_K[k] = deviation(w.scale_C[k], w.scale_name[k], who);
    d.scale_sensor_K[k] =
        w.sensor_K.value + deviation(w.sensor_K, std::string("compensation.sensor_K.") + "xyz"[k], who);
  }
  d.part_sensor_K = w.sensor_K.value + deviation(w.sensor_K, "compensation.sensor_K.part", who);
  if (!w.part_minus_scale_K) return d;
  const double difference_K = deviation(*w.part_minus_scale_K, "temperature.part_minus_scale_K", who);
  if (w.part_follows_scale) {
    d.part_K = d.scale_K[0] + difference_K;
  } else {
    d.scale_K.fill(d.part_K - difference_K);
  }
  return d;
}

bool temperatures_vary(const Workpiece& w) {
  const auto doubtful = [](const Uncertain& quantity) { return !quantity.exact(); };
  return doubtful(w.part_C) || std::any_of(w.scale_C, w.scale_C + 3, doubtful) ||
      (w.part_minus_scale_K && doubtful(*w.part_minus_scale_K));
}

Temperatures drawn_temperatures(const Temperatures& estimate, const ThermalDraw& draw) {
  Temperatures t = estimate;
  t.part += draw.part_K;
  for (int k = 0; k < 3; ++k) t.scale[k] += draw.scale_K[k];
  return t;
}

Vec3 strain(const Workpiece& w, const ThermalDraw& d, const Temperatures& estimate, bool compensated) {
  const double part_above_K = estimate.part + d.part_K - kReferenceTemperature_C;
  double of_part = d.part_cte_per_K * part_above_K;
  if (compensated) of_part -= w.assumed_part_cte_per_K * (part_above_K + d.part_sensor_K);
  Vec3 out;
  for (int k = 0; k < 3; ++k) {
    const double scale_above_K = estimate.scale[k] + d.scale_K[k] - kReferenceTemperature_C;
    double of_scale = d.scale_cte_per_K * scale_above_K;
    if (compensated) of_scale -= w.assumed_scale_cte_per_K * (scale_above_K + d.scale_sensor_K[k]);
    out[k] = of_part - of_scale;
  }
  return out;
}

}  // namespace abbe
