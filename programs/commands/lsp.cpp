// abbe lsp: the language server, on stdin and stdout, for editors.
#include "programs/commands/commands.hpp"
#include "programs/lsp/server.hpp"

namespace abbe {

int lsp_command() { return lsp::serve(stdin, stdout); }

}  // namespace abbe
