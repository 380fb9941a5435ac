// Labels and words are the same whatever the case of their letters. Of ASCII only: labels keep the bytes of the program.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace abbe {

constexpr char upper_letter(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

inline std::string upper(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), upper_letter);
  return out;
}

inline bool same_label(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return upper_letter(x) == upper_letter(y); });
}

}  // namespace abbe
