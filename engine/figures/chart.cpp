#include "engine/figures/chart.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/base/ids.hpp"

namespace abbe {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kWidth = 480, kHeight = 260;

double rounded(double value) {
  static const double per_unit = std::pow(10.0, kDecimals);
  return std::round(value * per_unit) / per_unit + 0.0;  // no "-0.0"
}

Json rows(const Chart& chart) {
  Json out = Json::array();
  for (const Chart::Series& s : chart.series) {
    ABBE_CHECK(s.x.size() == s.y.size());
    for (std::size_t i = 0; i < s.x.size(); ++i)
      out.push_back({{"x", rounded(s.x[i])}, {"y", rounded(s.y[i])}, {"series", s.name}});
  }
  return out;
}

Json quantitative(const char* field, const std::string& title, const Json& scale) {
  return {{"field", field},
          {"type", "quantitative"},
          {"scale", scale},
          {"axis", {{"title", title}, {"tickCount", 6}, {"format", "~f"}}}};
}

/// Nothing for a single series; else colour and dashes say the same, in one legend.
void add_series(const Chart& chart, Json& encoding) {
  if (chart.series.size() < 2) return;
  Json names = Json::array();
  for (const Chart::Series& s : chart.series) names.push_back(s.name);
  const auto channel = [&](Json range) {
    return Json{{"field", "series"},
                {"type", "nominal"},
                {"scale", {{"domain", names}, {"range", std::move(range)}}},
                {"legend", {{"title", chart.series_title}, {"titleLimit", 300}, {"symbolSize", 400}}}};
  };
  encoding["color"] = channel({"#0072B2", "#D55E00", "#009E73", "#CC79A7"});
  if (chart.mark == Chart::Mark::lines) encoding["strokeDash"] = channel({{1, 0}, {6, 3}, {2, 2}, {8, 2, 2, 2}});
}

Json mark(const Chart& chart) {
  if (chart.mark == Chart::Mark::lines) return {{"type", "line"}, {"color", "#0072B2"}, {"aria", false}};
  return {{"type", "point"}, {"filled", true}, {"size", 12}, {"color", "#0072B2"}, {"aria", false}};
}

Json config() {
  const Json zero_line = {{"condition", {{"test", "datum.value === 0"}, {"value", "#888"}}}, {"value", "#e6e6e6"}};
  return {
      {"font", "sans-serif"},
      {"view", {{"stroke", nullptr}}},
      {"axis", {{"gridColor", zero_line}, {"titleFontWeight", "normal"}, {"titleFontSize", 12}, {"labelFontSize", 11}}},
      {"title", {{"anchor", "start"}, {"fontSize", 13}, {"subtitleFontSize", 11}, {"subtitlePadding", 4}}},
      {"legend",
       {{"orient", "bottom"},
        {"offset", 6},
        {"direction", "horizontal"},
        {"titleFontWeight", "normal"},
        {"titleFontSize", 12},
        {"labelFontSize", 11},
        {"titleOrient", "left"},
        {"symbolType", "stroke"}}}};
}

}  // namespace

std::string vega_lite(const Chart& chart) {
  Json encoding = {{"x", quantitative("x", chart.x_title, {{"zero", false}, {"nice", false}})},
                   {"y", quantitative("y", chart.y_title, {{"zero", true}})}};
  add_series(chart, encoding);
  const Json spec = {{"$schema", "https://vega.github.io/schema/vega-lite/v6.json"},
                     {"description", chart.title + "; " + chart.subtitle},
                     {"title", {{"text", chart.title}, {"subtitle", chart.subtitle}}},
                     {"width", kWidth},
                     {"height", kHeight},
                     {"autosize", {{"type", "fit"}, {"contains", "padding"}}},
                     {"config", config()},
                     {"mark", mark(chart)},
                     {"encoding", encoding},
                     {"data", {{"values", rows(chart)}}}};
  return spec.dump(1) + "\n";
}

}  // namespace abbe
