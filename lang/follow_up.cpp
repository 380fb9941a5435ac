#include "lang/follow_up.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace abbe::lang {

namespace {

/// The first label of these kinds among the arguments, or nullptr.
const LabelRef* label_argument(const RawStatement& raw, std::string_view kind,
                               std::string_view other) {
  for (const RawArgument& a : raw.arguments)
    if (a.kind == RawArgument::Kind::label && (a.label.kind == kind || a.label.kind == other))
      return &a.label;
  return nullptr;
}

/// A measurement of this label cannot be relied on, if the feature is defined.
void spoil_actual(Lowering& lowering, const LabelRef* label, const std::string& reason) {
  if (!label) return;
  const auto it = lowering.symbols.features.find(upper(label->name));
  if (it != lowering.symbols.features.end()) lowering.actual(it->second) = {false, reason};
}

bool one_of(std::string_view word, std::initializer_list<std::string_view> list) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

void spoil_measurement(Lowering& lowering, const RawStatement& raw, std::string_view word,
                       const std::string& reason) {
  if (lowering.measuring) {
    if (lowering.measuring->spoilt.empty()) lowering.measuring->spoilt = reason;
  } else if (word == "MEAS") {
    OpenMeasure block;  // its PTMEAS and ENDMES are no mistakes of their own
    block.line = raw.line;
    block.span = raw.span;
    block.spoilt = reason;
    block.first_operation = lowering.out.plan.operations.size();
    lowering.measuring = block;
    spoil_actual(lowering, label_argument(raw, "F", "FA"), reason);
  }
}

}  // namespace

void follow_up(Lowering& lowering, const RawStatement& raw, std::string_view word) {
  const std::string reason = lowering.failure.starts_with("line ")
                                 ? lowering.failure
                                 : fmt::format("line {}: {}", raw.line, lowering.failure);
  if (raw.label) lowering.symbols.spoilt[spoilt_key(raw.label->kind, raw.label->name)] = reason;
  spoil_measurement(lowering, raw, word, reason);
  if (word == "CONST") spoil_actual(lowering, label_argument(raw, "F", "F"), reason);
  if (word == "DATDEF")
    if (const LabelRef* datum = label_argument(raw, "DAT", "DAT"))
      lowering.symbols.spoilt[spoilt_key("DAT", datum->name)] = reason;
  const bool recalls_frame = word == "RECALL" && label_argument(raw, "D", "DA");
  if (one_of(word, {"DATSET", "TRANS", "ROTATE"}) || recalls_frame) lowering.frame_doubt = reason;
  if (word == "UNITS") lowering.unit_doubt = reason;
  if (word == "SNSLCT") lowering.sensor_doubt = reason;
  if (one_of(word, {"OUTPUT", "EVAL"}) &&
      std::none_of(lowering.out.lost.begin(), lowering.out.lost.end(),
                   [&](const Lost& l) { return l.line == raw.line; })) {
    const LabelRef* feature = label_argument(raw, "FA", "F");
    lowering.out.lost.push_back({raw.line, feature ? feature->name : "", lowering.failure});
  }
}

}  // namespace abbe::lang
