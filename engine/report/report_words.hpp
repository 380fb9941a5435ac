// The words of reports (`abbe run`) and diagnoses (`abbe diagnose`), for whoever reads one: the columns of the text and of
// the page, the keys of the JSON. docs/results.md has more about each.
#pragma once

#include <span>
#include <string_view>

namespace abbe {

struct ReportWord {
  std::string_view word, key;  ///< in text and page; in the JSON. Either may be empty
  std::string_view help;
};
std::span<const ReportWord> report_words();
std::span<const ReportWord> diagnosis_words();

}  // namespace abbe
