// What holds where two paths meet.
#include <algorithm>

#include "lang/flow.hpp"

namespace abbe::lang {

namespace {

/// Labels of either path; one that means different things on them is ambiguous from here on.
template <class Map, class Meaning>
void merge_labels(Map& into, const Map& other, std::string_view kind, Symbols& symbols, Meaning meaning) {
  for (const auto& [name, theirs] : other) {
    const auto [mine, is_new] = into.emplace(name, theirs);
    if (!is_new && meaning(mine->second) != meaning(theirs)) symbols.ambiguous.insert(spoilt_key(kind, name));
  }
}

void merge_symbols(Symbols& into, const Symbols& other) {
  const auto id = [](const auto& v) { return v.value; };
  merge_labels(into.features, other.features, "F", into, id);
  merge_labels(into.datums, other.datums, "DAT", into, id);
  merge_labels(into.frames, other.frames, "D", into, id);
  merge_labels(into.sensors, other.sensors, "S", into, id);
  merge_labels(into.tolerances, other.tolerances, "T", into, [](const ToleranceSymbol& t) { return t.span.begin; });
  into.spoilt.insert(other.spoilt.begin(), other.spoilt.end());
  into.ambiguous.insert(other.ambiguous.begin(), other.ambiguous.end());
}

}  // namespace

void merge(State& into, const State& other) {
  if (!other.reachable) return;
  if (!into.reachable) {
    into = other;
    return;
  }
  merge_symbols(into.symbols, other.symbols);
  if (into.actuals.size() < other.actuals.size()) into.actuals.resize(other.actuals.size());
  for (std::size_t k = 0; k < other.actuals.size(); ++k) {
    into.actuals[k].present |= other.actuals[k].present;
    if (into.actuals[k].spoilt.empty()) into.actuals[k].spoilt = other.actuals[k].spoilt;
  }
  if (into.measuring && other.measuring) {
    if (into.measuring->spoilt.empty()) into.measuring->spoilt = other.measuring->spoilt;
    into.measuring->touches = std::max(into.measuring->touches, other.measuring->touches);
  }
  into.sensor_selected |= other.sensor_selected;
  into.home_known |= other.home_known;
  for (const auto doubt : {&State::frame_doubt, &State::unit_doubt, &State::sensor_doubt, &State::flow_doubt})
    if ((into.*doubt).empty()) into.*doubt = other.*doubt;
  std::erase_if(into.settings, [&](const auto& setting) {
    const auto theirs = other.settings.find(setting.first);
    return theirs == other.settings.end() || theirs->second != setting.second;
  });
  merge(into.variables, other.variables);
}

}  // namespace abbe::lang
