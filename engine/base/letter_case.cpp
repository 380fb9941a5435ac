#include "engine/base/letter_case.hpp"

#include <algorithm>
#include <array>

#include "engine/base/utf8.hpp"

namespace abbe {

namespace {

/// Small letters `first` to `last`, every `step`th code; their capitals lie `up` codes further.
struct SmallLetters {
  char32_t first, last, step;
  int up;
};
constexpr std::array kSmallLetters = {
    SmallLetters{0x00B5, 0x00B5, 1, 743},  // micro sign: capital Mu, as of the Greek letter
    SmallLetters{0x00E0, 0x00F6, 1, -32},  // Latin-1, around the division sign
    SmallLetters{0x00F8, 0x00FE, 1, -32},  SmallLetters{0x00FF, 0x00FF, 1, 121},
    SmallLetters{0x0101, 0x012F, 2, -1},  // Latin Extended-A, without the two letters i of Turkish
    SmallLetters{0x0133, 0x0137, 2, -1},   SmallLetters{0x013A, 0x0148, 2, -1},
    SmallLetters{0x014B, 0x0177, 2, -1},   SmallLetters{0x017A, 0x017E, 2, -1},
    SmallLetters{0x017F, 0x017F, 1, -300},  // long s
    SmallLetters{0x0371, 0x0373, 2, -1},    // Greek
    SmallLetters{0x0377, 0x0377, 1, -1},   SmallLetters{0x037B, 0x037D, 1, 130},
    SmallLetters{0x03AC, 0x03AC, 1, -38},  SmallLetters{0x03AD, 0x03AF, 1, -37},
    SmallLetters{0x03B1, 0x03C1, 1, -32},  SmallLetters{0x03C2, 0x03C2, 1, -31},  // sigma at the end of a word
    SmallLetters{0x03C3, 0x03CB, 1, -32},  SmallLetters{0x03CC, 0x03CC, 1, -64},
    SmallLetters{0x03CD, 0x03CE, 1, -63},  SmallLetters{0x03D9, 0x03EF, 2, -1},
    SmallLetters{0x0430, 0x044F, 1, -32},  // Cyrillic
    SmallLetters{0x0450, 0x045F, 1, -80},  SmallLetters{0x0461, 0x0481, 2, -1},
    SmallLetters{0x048B, 0x04BF, 2, -1},   SmallLetters{0x04C2, 0x04CE, 2, -1},
    SmallLetters{0x04CF, 0x04CF, 1, -15},  SmallLetters{0x04D1, 0x052F, 2, -1},
};

char32_t capital(char32_t c) {
  const auto* range = std::lower_bound(kSmallLetters.begin(), kSmallLetters.end(), c,
                                       [](const SmallLetters& r, char32_t code) { return r.last < code; });
  const bool small = range != kSmallLetters.end() && c >= range->first && (c - range->first) % range->step == 0;
  return small ? static_cast<char32_t>(static_cast<int>(c) + range->up) : c;
}

/// Where several small letters share a capital, as sigma and the one at the end of a word, the last of the list.
char32_t small(char32_t c) {
  if (c < 0x80) return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c;
  for (auto range = kSmallLetters.rbegin(); range != kSmallLetters.rend(); ++range) {
    const auto letter = static_cast<char32_t>(static_cast<int>(c) - range->up);
    if (letter >= range->first && letter <= range->last && (letter - range->first) % range->step == 0) return letter;
  }
  return c;
}

}  // namespace

std::string upper(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    if (static_cast<unsigned char>(text[at]) < 0x80) {  // nearly always
      out += upper_letter(text[at++]);
      continue;
    }
    const Character c = character_at(text, at);
    append_utf8(out, capital(c.code));
    at += c.bytes;
  }
  return out;
}

std::string lower(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const Character c = character_at(text, at);
    append_utf8(out, small(c.code));
    at += c.bytes;
  }
  return out;
}

bool same_label(std::string_view a, std::string_view b) { return upper(a) == upper(b); }

}  // namespace abbe
