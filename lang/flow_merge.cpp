// What holds where two paths meet.
#include <algorithm>

#include "engine/features/feature.hpp"
#include "lang/flow.hpp"

namespace abbe::lang {

namespace {

/// Labels of either path; one that means different things on them is ambiguous from here on.
template <class Symbol, class Meaning>
void merge_labels(Symbols::Labels<Symbol>& into, const Symbols::Labels<Symbol>& other, std::string_view kind,
                  Symbols& symbols, Meaning meaning) {
  const Symbols::Labels<Symbol> ours = into;
  ours.differences(other, [&](const std::string& name, const Symbol* mine, const Symbol& theirs) {
    if (!mine)
      into.set(name, theirs);
    else if (meaning(*mine) != meaning(theirs))
      symbols.ambiguous.insert(spoilt_key(kind, name));
  });
}

void merge_actuals(SharedMap<int, ActualState>& into, const SharedMap<int, ActualState>& other) {
  const SharedMap<int, ActualState> ours = into;
  ours.differences(other, [&](int feature, const ActualState* mine, const ActualState& theirs) {
    ActualState both = mine ? *mine : ActualState{};
    both.present |= theirs.present;
    if (both.spoilt.empty()) both.spoilt = theirs.spoilt;
    into.set(feature, both);
  });
}

void merge_symbols(Symbols& into, const Symbols& other) {
  const auto id = [](const auto& v) { return v.value; };
  merge_labels(into.features, other.features, "F", into, id);
  merge_labels(into.datums, other.datums, "DAT", into, id);
  merge_labels(into.frames, other.frames, "D", into, id);
  merge_labels(into.sensors, other.sensors, "S", into, id);
  merge_labels(into.tolerances, other.tolerances, "T", into, [](const ToleranceSymbol& t) { return t.instances; });
  const Symbols::Labels<std::string> spoilt = into.spoilt;
  spoilt.differences(other.spoilt, [&](const std::string& name, const std::string* mine, const std::string& reason) {
    if (!mine) into.spoilt.set(name, reason);
  });
  into.ambiguous.insert(other.ambiguous.begin(), other.ambiguous.end());
}

template <class T>
void merge_setting(Setting<T>& into, const Setting<T>& other) {
  into.varies |= other.varies || into.value != other.value;
  into.carried |= other.carried;
  into.relied_on = std::max(into.relied_on, other.relied_on);
}

/// A tolerance of size that was evaluated last on one path only is not that of all machines.
void merge_sizes(SharedMap<int, plan::ToleranceId>& into, const SharedMap<int, plan::ToleranceId>& other) {
  const SharedMap<int, plan::ToleranceId> ours = into;
  other.differences(ours, [&](int feature, const plan::ToleranceId* theirs, const plan::ToleranceId& mine) {
    if (!theirs || theirs->value != mine.value) into.erase(feature);
  });
}

}  // namespace

void merge(State& into, const State& other) {
  if (!other.reachable) return;
  if (!into.reachable) {
    into = other;
    return;
  }
  merge_symbols(into.symbols, other.symbols);
  merge_actuals(into.actuals, other.actuals);
  if (into.measuring && other.measuring) {
    if (into.measuring->spoilt.empty()) into.measuring->spoilt = other.measuring->spoilt;
    into.measuring->touches = std::max(into.measuring->touches, other.measuring->touches);
  }
  merge_sizes(into.size_of, other.size_of);
  merge_setting(into.mount, other.mount);
  merge_setting(into.machine_chooses, other.machine_chooses);
  for (const FeatureKind* kind : feature_kinds()) {
    const auto theirs = other.criteria.find(kind->shape);
    merge_setting(into.criteria[kind->shape],
                  theirs == other.criteria.end() ? Setting<FitCriterion>{} : theirs->second);
  }
  into.sensor_selected |= other.sensor_selected;
  into.home_known |= other.home_known;
  for (const auto doubt : {&State::frame_doubt, &State::unit_doubt, &State::sensor_doubt, &State::flow_doubt})
    if ((into.*doubt).empty()) into.*doubt = other.*doubt;
  into.setting_doubts.insert(other.setting_doubts.begin(), other.setting_doubts.end());
  const SharedMap<std::string, std::string> settings = into.settings;
  other.settings.differences(settings,
                             [&](const std::string& word, const std::string* theirs, const std::string& ours) {
                               if (!theirs || *theirs != ours) into.settings.erase(word);
                             });
  merge(into.variables, other.variables);
}

void carry_settings(State& state) {
  state.mount.carried = state.machine_chooses.carried = true;
  for (const FeatureKind* kind : feature_kinds()) state.criteria[kind->shape].carried = true;
}

}  // namespace abbe::lang
