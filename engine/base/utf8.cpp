#include "engine/base/utf8.hpp"

#include <array>

namespace abbe {

namespace {

/// The characters of 1 to 4 bytes, and of how many bits the first byte of each is a mark.
struct Form {
  unsigned char mask, mark;
  char32_t least;
};
constexpr std::array kForms = {Form{0x80, 0x00, 0}, Form{0xE0, 0xC0, 0x80}, Form{0xF0, 0xE0, 0x800},
                               Form{0xF8, 0xF0, 0x10000}};

constexpr bool is_surrogate(char32_t c) { return c >= 0xD800 && c < 0xE000; }

}  // namespace

Character utf8_character(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  std::size_t form = 0;
  while (form < kForms.size() && (byte(at) & kForms[form].mask) != kForms[form].mark) ++form;
  if (form == kForms.size() || at + form >= text.size()) return {};
  char32_t code = byte(at) & static_cast<unsigned char>(~kForms[form].mask);
  for (std::size_t k = 1; k <= form; ++k) {
    if ((byte(at + k) & 0xC0) != 0x80) return {};
    code = code << 6 | (byte(at + k) & 0x3F);
  }
  if (code < kForms[form].least || is_surrogate(code) || code > 0x10FFFF) return {};
  return {code, form + 1};
}

Character character_at(std::string_view text, std::size_t at) {
  const Character c = utf8_character(text, at);
  return c.bytes > 0 ? c : Character{static_cast<unsigned char>(text[at]), 1};
}

std::size_t first_foreign(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size()) {
    const Character c = utf8_character(text, at);
    if (c.bytes == 0) return at;
    at += c.bytes;
  }
  return at;
}

std::size_t count_characters(std::string_view text) {
  std::size_t count = 0;
  for (std::size_t at = 0; at < text.size(); at += character_at(text, at).bytes) ++count;
  return count;
}

std::string_view first_characters(std::string_view text, std::size_t count) {
  std::size_t end = 0;
  for (; count > 0 && end < text.size(); --count) end += character_at(text, end).bytes;
  return text.substr(0, end);
}

void append_utf8(std::string& out, char32_t c) {
  const auto last = [&](int shift) { out += static_cast<char>(0x80 | (c >> shift & 0x3F)); };
  if (c < 0x80) {
    out += static_cast<char>(c);
  } else if (c < 0x800) {
    out += static_cast<char>(0xC0 | c >> 6);
    last(0);
  } else if (c < 0x10000) {
    out += static_cast<char>(0xE0 | c >> 12);
    last(6), last(0);
  } else {
    out += static_cast<char>(0xF0 | c >> 18);
    last(12), last(6), last(0);
  }
}

}  // namespace abbe
