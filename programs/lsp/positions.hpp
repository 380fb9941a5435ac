// Places of the language server protocol and places of ours. The protocol counts lines from 0 and
// characters in UTF-16 code units (LSP 3.17, "Position"); we count bytes of UTF-8.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "engine/base/source.hpp"

namespace abbe::lsp {

/// Bytes that are not UTF-8 count as one unit each, so every offset has a position.
nlohmann::json position(const SourceFile&, std::uint32_t offset);
nlohmann::json range(const SourceFile&, Span);

/// The offset of a position: line and UTF-16 unit. Positions outside the text are brought to its nearest place, as
/// the protocol asks for.
std::uint32_t offset_of(const SourceFile&, std::uint64_t line, std::uint64_t character);

}  // namespace abbe::lsp
