#include "engine/diagnose/case.hpp"

namespace abbe::diagnose {

std::vector<NextMeasurement> next_measurements(const Case&, const SearchResult*) { return {}; }

}  // namespace abbe::diagnose
