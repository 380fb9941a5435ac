// A chart as plain data, and its specification in Vega-Lite v6 (https://vega.github.io/vega-lite/):
// JSON with the data inlined, so that one text is the whole figure. `docs/figures/render.mjs` draws
// it as SVG; any Vega-Lite viewer shows it.
//
// The style is settled here, once for all figures: 480 x 260 pixels, at most a few lines, told
// apart by colour and dashes (Okabe & Ito's palette, which colour-blind readers can read), axis
// titles with units, a stronger line at zero. Numbers are rounded to kDecimals, which is finer than
// a pixel, so that the text does not depend on the last bits of a mathematical library.
#pragma once

#include <string>
#include <vector>

namespace abbe {

/// Decimals of the numbers in a specification: 0.1 nm where the axis is in um.
inline constexpr int kDecimals = 4;

struct Chart {
  enum class Mark { lines, points };
  struct Series {
    std::string name;          ///< what the legend says; may be empty when there is one series
    std::vector<double> x, y;  ///< equally many, in the units that the axis titles name
  };
  std::string title, subtitle;
  std::string x_title, y_title;  ///< with the unit: "time, min"
  std::string series_title;      ///< what the series differ in
  Mark mark = Mark::lines;
  std::vector<Series> series;
};

/// The specification, a JSON text that ends with a newline.
std::string vega_lite(const Chart&);

}  // namespace abbe
