// Faults on purpose, to show that the sanitizers are on: a test that finds nothing may also be looking nowhere.
#pragma once

#include <string_view>

namespace abbe::fuzz {

/// Commits "overrun" (writes behind the end of an array), "overflow" (of a signed integer) or "leak" (memory
/// that nothing points to). Returns 0 when nothing stopped it, 2 for any other name.
int commit_fault(std::string_view name);

}  // namespace abbe::fuzz
