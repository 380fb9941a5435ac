#include "engine/diagnose/words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace abbe {

namespace {

/// The name without its unit: "seat radius" of "seat_radius_mm", "sag per 500kg" of "sag_um_per_500kg".
std::string plain_name(const DiagnosedParameter& p) {
  const std::size_t per = p.unit.find('/');
  const std::string unit = "_" + p.unit.substr(0, per);
  std::string name = p.name;
  const std::size_t at = name.rfind(unit), after = at + unit.size();
  if (at != std::string::npos && (after == name.size() || name[after] == '_'))
    name = name.substr(0, at) + (per == std::string::npos ? name.substr(after) : "");
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string unit_after(const DiagnosedParameter& p) {
  return p.unit.empty() || p.unit == "1" || p.unit == "code" ? "" : " " + p.unit;
}

/// Decimals that show two significant digits of an uncertainty.
int decimals_for(double uncertainty, double value) {
  constexpr int kMost = 9;
  const double least = uncertainty > 0 && std::isfinite(uncertainty) ? uncertainty / 10 : std::abs(value) / 100;
  return least > 0 ? std::clamp(static_cast<int>(-std::floor(std::log10(least) + 1e-9)), 0, kMost) : 0;
}

/// " (or y)" of a value that is not the only one left: the two likeliest others, and how many more.
std::string or_others(const DiagnosedParameter& p) {
  constexpr std::size_t kTold = 2;
  if (p.others.empty()) return "";
  std::vector<std::string> told;
  for (const OtherValue& v : p.others)
    if (told.size() < kTold) told.push_back(v.value);
  if (p.others.size() > kTold) told.push_back(fmt::format("{} more", p.others.size() - kTold));
  return fmt::format(" (or {})", fmt::join(told, ", "));
}

std::string without_uncertainty(const DiagnosedParameter& p, int decimals) {
  const std::string value =
      p.called.empty() ? fmt::format("{:.{}f}{}", p.value, p.unit == "code" ? 0 : decimals, unit_after(p)) : p.called;
  return plain_name(p) + " " + value + or_others(p);
}

std::string remark(const DiagnosedParameter& p) { return p.called.empty() ? "" : " (" + p.called + ")"; }

/// "new in run 2 and gone in run 3"
std::string in_words(const RunChange& change) {
  std::vector<std::string> ends;
  if (change.from > 0) ends.push_back(fmt::format("new in run {}", change.from));
  if (change.until > 0) ends.push_back(fmt::format("gone in run {}", change.until));
  return fmt::format("{}", fmt::join(ends, " and "));
}

/// Whether the 95 % interval is far from the value plus and minus two standard uncertainties, as that of a time constant is.
bool lopsided(const DiagnosedParameter& p) {
  constexpr double kShort = 1;  // standard uncertainties
  return std::min(p.value - p.low, p.high - p.value) < kShort * p.u;
}

std::string in_word(const DiagnosedParameter& p) { return plain_name(p) + " " + p.word + or_others(p) + remark(p); }

}  // namespace

std::string capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string with_uncertainty(const DiagnosedParameter& p) {
  if (!p.word.empty()) return in_word(p);
  const int decimals = decimals_for(2 * p.u, p.value);
  if (p.u == 0) return without_uncertainty(p, decimals);
  if (lopsided(p))
    return fmt::format("{} {:.{}f}{} ({:.{}f} to {:.{}f}){}", plain_name(p), p.value, decimals, unit_after(p), p.low,
                       decimals, p.high, decimals, remark(p));
  return fmt::format("{} {:.{}f} ± {:.{}f}{}{}", plain_name(p), p.value, decimals, 2 * p.u, decimals, unit_after(p),
                     remark(p));
}

std::string with_interval(const DiagnosedParameter& p) {
  if (!p.word.empty()) return in_word(p);
  const int decimals = decimals_for(2 * p.u, p.value);
  if (p.u == 0 && p.low == p.high) return without_uncertainty(p, decimals);
  return fmt::format("{} {:.{}f}{} ({:.{}f} to {:.{}f}){}{}", plain_name(p), p.value, decimals, unit_after(p), p.low,
                     decimals, p.high, decimals, remark(p), p.plausible ? "" : ", implausible");
}

std::string explanation_sentence(const std::vector<std::string_view>& titles,
                                 const std::vector<DiagnosedParameter>& parameters, std::string_view data,
                                 RunChange change, bool doubted, bool beside) {
  std::vector<std::string> sizes;
  for (const DiagnosedParameter& p : parameters) sizes.push_back(with_uncertainty(p));
  const std::string told = sizes.empty() ? "" : fmt::format("{}", fmt::join(sizes, ", "));
  const std::string it = change.any() ? "what is " + in_words(change) : beside ? "what that leaves" : "it";
  if (titles.size() == 1)
    return fmt::format("{} {} {}{}{}.", capitalised(it), doubted ? "looks like" : "is explained by", titles.front(),
                       told.empty() ? "" : ": ", told);
  return fmt::format("One of these {} {}, and {} cannot tell which: {}.{}{}{}", doubted ? "may explain" : "explains",
                     it, data, fmt::join(titles, "; "), told.empty() ? "" : " As the first: ", told,
                     told.empty() ? "" : ".");
}

std::string two_digits(double value) {
  if (value == 0) return "0";
  const auto place = [](double of) { return static_cast<int>(std::floor(std::log10(std::abs(of)))); };
  const double step = std::pow(10, place(value) - 1), rounded = step * std::round(value / step);
  return fmt::format("{:.{}f}", rounded, std::max(0, 1 - place(rounded)));
}

std::string sizes_in_words(const std::vector<DiagnosedParameter>& parameters, std::optional<double> largest_um) {
  std::vector<std::string> sizes;
  for (const DiagnosedParameter& p : parameters) sizes.push_back(with_interval(p));
  if (largest_um) sizes.push_back(fmt::format("at most {} um at a touch", two_digits(*largest_um)));
  return fmt::format("{}", fmt::join(sizes, "; "));
}

std::string amplitude_in_words(const Unexplained& u) {
  return fmt::format("{} um rms ({} to {}){}", two_digits(u.amplitude_um), two_digits(u.low_um), two_digits(u.high_um),
                     u.largest_um ? fmt::format("; at most {} um at a touch", two_digits(*u.largest_um)) : "");
}

std::vector<std::string> in_words(const DiagnosedEffect& e) {
  std::vector<std::string> names = e.members;
  for (std::size_t m = 0; m < e.change.size(); ++m)
    if (e.change[m].any()) names[m] += ", " + in_words(e.change[m]);
  return names;
}

std::string in_words(const Detectable& d) {
  if (d.scatter && d.unit == "1") return fmt::format("{} ({} {:.2g})", d.effect, d.parameter, d.detect);
  return d.effect + (d.only_new ? ", if new in a run" : "");
}

std::string form_in_words(const Detectable& d) {
  std::vector<std::string> values;
  for (const DiagnosedParameter& p : d.form) values.push_back(with_uncertainty(p));
  return fmt::format("{}", fmt::join(values, ", "));
}

std::string why_not_judged(const CannotJudge& c, bool touches) {
  if (c.missing.empty())
    return touches ? "does nothing to these touches, or is hidden by what is unknown of the part or by their scatter"
                   : "nothing of it shows in values";
  std::vector<std::string> missing = c.missing;
  for (const auto* logged : {&c.constant, &c.too_few})
    for (const std::string& column : *logged) std::erase(missing, column);
  std::vector<std::string> why;
  if (!missing.empty()) why.push_back(fmt::format("missing: {}", fmt::join(missing, ", ")));
  if (!c.constant.empty()) why.push_back(fmt::format("the same throughout: {}", fmt::join(c.constant, ", ")));
  if (!c.too_few.empty()) why.push_back(fmt::format("{}: {}", c.too_few_of, fmt::join(c.too_few, ", ")));
  return fmt::format("{}", fmt::join(why, "; "));
}

std::string p_in_words(const JudgedValue& v) { return fmt::format("{}{:.3f}", v.beyond_all ? "<" : "", v.p); }

std::string looks_like(const Detectable& d) {
  if (!d.name_um && d.confounded_with.empty()) return "a pattern without a name";
  return fmt::format("{}", fmt::join(d.confounded_with, ", "));
}

Headline headline(const Diagnosis& d) {
  if (d.judged == Judged::plan) return Headline::plan;
  if (d.judged != Judged::yes) return Headline::nothing_judged;
  if (d.verdict == Verdict::no_mismatch && d.beyond) return Headline::beyond_specification;
  return d.beyond_known ? Headline::another_machine : Headline::verdict;
}

bool doubtful(const Diagnosis& d) { return d.adequacy_p && *d.adequacy_p < kInadequate && !d.unexplained; }

std::string located_in_words(const Diagnosis& d) {
  constexpr double kNearlyAsWell = 0.85;
  if (d.location.empty()) return "";
  const Location& first = d.location.front();
  std::vector<std::string> where, others;
  for (const auto& [key, value] : first.where) where.push_back(key + " " + value);
  for (std::size_t k = 1; d.unexplained && k < d.location.size(); ++k)
    if (d.location[k].share >= kNearlyAsWell * first.share) others.push_back(d.location[k].factor);
  return fmt::format("located in {}{}{}{}{}", first.factor, where.empty() ? "" : "; strongest at ",
                     fmt::join(where, ", "), others.empty() ? "" : "; nearly as well in ",
                     fmt::join(others, " or in "));
}

}  // namespace abbe
