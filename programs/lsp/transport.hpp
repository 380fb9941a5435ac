// Messages of the language server protocol on a pair of streams: a header `Content-Length: N`, an
// empty line, N bytes of JSON (LSP 3.17, "Base Protocol").
#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

namespace abbe::lsp {

/// No message of an editor is longer; a header that claims more is not believed.
inline constexpr std::size_t kLongestMessage = 64 << 20;

/// The input cannot be read as messages, and why: nobody knows where the next one would begin.
struct BrokenFrame {
  std::string reason;
};

/// The next message; nothing at the end of the input. Throws BrokenFrame.
std::optional<std::string> read_message(std::FILE*);
void write_message(std::FILE*, std::string_view text);

}  // namespace abbe::lsp
