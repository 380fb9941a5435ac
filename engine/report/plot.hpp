// Small plots for reports in one file: inline SVG, no script and no network. Points with axes whose ticks are
// 1, 2 or 5 times a power of ten, intervals by name, and distributions. Colours are Okabe & Ito's, which
// colour-blind readers can tell apart; text takes the colour of the page.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/stats/histogram.hpp"

namespace abbe {

/// Text for HTML and SVG: & < > " as entities.
std::string escaped(std::string_view text);

struct Scatter {
  std::string title, x_title, y_title;  ///< axis titles with the unit
  std::vector<double> x, y;             ///< equally many, at least one
  std::pair<double, double> y_range;    ///< so that plots beside each other can be compared
  bool second_colour = false;
};
std::string svg(const Scatter&);

/// One line each: the interval as a bar, the value as a dot.
struct Intervals {
  struct Line {
    std::string name;
    double low = 0, high = 0, value = 0;
  };
  std::string x_title;
  std::vector<Line> lines;  ///< at least one
};
std::string svg(const Intervals&);

/// How often which value occurs: bars, those inside the interval darker, zero as a line.
struct HistogramPlot {
  std::string title, x_title;
  Histogram histogram;
  std::pair<double, double> interval;
  std::vector<double> limits;  ///< drawn as dashed lines, but for those further from the bars than these are wide
};
std::string svg(const HistogramPlot&);

}  // namespace abbe
