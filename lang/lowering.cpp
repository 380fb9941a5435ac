#include "lang/lowering.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace abbe::lang {

namespace {

/// "FA" and "F" to "F", and so on for the pairs that share their names.
std::string_view base_kind(std::string_view kind) {
  for (const std::string_view pair : {"FA", "TA", "DA", "SA"})
    if (kind == pair) return pair.substr(0, 1);
  return kind;
}

std::string written(const LabelRef& label) { return fmt::format("{}({})", label.kind, label.name); }

}  // namespace

std::string spoilt_key(std::string_view kind, std::string_view name) {
  return fmt::format("{}:{}", base_kind(kind), upper(name));
}

std::string chain(std::string consequence, std::string_view cause) {
  constexpr std::string_view kArrow = " <- ", kGap = "... <- ";
  constexpr int kLongest = 4;
  int links = 1;
  std::size_t last = 0;
  for (std::size_t at = cause.find(kArrow); at != std::string_view::npos;
       at = cause.find(kArrow, last)) {
    last = at + kArrow.size();
    ++links;
  }
  const bool gap = links >= kLongest;
  return fmt::format("{}{}{}{}", consequence, kArrow, gap ? kGap : "",
                     gap ? cause.substr(last) : cause);
}

void Lowering::error(Code code, Span span, std::string message, std::string help,
                     std::string replacement) {
  fail(message);
  sink.add(diagnostic_at(source, span, code, std::move(message), std::move(help),
                         std::move(replacement)));
}

void Lowering::warn(Code code, Span span, std::string message, std::string help,
                    std::string replacement) {
  sink.add(diagnostic_at(source, span, code, std::move(message), std::move(help),
                         std::move(replacement)));
}

void Lowering::fail(std::string reason) {
  if (!failed) failure = std::move(reason);
  failed = true;
}

std::optional<Match> Lowering::match(std::string_view text, const RawStatement& raw,
                                     std::string_view what, std::size_t first) {
  auto it = signatures_.find(text);
  if (it == signatures_.end()) it = signatures_.emplace(text, parse_signature(text)).first;
  const std::span<const RawArgument> arguments = std::span(raw.arguments).subspan(first);
  auto result = lang::match(it->second, arguments, units);
  if (Match* matched = std::get_if<Match>(&result)) return std::move(*matched);
  Diagnostic d = describe(std::get<Mismatch>(result), arguments, what, first, raw.span, source);
  fail(d.message);
  sink.add(std::move(d));
  return std::nullopt;
}

std::optional<Arguments> Lowering::arguments(const Match& match) {
  Arguments values;
  for (const MatchedValue& v : match.values) {
    if (v.type == ValueType::feature || v.type == ValueType::datum) {
      const auto id = v.type == ValueType::feature ? actual_feature(v.label) : datum(v.label);
      if (id) values.add_feature(v.name, id->value);
    } else if (v.type <= ValueType::integer) {
      values.add_number(v.name, v.number);
    } else {
      values.add_text(v.name, v.text);
    }
  }
  return failed ? std::nullopt : std::optional(std::move(values));
}

template <class Map>
typename Map::mapped_type* Lowering::find(Map& map, std::string_view kind, const LabelRef& label,
                                          std::string_view next_step) {
  const auto it = map.find(upper(label.name));
  const auto spoilt = symbols.spoilt.find(spoilt_key(label.kind, label.name));
  if (spoilt != symbols.spoilt.end()) {
    fail(chain(fmt::format("{} {} is not usable", kind, written(label)), spoilt->second));
    return nullptr;
  }
  if (it != map.end()) return &it->second;
  std::vector<std::string_view> names;
  for (const auto& entry : map) names.push_back(entry.first);
  const std::string near = nearest_word(label.name, names);
  error(Code::E0201, label.span, fmt::format("{} {} is not defined above", kind, written(label)),
        near.empty() ? std::string(next_step)
                     : fmt::format("did you mean {}({})?", label.kind, near),
        near.empty() ? "" : fmt::format("{}({})", label.kind, near));
  return nullptr;
}

