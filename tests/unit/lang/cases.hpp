// The case files of tests/lang. What a case expects stands in its comments, on the line that it
// speaks of or with a place:
//
//   GOTTO/1,2,3 $$ expect error E0110            an error with this code on this line
//   $$ expect warning W0225 at +1                on the next line; `at 12`: on line 12
//   OUTPUT/FA(A),TA(B) $$ expect lost            Compilation::lost has an entry for this line
//
// The expectations are complete: a message that is not expected fails the case.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lang/compile.hpp"

namespace abbe::lang {

/// The .dmi files of a folder below tests/lang, by name.
std::vector<std::filesystem::path> case_files(const std::string& folder);

/// "12 E0110" or "12 lost", sorted.
std::vector<std::string> expected_messages(const SourceFile&);
std::vector<std::string> actual_messages(const Sink&, const Compilation&);

}  // namespace abbe::lang
