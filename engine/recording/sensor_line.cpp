#include "engine/recording/sensor_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <sstream>

#include "engine/base/limits.hpp"
#include "engine/base/numbers.hpp"

namespace abbe {

namespace {

/// A word of a sensor line and the numbers behind it, as in a machine file.
struct SensorWord {
  std::string_view name;
  std::size_t count;
  NumberRange range = kAnyNumber;
  bool required = false;
};
constexpr SensorWord kSensorWords[] = {{"head_deg", 2, kTurn_deg},           {"tip_in_r_mm", 3, kCoordinate_mm, true},
                                       {"diameter_mm", 1, kLength_mm, true}, {"shaft_diameter_mm", 1, kPositive},
                                       {"young_GPa", 1, kYoung_GPa},         {"cte_ppm_per_K", 1, kCte_ppm_per_K}};

/// Reads a word with its numbers. Returns the mistake in it, or "".
std::string read_word(const std::string& name, std::istream& in, SensorLine& line) {
  const auto* const word = std::find_if(std::begin(kSensorWords), std::end(kSensorWords),
                                        [&](const SensorWord& w) { return w.name == name; });
  if (word == std::end(kSensorWords)) return fmt::format("'{}' stands where one of its words is expected", name);
  std::vector<double> numbers;
  for (std::string text; numbers.size() < word->count && in >> text;) {
    const std::optional<double> number = finite_number(text);
    if (!number || !word->range.holds(*number))
      return fmt::format("'{}' of {} must be {}", text, name, word->range.words);
    numbers.push_back(*number);
  }
  if (numbers.size() < word->count) return fmt::format("{} has {} of {} numbers", name, numbers.size(), word->count);
  return line.numbers.emplace(word->name, std::move(numbers)).second ? "" : fmt::format("{} stands there twice", name);
}

}  // namespace

std::vector<double> SensorLine::numbers_or(std::string_view word, std::vector<double> otherwise) const {
  const auto found = numbers.find(word);
  return found == numbers.end() ? otherwise : found->second;
}

SensorLine read_sensor_line(const std::string& value) {
  SensorLine line;
  std::istringstream in(value);
  for (std::string name; line.mistake.empty() && in >> name;) line.mistake = read_word(name, in, line);
  if (!line.mistake.empty()) return line;
  for (const SensorWord& word : kSensorWords)
    if (word.required && !line.numbers.contains(word.name)) {
      line.mistake = fmt::format("{} is missing", word.name);
      return line;
    }
  if (line.number_or("shaft_diameter_mm", 0) > line.number_or("diameter_mm", 0))
    line.mistake = "the shaft is thicker than the ball";
  return line;
}

}  // namespace abbe
