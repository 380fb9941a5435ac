// The language server: a loop that reads messages of the language server protocol (version 3.17,
// JSON-RPC 2.0) and answers them from the open documents. Documents are synchronised whole:
// programs are small and compile in milliseconds, so nothing is kept from one change to the next.
//
// A message that cannot be read or answered gets an error of JSON-RPC; the server goes on.
#pragma once

#include <cstdio>

namespace abbe::lsp {

/// Serves until `exit`, or the end of the input. The exit code that the protocol asks for: 0 after
/// `shutdown`, else 1.
int serve(std::FILE* in, std::FILE* out);

}  // namespace abbe::lsp
