// Labels and words are the same whatever the case of their letters, and whether their file is UTF-8 or
// Latin-1. Labels keep the bytes of the program; what is compared is `upper` of them.
//
// By the case mappings of one letter to one letter in Unicode (UnicodeData.txt) for ASCII, Latin-1, Latin
// Extended-A, Greek and Cyrillic, written as ranges: the mappings of the C library depend on the locale of
// whoever runs the program.
#pragma once

#include <string>
#include <string_view>

namespace abbe {

/// Of ASCII only.
constexpr char upper_letter(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

/// In upper case and UTF-8. A byte that is no UTF-8 is taken as the Latin-1 letter.
std::string upper(std::string_view text);

/// In lower case and UTF-8, by the same mappings.
std::string lower(std::string_view text);

bool same_label(std::string_view a, std::string_view b);

/// Of a map whose keys are labels.
struct LabelOrder {
  bool operator()(std::string_view a, std::string_view b) const { return upper(a) < upper(b); }
};

}  // namespace abbe
