#include "lang/follow_up.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "lang/statement.hpp"

namespace abbe::lang {

namespace {

/// The name of the first label of these kinds after the statement's word, or nothing. Read off the
/// text, because a statement with an error may have no arguments, or two in one.
std::optional<std::string> label_argument(const Lowering& lowering, const RawStatement& raw, std::string_view kind,
                                          std::string_view other) {
  const std::string_view text = lowering.file->text({raw.word_span.end, std::max(raw.word_span.end, raw.span.end)});
  constexpr std::string_view kEnds = "/=,( \t";
  for (std::size_t open = text.find('('); open != std::string_view::npos; open = text.find('(', open + 1)) {
    const std::size_t before = text.find_last_of(kEnds, open == 0 ? 0 : open - 1);
    const std::size_t begin = before == std::string_view::npos ? 0 : before + 1;
    const std::string found = upper(text.substr(begin, open - begin));
    if (found != kind && found != other) continue;
    return std::string(text.substr(open + 1, text.find_first_of("),\r\n", open) - open - 1));
  }
  return std::nullopt;
}

/// A measurement of this label cannot be relied on, if the feature is defined.
void spoil_actual(Lowering& lowering, const std::optional<std::string>& label, const std::string& reason) {
  if (!label) return;
  if (const plan::FeatureId* feature = lowering.symbols.features.find(upper(*label)))
    lowering.actuals.set(feature->value, {false, reason});
}

void spoil_measurement(Lowering& lowering, const RawStatement& raw, Doubt doubt, const std::string& reason) {
  if (lowering.measuring) {
    if (lowering.measuring->spoilt.empty()) lowering.measuring->spoilt = reason;
  } else if (doubt == Doubt::measurement) {
    OpenMeasure block;  // its PTMEAS and ENDMES are no mistakes of their own
    block.line = raw.line;
    block.span = raw.span;
    block.place = lowering.here().first;
    block.spoilt = reason;
    block.first_operation = lowering.out.plan.operations.size();
    lowering.measuring = block;
    spoil_actual(lowering, label_argument(lowering, raw, "F", "FA"), reason);
  }
}

void lose_characteristic(Lowering& lowering, const RawStatement& raw) {
  const int line = lowering.here().second;
  std::vector<Lost>& lost = lowering.out.lost;
  if (std::any_of(lost.begin(), lost.end(), [&](const Lost& l) { return l.line == line; })) return;
  lost.push_back({line, label_argument(lowering, raw, "FA", "F").value_or(""), lowering.failure});
}

std::string setting_of(const RawStatement& raw, const Statement& statement) {
  const bool several = statement.doubt == Doubt::one_setting && !raw.arguments.empty();
  return several ? fmt::format("{}/{}", statement.word, upper(raw.arguments.front().text))
                 : std::string(statement.word);
}

}  // namespace

bool sets_frame(const RawStatement& raw) {
  constexpr std::string_view kWords[] = {"LOCATE", "ITERAT", "EQUATE", "CRSLCT", "POP"};
  return std::find(std::begin(kWords), std::end(kWords), raw.word) != std::end(kWords);
}

void settle(Lowering& lowering, const RawStatement& raw) {
  const Statement* statement = find_statement(raw.word);
  if (!statement) return;
  const std::string setting = setting_of(raw, *statement);
  const std::string all_of_them = setting.ends_with("/ALL") ? setting.substr(0, setting.size() - 3) : setting;
  std::erase_if(lowering.setting_doubts, [&](const auto& doubt) {
    return doubt.first == setting || (all_of_them != setting && doubt.first.starts_with(all_of_them));
  });
}

void follow_up(Lowering& lowering, const RawStatement& raw, std::string_view word) {
  const std::string reason = lowering.blame();
  if (raw.label) lowering.symbols.spoilt.set(spoilt_key(raw.label->kind, raw.label->name), reason);
  if (raw.word == "EQUATE")  // moves a coordinate system that has a label, not only the current one
    for (const RawArgument& a : raw.arguments)
      if (a.kind == RawArgument::Kind::label)
        lowering.symbols.spoilt.set(spoilt_key(a.label.kind, a.label.name), reason);
  const Statement* statement = find_statement(word);
  const Doubt doubt = statement ? statement->doubt : sets_frame(raw) ? Doubt::frame : Doubt::none;
  spoil_measurement(lowering, raw, doubt, reason);
  const bool decides = doubt == Doubt::course || (statement && statement->control != Control::none);
  if (decides && lowering.flow_doubt.empty()) lowering.flow_doubt = reason;
  switch (doubt) {
    case Doubt::none:
    case Doubt::course: break;
    case Doubt::measurement:
      if (label_argument(lowering, raw, "S", "SA")) lowering.sensor_doubt = reason;
      break;
    case Doubt::construction: spoil_actual(lowering, label_argument(lowering, raw, "F", "F"), reason); break;
    case Doubt::datum:
      if (const auto datum = label_argument(lowering, raw, "DAT", "DAT"))
        lowering.symbols.spoilt.set(spoilt_key("DAT", *datum), reason);
      break;
    case Doubt::recall:
      if (label_argument(lowering, raw, "D", "DA")) lowering.frame_doubt = reason;
      break;
    case Doubt::frame: lowering.frame_doubt = reason; break;
    case Doubt::units: lowering.unit_doubt = reason; break;
    case Doubt::sensor: lowering.sensor_doubt = reason; break;
    case Doubt::setting:
    case Doubt::one_setting: lowering.setting_doubts.emplace(setting_of(raw, *statement), reason); break;
    case Doubt::characteristic: lose_characteristic(lowering, raw); break;
  }
}

}  // namespace abbe::lang