std::optional<plan::FeatureId> Lowering::defined_feature(const LabelRef& label) {
  const plan::FeatureId* id =
      find(symbols.features, "feature", label, "define it with F(name)=FEAT/... before this line");
  return id ? std::optional(*id) : std::nullopt;
}

std::optional<plan::FeatureId> Lowering::actual_feature(const LabelRef& label) {
  const std::optional<plan::FeatureId> id = defined_feature(label);
  if (!id) return id;
  if (!actual(*id).spoilt.empty()) {
    fail(chain(fmt::format("FA({}) is not measured", label.name), actual(*id).spoilt));
    return std::nullopt;
  }
  if (actual(*id).present) return id;
  const bool inside = measuring && measuring->feature == *id;
  error(Code::E0202, label.span,
        fmt::format("{} was not measured or constructed above", written(label)),
        inside ? "use it after ENDMES"
               : fmt::format("measure F({0}) with MEAS..ENDMES or construct it with CONST first",
                             label.name));
  return std::nullopt;
}

std::optional<plan::FeatureId> Lowering::datum(const LabelRef& label) {
  const plan::FeatureId* id =
      find(symbols.datums, "datum", label, "bind it with DATDEF/FA(feature),DAT(name)");
  return id ? std::optional(*id) : std::nullopt;
}

std::optional<plan::FrameId> Lowering::frame(const LabelRef& label) {
  const plan::FrameId* id =
      find(symbols.frames, "coordinate system", label, "define it with D(name)=DATSET/...");
  return id ? std::optional(*id) : std::nullopt;
}

std::optional<plan::SensorId> Lowering::sensor(const LabelRef& label) {
  const plan::SensorId* id =
      find(symbols.sensors, "sensor", label,
           "define it with SNSDEF, or write SA(name) for a sensor of the machine file");
  return id ? std::optional(*id) : std::nullopt;
}

void Lowering::sensor_of_machine_file(const LabelRef& label) {
  const std::string key = upper(label.name);
  if (symbols.sensors.count(key) || symbols.spoilt.count(spoilt_key(label.kind, label.name)))
    return;
  plan::SensorDef def;
  def.label = label.name;
  def.from_machine_file = true;
  def.span = label.span;
  symbols.sensors[key] = plan::SensorId{static_cast<int>(out.plan.sensors.size())};
  out.plan.sensors.push_back(std::move(def));
}

ToleranceSymbol* Lowering::tolerance(const LabelRef& label) {
  return find(symbols.tolerances, "tolerance", label,
              "define it with T(name)=TOL/... before this line");
}

void Lowering::emit(plan::Action action) {
  out.plan.operations.push_back({std::move(action), statement->span, statement->line});
}

plan::FrameId Lowering::new_frame(const RawStatement& raw) {
  const plan::FrameId id{static_cast<int>(out.plan.frames.size())};
  out.plan.frames.push_back({raw.label->name, raw.span});
  symbols.frames[upper(raw.label->name)] = id;
  return id;
}

plan::Point Lowering::point(const Match& match, std::string_view first) {
  const auto it = std::find_if(match.values.begin(), match.values.end(),
                               [&](const MatchedValue& v) { return v.name == first; });
  ABBE_CHECK(match.values.end() - it >= 3);
  return {operand(it[0]), operand(it[1]), operand(it[2])};
}

std::string Lowering::blame() const {
  return fmt::format("line {}: {}", statement->line, failure);
}

std::string Lowering::doubt() const {
  if (!unit_doubt.empty()) return chain("the units are in doubt", unit_doubt);
  if (!frame_doubt.empty()) return chain("the coordinate system is in doubt", frame_doubt);
  return sensor_doubt.empty() ? "" : chain("the sensor is in doubt", sensor_doubt);
}

}  // namespace abbe::lang
