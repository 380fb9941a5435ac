#include "engine/run/alignment_features.hpp"

namespace abbe {

namespace {

/// The features that an operation takes its coordinate system from.
std::vector<plan::FeatureId> operands(const plan::Action& action) {
  std::vector<plan::FeatureId> list;
  if (const auto* set = std::get_if<plan::SetDatumFrame>(&action)) {
    for (const plan::DatumRef& datum : set->datums) list.push_back(datum.feature);
  } else if (const auto* translate = std::get_if<plan::TranslateFrame>(&action)) {
    for (const plan::OriginShift& shift : translate->shifts)
      if (shift.from.valid()) list.push_back(shift.from);
  } else if (const auto* rotate = std::get_if<plan::RotateFrame>(&action)) {
    if (rotate->to.valid()) list.push_back(rotate->to);
  }
  return list;
}

}  // namespace

std::vector<char> alignment_features(const plan::Plan& plan) {
  std::vector<char> found(plan.features.size(), 0);
  for (const plan::Operation& op : plan.operations)
    for (const plan::FeatureId feature : operands(op.action)) found[feature.value] = 1;
  // Jumps allow a construction to stand after its use, so the search goes on until nothing is new.
  for (bool grown = true; grown;) {
    grown = false;
    for (const plan::Operation& op : plan.operations) {
      const auto* construct = std::get_if<plan::Construct>(&op.action);
      if (!construct || !found[construct->result.value]) continue;
      for (const plan::FeatureId from : construct->from) {
        grown |= !found[from.value];
        found[from.value] = 1;
      }
    }
  }
  return found;
}

}  // namespace abbe
