#include "engine/workpiece/uncertain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace abbe {

namespace {

constexpr NumberRange kDegreesOfFreedom{2, kInfinity, false, false, "greater than 2"};

struct Word {
  std::string_view word;
  Distribution distribution;
  std::string_view shape_key;  ///< the number that the distribution needs besides its width
};
constexpr Word kWords[] = {
    {"normal", Distribution::normal, ""},
    {"student_t", Distribution::student_t, "dof"},
    {"rectangular", Distribution::rectangular, ""},
    {"triangular", Distribution::triangular, ""},
    {"arcsine", Distribution::arcsine, ""},
    {"trapezoidal", Distribution::trapezoidal, "top_share"},
    {"curvilinear_trapezoid", Distribution::curvilinear_trapezoid, "inexactness"},
};

/// What JCGM 101 and other software call them too.
struct OtherName {
  std::string_view other, word;
};
constexpr OtherName kOtherNames[] = {
    {"uniform", "rectangular"}, {"gaussian", "normal"},  {"Gaussian", "normal"},
    {"u_shaped", "arcsine"},    {"U-shaped", "arcsine"}, {"t", "student_t"},
};

std::string address(std::string_view name) { return fmt::format("workpiece.{}", name); }

bool has_width(Distribution d) { return d != Distribution::normal && d != Distribution::student_t; }

/// The distribution that the object names, or the one that its other keys imply.
const Word* read_distribution(JsonObject& object) {
  if (!object.has("distribution")) {
    if (object.has("half_width")) {
      object.fault("half_width", Code::E0421, "a \"half_width\" needs a \"distribution\"",
                   "write \"distribution\": \"rectangular\" (or triangular, arcsine, trapezoidal, "
                   "curvilinear_trapezoid)");
      return nullptr;
    }
    return &kWords[object.has("dof") ? 1 : 0];
  }
  const std::string word = object.text("distribution");
  std::vector<std::string_view> words;
  for (const Word& w : kWords) {
    if (w.word == word) return &w;
    words.push_back(w.word);
  }
  const auto* other =
      std::find_if(std::begin(kOtherNames), std::end(kOtherNames), [&](const OtherName& o) { return o.other == word; });
  if (other == std::end(kOtherNames))
    object.one_of("distribution", word, words);
  else
    object.fault("distribution", Code::E0421, fmt::format("there is no distribution \"{}\" here", word),
                 fmt::format("write \"{}\"", other->word));
  return nullptr;
}

double read_shape(JsonObject& object, const Word& word) {
  if (word.shape_key.empty()) return 0;
  if (!object.has(word.shape_key)) {
    object.fault("distribution", Code::E0421,
                 fmt::format("the distribution \"{}\" needs \"{}\"", word.word, word.shape_key),
                 "docs/workpiece.md explains the keys of every distribution");
    return 0;
  }
  if (word.shape_key == "dof") return object.number("dof", kDegreesOfFreedom);
  return object.number(word.shape_key, word.shape_key == "top_share" ? kShare : kNotNegative);
}

/// `u` or `half_width`, whichever fits the distribution, as the scale of a Deviation.
double read_scale(JsonObject& object, const Word& word, double shape) {
  const bool width = object.has("half_width");
  for (const char* either : {"u", "half_width"}) object.offer(either);
  if (width == object.has("u")) {
    object.fault(
        "half_width", Code::E0421,
        width ? "\"u\" and \"half_width\" say the same thing twice" : "neither \"u\" nor \"half_width\" is given",
        "give one of them: \"u\" is a standard uncertainty, \"half_width\" half the "
        "distance between the limits");
    return 0;
  }
  if (!width) {
    const double u = object.number("u", kNotNegative);
    return has_width(word.distribution) ? half_width_for(word.distribution, shape, u) : u;
  }
  const double half_width = object.number("half_width", kNotNegative);
  if (!has_width(word.distribution))
    object.fault("half_width", Code::E0421,
                 fmt::format("the distribution \"{}\" has no limits, so no \"half_width\"", word.word),
                 "give \"u\"; from an expanded uncertainty U it is U / k");
  return half_width;
}

std::optional<Deviation> read_deviation(JsonObject& object) {
  const Word* word = read_distribution(object);
  if (!word) {  // what stands here cannot be judged without it
    for (const char* key : {"u", "half_width", "dof", "top_share", "inexactness"})
      if (object.has(key)) object.number(key);
    return std::nullopt;
  }
  Deviation d{word->distribution, 0, read_shape(object, *word)};
  d.scale = read_scale(object, *word, d.shape);
  if (d.distribution == Distribution::curvilinear_trapezoid && d.shape > d.scale)
    object.fault(
        "inexactness", Code::E0421,
        fmt::format("the inexactness {:g} of the half width is more than the half width {:.6g}", d.shape, d.scale),
        "JCGM 101, 6.4.3: the limits are known within the inexactness, so they cannot cross");
  return d;
}

}  // namespace

