#include "engine/report/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/utf8.hpp"

namespace abbe {

namespace {

constexpr const char *kOrange = "#D55E00", *kBlue = "#0072B2", *kBand = "#56B4E9";
constexpr double kWidth = 380, kHeight = 190, kLeft = 58, kRight = 12, kTop = 24, kBottom = 42;

/// The interval, never empty.
std::pair<double, double> opened(std::pair<double, double> r) {
  if (r.second - r.first > 1e-12 * (1 + std::abs(r.first))) return r;
  const double by = std::abs(r.first) > 0 ? 0.5 * std::abs(r.first) : 1;
  return {r.first - by, r.second + by};
}

std::vector<double> ticks(std::pair<double, double> range, int about) {
  const double raw = (range.second - range.first) / about, power = std::pow(10, std::floor(std::log10(raw)));
  const double step = raw < 1.5 * power ? power
      : raw < 3.5 * power               ? 2 * power
      : raw < 7.5 * power               ? 5 * power
                                        : 10 * power;
  std::vector<double> list;
  for (double t = std::ceil(range.first / step) * step; t <= range.second + 1e-9 * step; t += step)
    list.push_back(std::abs(t) < 1e-9 * step ? 0 : t);
  return list;
}

/// A range onto a stretch of the page.
struct Scale {
  std::pair<double, double> range;
  double from, to;
  double at(double v) const { return from + (v - range.first) / (range.second - range.first) * (to - from); }
};

std::string line(double x1, double y1, double x2, double y2, const char* style) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>", x1, y1, x2, y2, style);
}

std::string text(double x, double y, const char* anchor, std::string_view what, const char* more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" {}>{}</text>", x, y, anchor, more,
                     escaped(what));
}

constexpr std::string_view kNoCharacter = "\xEF\xBF\xBD";
constexpr const char* kGrid = "stroke=\"currentColor\" stroke-opacity=\"0.15\"";
constexpr const char* kZero = "stroke=\"currentColor\" stroke-opacity=\"0.6\"";

std::string opening(double width, double height) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" role=\"img\" "
      "font-family=\"sans-serif\" font-size=\"11\" fill=\"currentColor\">",
      width, height);
}

std::string x_axis(const Scale& x, double top, double bottom, const std::string& title) {
  std::string out;
  for (const double t : ticks(x.range, 5))
    out += line(x.at(t), top, x.at(t), bottom, t == 0 ? kZero : kGrid) +
        text(x.at(t), bottom + 14, "middle", fmt::format("{:g}", t));
  return out + text((x.from + x.to) / 2, bottom + 32, "middle", title);
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string out;
  for (std::size_t at = 0, bytes = 0; at < text.size(); at += std::max<std::size_t>(bytes, 1)) {
    bytes = utf8_character(text, at).bytes;
    if (text[at] == '&')
      out += "&amp;";
    else if (text[at] == '<')
      out += "&lt;";
    else if (text[at] == '>')
      out += "&gt;";
    else if (text[at] == '"')
      out += "&quot;";
    else
      out += bytes > 0 ? text.substr(at, bytes) : kNoCharacter;  // the name of a file may hold any byte
  }
  return out;
}

std::string svg(const Scatter& s) {
  const auto [low, high] = std::minmax_element(s.x.begin(), s.x.end());
  const Scale x{opened({*low, *high}), kLeft, kWidth - kRight}, y{opened(s.y_range), kHeight - kBottom, kTop};
  std::string out = opening(kWidth, kHeight) + text(kLeft, 14, "start", s.title, "font-weight=\"bold\"");
  for (const double t : ticks(y.range, 4))
    out += line(kLeft, y.at(t), kWidth - kRight, y.at(t), t == 0 ? kZero : kGrid) +
        text(kLeft - 6, y.at(t) + 4, "end", fmt::format("{:g}", t));
  out += x_axis(x, kTop, kHeight - kBottom, s.x_title);
  out += text(14, (kTop + kHeight - kBottom) / 2, "middle", s.y_title,
              fmt::format("transform=\"rotate(-90 14 {:.1f})\"", (kTop + kHeight - kBottom) / 2).c_str());
  out += fmt::format("<g fill=\"{}\" fill-opacity=\"0.65\">", s.second_colour ? kBlue : kOrange);
  for (std::size_t i = 0; i < s.x.size(); ++i)
    out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.2\"/>", x.at(s.x[i]),
                       y.at(std::clamp(s.y[i], y.range.first, y.range.second)));
  return out + "</g></svg>";
}

std::string svg(const Intervals& s) {
  constexpr double kNames = 250, kRow = 18, kWide = 780;
  double low = 0, high = 0;
  for (const auto& l : s.lines) low = std::min({low, l.low, l.value}), high = std::max({high, l.high, l.value});
  const double bottom = 8 + kRow * double(s.lines.size()), margin = 0.04 * (high - low);
  const Scale x{opened({low - margin, high + margin}), kNames, kWide - kRight};
  std::string out = opening(kWide, bottom + kBottom) + x_axis(x, 4, bottom, s.x_title);
  for (std::size_t k = 0; k < s.lines.size(); ++k) {
    const auto& l = s.lines[k];
    const double at = 8 + kRow * (double(k) + 0.5);
    const bool outside = l.value < l.low || l.value > l.high;
    out += text(kNames - 8, at + 4, "end", l.name);
    out +=
        fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"8\" fill=\"{}\" fill-opacity=\"0.5\"/>",
                    x.at(l.low), at - 4, x.at(l.high) - x.at(l.low), kBand);
    out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>", x.at(l.value), at,
                       outside ? kOrange : kBlue);
  }
  return out + "</svg>";
}

std::string svg(const HistogramPlot& d) {
  constexpr double kHigh = 150;
  const Histogram& h = d.histogram;
  const double reach = h.high - h.low;
  double low = std::min({0.0, h.low, d.interval.first}), high = std::max({0.0, h.high, d.interval.second});
  std::vector<double> limits;
  for (const double limit : d.limits)
    if (limit >= h.low - reach && limit <= h.high + reach)
      limits.push_back(limit), low = std::min(low, limit), high = std::max(high, limit);
  const double margin = 0.03 * (high - low), bottom = kHigh - kBottom,
               most = *std::max_element(h.counts.begin(), h.counts.end());
  const Scale x{opened({low - margin, high + margin}), kRight, kWidth - kRight}, y{{0, most}, bottom, kTop};
  std::string out = opening(kWidth, kHigh) + text(kRight, 14, "start", d.title, "font-weight=\"bold\"") +
      x_axis(x, kTop, bottom, d.x_title);
  const double width = reach > 0 ? reach / double(h.counts.size()) : (x.range.second - x.range.first) / 20;
  for (std::size_t k = 0; k < h.counts.size(); ++k) {
    const double middle = reach > 0 ? h.low + (double(k) + 0.5) * width : h.low, from = x.at(middle - width / 2);
    const bool inside = middle >= d.interval.first && middle <= d.interval.second;
    out += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\" fill-opacity=\"{}\"/>", from,
        y.at(h.counts[k]), x.at(middle + width / 2) - from, bottom - y.at(h.counts[k]), kBlue, inside ? "0.75" : "0.3");
  }
  for (const double limit : limits)
    out += line(x.at(limit), kTop, x.at(limit), bottom,
                "stroke=\"#D55E00\" stroke-width=\"1.5\" stroke-dasharray=\"5 3\"");
  return out + "</svg>";
}

}  // namespace abbe
