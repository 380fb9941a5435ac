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

bool one_of(std::string_view word, std::initializer_list<std::string_view> list) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

void spoil_measurement(Lowering& lowering, const RawStatement& raw, std::string_view word, const std::string& reason) {
  if (lowering.measuring) {
    if (lowering.measuring->spoilt.empty()) lowering.measuring->spoilt = reason;
  } else if (one_of(word, {"MEAS", "RMEAS", "CALIB"})) {
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

/// Words that say how touches are made, compensated and fitted; the first argument of some says what of
/// several things they set.
bool is_setting(std::string_view word) {
  return one_of(word, {"PRCOMP", "TECOMP", "FLY", "MODE", "SNSMNT", "SNSET", "FEDRAT", "ACLRAT", "GEOALG"});
}
std::string setting_of(const RawStatement& raw, std::string_view word) {
  const bool several = one_of(word, {"SNSET", "FEDRAT", "ACLRAT", "GEOALG"}) && !raw.arguments.empty();
  return several ? fmt::format("{}/{}", word, upper(raw.arguments.front().text)) : std::string(word);
}

/// Words that decide which statements run: without this one, what follows may not be run, or something else before it.
bool decides(std::string_view word) {
  const Statement* statement = find_statement(word);
  return word == "DMESW" || (statement && statement->control != Control::none);
}

}  // namespace

void settle(Lowering& lowering, const RawStatement& raw) {
  const std::string setting = setting_of(raw, raw.word);
  const bool all = setting == "GEOALG/ALL";
  std::erase_if(lowering.setting_doubts, [&](const auto& doubt) {
    return doubt.first == setting || (all && doubt.first.starts_with("GEOALG"));
  });
}

void follow_up(Lowering& lowering, const RawStatement& raw, std::string_view word) {
  const std::string reason = lowering.blame();
  if (raw.label) lowering.symbols.spoilt.set(spoilt_key(raw.label->kind, raw.label->name), reason);
  spoil_measurement(lowering, raw, word, reason);
  if (word == "CONST") spoil_actual(lowering, label_argument(lowering, raw, "F", "F"), reason);
  if (word == "DATDEF")
    if (const auto datum = label_argument(lowering, raw, "DAT", "DAT"))
      lowering.symbols.spoilt.set(spoilt_key("DAT", *datum), reason);
  const bool recalls_frame = word == "RECALL" && label_argument(lowering, raw, "D", "DA");
  if (one_of(word, {"DATSET", "TRANS", "ROTATE"}) || recalls_frame) lowering.frame_doubt = reason;
  if (word == "UNITS") lowering.unit_doubt = reason;
  const bool selects = word == "SNSLCT" || (word == "CALIB" && label_argument(lowering, raw, "S", "SA"));
  if (selects) lowering.sensor_doubt = reason;
  if (is_setting(word)) lowering.setting_doubts.emplace(setting_of(raw, word), reason);
  if (decides(word) && lowering.flow_doubt.empty()) lowering.flow_doubt = reason;
  const int line = lowering.here().second;
  if (one_of(word, {"OUTPUT", "EVAL"}) &&
      std::none_of(lowering.out.lost.begin(), lowering.out.lost.end(), [&](const Lost& l) { return l.line == line; })) {
    lowering.out.lost.push_back({line, label_argument(lowering, raw, "FA", "F").value_or(""), lowering.failure});
  }
}

}  // namespace abbe::lang
