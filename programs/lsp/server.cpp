#include "programs/lsp/server.hpp"

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
  internal = -32603
};

struct RequestError {
  Fault fault;
  std::string message;
};

json capabilities() {
  return {{"capabilities",
           {{"positionEncoding", "utf-16"},
            {"textDocumentSync", {{"openClose", true}, {"change", 1}}},
            {"hoverProvider", true},
            {"definitionProvider", true},
            {"referencesProvider", true},
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
    json message = json::parse(text, nullptr, false);
    if (message.is_discarded()) return fail(nullptr, {Fault::parse, "the message is not JSON"});
    const json id = message.is_object() && message.contains("id") ? message["id"] : json(nullptr);
    if (!message.is_object() || !message.contains("method")) {
      // An answer to a request of ours would come here; we make none.
      if (!message.is_object()) fail(id, {Fault::invalid_request, "a message is an object with a method"});
      return std::nullopt;
    }
    try {
      const std::string method = message["method"].get<std::string>();
      if (method == "exit") return shut_down_ ? 0 : 1;
      const json parameters = message.value("params", json::object());
      if (id.is_null())
        notice(method, parameters);
      else
        send({{"jsonrpc", "2.0"}, {"id", id}, {"result", answer(method, parameters)}});
    } catch (const RequestError& error) {
      fail(id, error);
    } catch (const json::exception& error) {
      fail(id, {Fault::invalid_parameters, error.what()});
    } catch (const std::exception& error) {  // a fault of ours must not take the editor's session away
      fail(id, {Fault::internal, error.what()});
    }
    return std::nullopt;
  }

 private:
  /// Names and labels may hold bytes that are not UTF-8; JSON must not.
  void send(const json& message) { write_message(out_, message.dump(-1, ' ', false, json::error_handler_t::replace)); }

  /// Notices get no answer, not even when they are wrong.
  std::optional<int> fail(const json& id, const RequestError& error) {
    if (!id.is_null() || error.fault == Fault::parse)
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

  void notice(const std::string& method, const json& p) {
    if (method == "textDocument/didOpen") {
      open(p.at("textDocument").at("uri"), p.at("textDocument").at("text"));
    } else if (method == "textDocument/didChange") {
      const json& changes = p.at("contentChanges");
      if (!changes.empty()) open(p.at("textDocument").at("uri"), changes.back().at("text"));
    } else if (method == "textDocument/didClose") {
      const std::string uri = p.at("textDocument").at("uri");
      documents_.erase(uri);
      publish(uri, json::array());
    }
  }

  const Document& document(const json& p) const {
    const auto it = documents_.find(p.at("textDocument").at("uri").get<std::string>());
    if (it == documents_.end()) throw RequestError{Fault::invalid_parameters, "this document is not open"};
    return it->second;
  }

  json answer(const std::string& method, const json& p) {
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

  json about_document(const std::string& question, const json& p) const {
    const auto place = [&] { return offset_of(document(p).source(), p.at("position")); };
    if (question == "hover") return document(p).hover(place());
    if (question == "definition") return document(p).definition(place());
    if (question == "references") return document(p).references(place(), p.at("context").at("includeDeclaration"));
    if (question == "completion") return document(p).completion(place());
    if (question == "documentSymbol") return document(p).outline();
    if (question == "foldingRange") return document(p).folding();
    if (question == "formatting") return document(p).formatting();
    if (question == "codeAction") {
      const SourceFile& source = document(p).source();
      return document(p).fixes(
          {offset_of(source, p.at("range").at("start")), offset_of(source, p.at("range").at("end"))});
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
  while (const auto message = read_message(in))
    if (const auto code = server.handle(*message)) return *code;
  return 1;
}

}  // namespace abbe::lsp
