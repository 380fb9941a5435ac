// UTF-8, RFC 3629: overlong forms, surrogates and what lies beyond U+10FFFF are none.
#pragma once

#include <string>
#include <string_view>

namespace abbe {

struct Character {
  char32_t code = 0;
  std::size_t bytes = 0;
};

/// The character that begins at a byte of the text. Precondition: at < text.size(). `bytes` is 0 where none begins.
Character utf8_character(std::string_view text, std::size_t at);

/// The same; a byte that begins none stands for itself, as in Latin-1.
Character character_at(std::string_view text, std::size_t at);

/// Where the first byte stands that is no UTF-8; the size when there is none.
std::size_t first_foreign(std::string_view text);

/// How many characters the text has by `character_at`.
std::size_t count_characters(std::string_view text);

/// The text up to and with that many characters; all of a text that has fewer.
std::string_view first_characters(std::string_view text, std::size_t count);

void append_utf8(std::string& out, char32_t code);

}  // namespace abbe
