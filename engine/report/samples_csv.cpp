#include <fmt/format.h>

#include "engine/base/csv.hpp"
#include "engine/report/report_unit.hpp"
#include "engine/report/study.hpp"

namespace abbe {

namespace {

std::string characteristic_name(const plan::Plan& plan, const plan::CharacteristicDef& definition) {
  std::string name;
  for (const plan::FeatureId f : definition.features) name += fmt::format("FA({}),", plan[f].label);
  return name + fmt::format("TA({})", plan[definition.tolerance].label);
}

}  // namespace

std::string samples_csv(const plan::Plan& plan, const Study& study) {
  std::string out = "machine,candidate,characteristic,line,occurrence,unit,reference,value\r\n";
  const std::vector<int> numbers = occurrences(plan, study.result.samples);
  for (std::size_t s = 0; s < numbers.size(); ++s) {
    const Samples& samples = study.result.samples[s];
    const plan::CharacteristicDef& definition = plan[samples.characteristic];
    const ReportUnit unit = report_unit(plan, samples.characteristic);
    const std::string reference = samples.reference ? fmt::format("{}", *samples.reference * unit.factor) : "";
    const std::string middle = fmt::format("{},{},{},{},{}", csv_field(characteristic_name(plan, definition)),
                                           definition.line, numbers[s], unit.name, reference);
    for (std::size_t i = 0; i < samples.value.size(); ++i) {
      const std::uint32_t machine = samples.machine[i];
      out += fmt::format("{},{},{},{}\r\n", machine, study.candidates[machine], middle, samples.value[i] * unit.factor);
    }
  }
  return out;
}

}  // namespace abbe
