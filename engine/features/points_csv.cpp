#include "engine/features/points_csv.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

namespace abbe {
namespace {

constexpr std::size_t kMostMessages = 10;

/// A piece of a line and where it starts in the file.
struct Field {
  std::string_view text;
  std::uint32_t begin = 0;
  Span span() const { return {begin, begin + static_cast<std::uint32_t>(std::max<std::size_t>(text.size(), 1))}; }
};

Field trimmed(Field f) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!f.text.empty() && blank(f.text.front())) f.text.remove_prefix(1), ++f.begin;
  while (!f.text.empty() && blank(f.text.back())) f.text.remove_suffix(1);
  return f;
}

Field line_of(const SourceFile& file, int line) { return trimmed({file.line(line), file.line_begin(line)}); }

std::vector<Field> split(const Field& line) {
  std::vector<Field> fields;
  std::size_t from = 0;
  for (std::size_t i = 0; i <= line.text.size(); ++i) {
    if (i < line.text.size() && line.text[i] != ',') continue;
    fields.push_back(trimmed({line.text.substr(from, i - from), line.begin + static_cast<std::uint32_t>(from)}));
    from = i + 1;
  }
  return fields;
}

std::string quoted(std::string_view text) {
  std::string q = "'";
  return q.append(text).append("'");
}

/// Takes nan and inf, as finite_number() does not: the fit refuses them in its own words (not_finite, E0505).
std::optional<double> number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

void check_header(const SourceFile& file) {
  Field line = line_of(file, 1);
  if (line.text.starts_with(kByteOrderMark))
    line = trimmed(
        {line.text.substr(kByteOrderMark.size()), line.begin + static_cast<std::uint32_t>(kByteOrderMark.size())});
  std::string names;
  for (const Field& field : split(line)) names.append(field.text).push_back(',');
  if (names == "x,y,z," || names == "X,Y,Z,") return;
  throw UserError(
      diagnostic_at(file, line.span(), Code::E0501, "the first line is " + quoted(line.text) + ", not 'x,y,z'",
                    "write the header x,y,z and one point a line, in mm, with commas between the values", "x,y,z"));
}

/// The point of one line, or a message in `sink`.
std::optional<Vec3> point_of(const SourceFile& file, const Field& line, Sink& sink) {
  const std::vector<Field> fields = split(line);
  if (fields.size() != 3) {
    sink.add(diagnostic_at(file, line.span(), Code::E0502,
                           line.text.empty() ? std::string("a blank line between the points")
                                             : std::to_string(fields.size()) + " values where x,y,z are expected",
                           "write three numbers with commas between them and points as decimal marks"));
    return std::nullopt;
  }
  Vec3 point;
  bool good = true;
  for (int k = 0; k < 3; ++k) {
    const std::optional<double> value = number(fields[k].text);
    point[k] = value.value_or(0);
    if (value) continue;
    good = false;
    sink.add(diagnostic_at(file, fields[k].span(), Code::E0503,
                           quoted(fields[k].text) + " is not a number that a double can hold",
                           "write numbers like 12.5 or -3.2e-4"));
  }
  return good ? std::optional(point) : std::nullopt;
}

}  // namespace

std::vector<Vec3> points_from_csv(const SourceFile& file) {
  check_header(file);
  int last = file.line_count();
  while (last > 1 && line_of(file, last).text.empty()) --last;
  std::vector<Vec3> points;
  Sink sink;
  for (int line = 2; line <= last && sink.list().size() < kMostMessages; ++line)
    if (const auto point = point_of(file, line_of(file, line), sink)) points.push_back(*point);
  if (sink.has_errors()) throw UserError(sink.list());
  return points;
}

}  // namespace abbe