double Uncertain::u() const {
  double variance = 0;
  for (const Deviation& d : components) variance += standard_deviation(d) * standard_deviation(d);
  return std::sqrt(variance);
}

Uncertain operator*(double factor, const Uncertain& quantity) {
  Uncertain out = quantity;
  out.value *= factor;
  for (Deviation& d : out.components) {
    d.scale *= factor;
    if (d.distribution == Distribution::curvilinear_trapezoid) d.shape *= factor;
  }
  return out;
}

double deviation(const Uncertain& quantity, std::string_view name, DrawFor who) {
  if (quantity.exact()) return 0;
  const std::uint32_t stream = stream_of(address(name));
  double sum = 0;
  for (std::uint32_t k = 0; k < quantity.components.size(); ++k)
    sum += deviation(quantity.components[k], uniform_pair({who.seed, who.machine, stream, k, 0, 0}));
  return sum;
}

UniformPair uniform_pair_for(std::string_view name, DrawFor who) {
  return uniform_pair({who.seed, who.machine, stream_of(address(name)), 0, 0, 0});
}

Uncertain read_uncertain(JsonObject& object, std::string_view key, double otherwise, const NumberRange& range) {
  if (object.kind_of(key) != JsonNode::Kind::object) return {object.number_or(key, otherwise, range), {}};
  JsonObject written = object.object(key);
  Uncertain out{written.number("value", range), {}};
  const bool listed = written.has("components");
  const bool alone = written.has("u") || written.has("half_width") || written.has("distribution") || written.has("dof");
  if (listed && alone)
    written.fault("components", Code::E0421,
                  fmt::format("\"{}\" has \"components\" and an uncertainty of its own", key),
                  "make that uncertainty one more component");
  if (!listed && !alone) {
    for (const char* offered : {"u", "half_width", "dof", "components"}) written.offer(offered);
    written.fault("value", Code::E0421, fmt::format("\"{}\" is an object, but says nothing of an uncertainty", key),
                  "write the number alone, or add \"u\", \"half_width\" or \"components\"");
  }
  std::vector<JsonObject> components = listed ? written.object_list("components") : std::vector<JsonObject>{};
  if (components.empty() && written.kind_of("components") == JsonNode::Kind::array)
    written.fault("components", Code::E0421, fmt::format("\"{}\" lists no component of its uncertainty", key),
                  "write the number alone, or add a component, such as {\"u\": 0.5}");
  for (JsonObject& component : components)
    if (const auto d = read_deviation(component)) out.components.push_back(*d);
  if (alone)
    if (const auto d = read_deviation(written)) out.components.push_back(*d);
  const double width = range.high - range.low;
  if (std::isfinite(width) && out.u() > width)
    written.fault(
        listed ? "components" : "u", Code::E0406,
        fmt::format("the standard uncertainty of \"{}\" is {:g}, but its value must be {}", key, out.u(), range.words),
        "check the unit of the uncertainty");
  return out;
}

}  // namespace abbe
