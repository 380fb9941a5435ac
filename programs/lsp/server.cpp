#include "programs/lsp/server.hpp"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "programs/lsp/document.hpp"
#include "programs/lsp/positions.hpp"
#include "programs/lsp/transport.hpp"

namespace abbe::lsp {

using nlohmann::json;

namespace {

/// Codes of JSON-RPC 2.0 and LSP 3.17.
enum class Fault {
  parse = -32700,
  invalid_request = -32600,
  unknown_method = -32601,
  invalid_parameters = -32602,
  not_initialised = -32002,
  internal = -32603,
  refused = -32803
};

struct RequestError {
  Fault fault;
  std::string message;
};

/// Throws RequestError when it is not JSON, or nested deeper than any message of the protocol: a value is copied and
/// destroyed level by level on the stack.
json parsed(const std::string& text) {
  constexpr int kDeepest = 64;
  bool too_deep = false;
  const auto is_shallow = [&](int depth, json::parse_event_t, json&) {
    too_deep = too_deep || depth > kDeepest;
    return !too_deep;
  };
  json message = json::parse(text, is_shallow, false);
  if (too_deep)
    throw RequestError{Fault::invalid_request, fmt::format("a message is nested at most {} deep", kDeepest)};
  if (message.is_discarded()) throw RequestError{Fault::parse, "the message is not JSON"};
  return message;
}

/// What a message holds, by name.
class Parameters {
 public:
  Parameters(const json& parameters, std::string_view method) : root_(parameters), method_(method) {}

  std::string text(std::string_view path) const {
    const json& v = at(path);
    if (!v.is_string()) wrong(path, "a text");
    return v.get<std::string>();
  }
  bool truth(std::string_view path) const {
    const json& v = at(path);
    if (!v.is_boolean()) wrong(path, "true or false");
    return v.get<bool>();
  }
  const json& list(std::string_view path) const {
    const json& v = at(path);
    if (!v.is_array()) wrong(path, "a list");
    return v;
  }
  std::uint32_t place(const SourceFile& source, const std::string& path) const {
    return offset_of(source, number(path + ".line"), number(path + ".character"));
  }

 private:
  [[noreturn]] void wrong(std::string_view path, std::string_view expected) const {
    throw RequestError{Fault::invalid_parameters, fmt::format("{}: {} must be {}", method_, path, expected)};
  }

  std::uint64_t number(std::string_view path) const {
    const json& v = at(path);
    if (!v.is_number_unsigned()) wrong(path, "a whole number that is not negative");
    return v.get<std::uint64_t>();
  }

  /// `path`: names with dots between them.
  const json& at(std::string_view path) const {
    const json* found = &root_;
    for (std::size_t begin = 0, end = 0; end != std::string_view::npos; begin = end + 1) {
      end = path.find('.', begin);
      const std::string name(path.substr(begin, end == std::string_view::npos ? end : end - begin));
      if (!found->is_object() || !found->contains(name))
        throw RequestError{Fault::invalid_parameters, fmt::format("{}: {} is missing", method_, path.substr(0, end))};
      found = &(*found)[name];
    }
    return *found;
  }

  const json& root_;
  std::string_view method_;
};

json capabilities() {
  return {{"capabilities",
           {{"positionEncoding", "utf-16"},
            {"textDocumentSync", {{"openClose", true}, {"change", 1}}},
            {"hoverProvider", true},
            {"definitionProvider", true},
            {"referencesProvider", true},
            {"documentHighlightProvider", true},
            {"renameProvider", {{"prepareProvider", true}}},
            {"completionProvider", {{"triggerCharacters", {"/", ",", "("}}}},
            {"documentSymbolProvider", true},
            {"foldingRangeProvider", true},
            {"codeActionProvider", {{"codeActionKinds", {"quickfix"}}}},
            {"documentFormattingProvider", true}}},
          {"serverInfo", {{"name", "abbe"}, {"version", ABBE_VERSION}}}};
}

class Server {
 public:
  explicit Server(std::FILE* out) : out_(out) {}

  /// Nothing while the server goes on, else its exit code.
  std::optional<int> handle(const std::string& text) {
    try {
      return handle_message(parsed(text));
    } catch (const RequestError& error) {
      return fail(nullptr, error);
    }
  }

