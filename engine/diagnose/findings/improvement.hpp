// What the findings improve, on touches that they were not fitted to.
#pragma once

#include "engine/diagnose/findings/search.hpp"

namespace abbe::diagnose {

void show_improvement(const Case&, const SearchResult&, Diagnosis&);

}  // namespace abbe::diagnose
