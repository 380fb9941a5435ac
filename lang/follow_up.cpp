#include "lang/follow_up.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace abbe::lang {

namespace {

/// The name of the first label of these kinds after the statement's word, or nothing. Read off the
/// text, because a statement with an error may have no arguments, or two in one.
std::optional<std::string> label_argument(const Lowering& lowering, const RawStatement& raw,
                                          std::string_view kind, std::string_view other) {
  const std::string_view text =
      lowering.file->text({raw.word_span.end, std::max(raw.word_span.end, raw.span.end)});
  constexpr std::string_view kEnds = "/=,( \t";
  for (std::size_t open = text.find('('); open != std::string_view::npos;
       open = text.find('(', open + 1)) {
    const std::size_t before = text.find_last_of(kEnds, open == 0 ? 0 : open - 1);
    const std::size_t begin = before == std::string_view::npos ? 0 : before + 1;
    const std::string found = upper(text.substr(begin, open - begin));
    if (found != kind && found != other) continue;
    return std::string(text.substr(open + 1, text.find_first_of("),\r\n", open) - open - 1));
  }
  return std::nullopt;
}

/// A measurement of this label cannot be relied on, if the feature is defined.
void spoil_actual(Lowering& lowering, const std::optional<std::string>& label,
                  const std::string& reason) {
  if (!label) return;
  if (const plan::FeatureId* feature = lowering.symbols.features.find(upper(*label)))
    lowering.actuals.set(feature->value, {false, reason});
}

bool one_of(std::string_view word, std::initializer_list<std::string_view> list) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

void spoil_measurement(Lowering& lowering, const RawStatement& raw, std::string_view word,
                       const std::string& reason) {
  if (lowering.measuring) {
    if (lowering.measuring->spoilt.empty()) lowering.measuring->spoilt = reason;
  } else if (one_of(word, {"MEAS", "RMEAS", "CALIB"})) {
    OpenMeasure block;  // its PTMEAS and ENDMES are no mistakes of their own
    block.line = raw.line;
    block.span = raw.span;
    block.spoilt = reason;
    block.first_operation = lowering.out.plan.operations.size();
    lowering.measuring = block;
    spoil_actual(lowering, label_argument(lowering, raw, "F", "FA"), reason);
  }
}

}  // namespace

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
  if (word == "SNSLCT") lowering.sensor_doubt = reason;
  if (one_of(word, {"OUTPUT", "EVAL"}) &&
      std::none_of(lowering.out.lost.begin(), lowering.out.lost.end(),
                   [&](const Lost& l) { return l.line == raw.line; })) {
    lowering.out.lost.push_back(
        {raw.line, label_argument(lowering, raw, "FA", "F").value_or(""), lowering.failure});
  }
}

}  // namespace abbe::lang
