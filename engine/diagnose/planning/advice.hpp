// What to do next beside a measurement of the menu, or where none of the menu is worth its time.
#pragma once

#include "engine/diagnose/findings/search.hpp"

namespace abbe::diagnose {

/// Sentences; empty where what is proposed is enough. `told`: first the findings in their order, and what is proposed.
std::string otherwise(const Case&, const SearchResult&, const Diagnosis& told);

}  // namespace abbe::diagnose