 private:
  std::optional<int> handle_message(const json& message) {
    const bool object = message.is_object();
    // An answer to a request of ours would come here; we make none.
    if (object && (message.contains("result") || message.contains("error"))) return std::nullopt;
    const json id = object && message.contains("id") ? message["id"] : json(nullptr);
    if (!object || !message.contains("method") || !message["method"].is_string())
      return fail(id, {Fault::invalid_request, "a message is an object with a method"});
    const std::string method = message["method"].get<std::string>();
    if (method == "exit") return shut_down_ ? 0 : 1;
    const json parameters = message.value("params", json::object());
    try {
      if (!message.contains("id"))
        notice(method, {parameters, method});
      else
        send({{"jsonrpc", "2.0"}, {"id", id}, {"result", answer(method, {parameters, method})}});
    } catch (const RequestError& error) {
      // Notices get no answer, not even when they are wrong.
      return message.contains("id") ? fail(id, error) : std::nullopt;
    } catch (const Refused& refused) {
      fail(id, {Fault::refused, refused.reason});
    } catch (const std::exception& error) {  // a fault of ours must not take the editor's session away
      fail(id, {Fault::internal, error.what()});
    }
    return std::nullopt;
  }

  /// Names and labels may hold bytes that are not UTF-8; JSON must not.
  void send(const json& message) { write_message(out_, message.dump(-1, ' ', false, json::error_handler_t::replace)); }

  std::optional<int> fail(const json& id, const RequestError& error) {
    send({{"jsonrpc", "2.0"},
          {"id", id},
          {"error", {{"code", static_cast<int>(error.fault)}, {"message", error.message}}}});
    return std::nullopt;
  }

  void publish(const std::string& uri, const json& diagnostics) {
    send({{"jsonrpc", "2.0"},
          {"method", "textDocument/publishDiagnostics"},
          {"params", {{"uri", uri}, {"diagnostics", diagnostics}}}});
  }

  void open(const std::string& uri, std::string text) {
    const auto [it, fresh] = documents_.insert_or_assign(uri, Document(uri, std::move(text)));
    publish(uri, it->second.diagnostics());
  }

  void notice(const std::string& method, const Parameters& p) {
    if (method == "textDocument/didOpen") {
      open(p.text("textDocument.uri"), p.text("textDocument.text"));
    } else if (method == "textDocument/didChange") {
      const json& changes = p.list("contentChanges");
      if (!changes.empty()) open(p.text("textDocument.uri"), Parameters(changes.back(), method).text("text"));
    } else if (method == "textDocument/didClose") {
      const std::string uri = p.text("textDocument.uri");
      documents_.erase(uri);
      publish(uri, json::array());
    }
  }

  const Document& document(const Parameters& p) const {
    const auto it = documents_.find(p.text("textDocument.uri"));
    if (it == documents_.end()) throw RequestError{Fault::invalid_parameters, "this document is not open"};
    return it->second;
  }

  json answer(const std::string& method, const Parameters& p) {
    if (shut_down_) throw RequestError{Fault::invalid_request, "after shutdown only exit may come"};
    if (method == "initialize") {
      initialised_ = true;
      return capabilities();
    }
    if (!initialised_) throw RequestError{Fault::not_initialised, "send initialize first"};
    if (method == "shutdown") {
      shut_down_ = true;
      return nullptr;
    }
    if (method.starts_with("textDocument/")) return about_document(method.substr(13), p);
    throw RequestError{Fault::unknown_method, "there is no method " + method};
  }

  json about_document(const std::string& question, const Parameters& p) const {
    const auto place = [&] { return p.place(document(p).source(), "position"); };
    if (question == "hover") return document(p).hover(place());
    if (question == "definition") return document(p).definition(place());
    if (question == "references") return document(p).references(place(), p.truth("context.includeDeclaration"));
    if (question == "documentHighlight") return document(p).highlights(place());
    if (question == "completion") return document(p).completion(place());
    if (question == "prepareRename") return document(p).prepare_rename(place());
    if (question == "rename") return document(p).rename(place(), p.text("newName"));
    if (question == "documentSymbol") return document(p).outline();
    if (question == "foldingRange") return document(p).folding();
    if (question == "formatting") return document(p).formatting();
    if (question == "codeAction") {
      const SourceFile& source = document(p).source();
      return document(p).fixes({p.place(source, "range.start"), p.place(source, "range.end")});
    }
    throw RequestError{Fault::unknown_method, "there is no method textDocument/" + question};
  }

  std::FILE* out_;
  std::map<std::string, Document> documents_;
  bool initialised_ = false, shut_down_ = false;
};

}  // namespace

int serve(std::FILE* in, std::FILE* out) {
  Server server(out);
  try {
    while (const auto message = read_message(in))
      if (const auto code = server.handle(*message)) return *code;
  } catch (const BrokenFrame& broken) {
    fmt::print(stderr, "abbe lsp: {}\n", broken.reason);
  }
  return 1;
}

}  // namespace abbe::lsp
