// MACRO and CALL, INCLUD and EXTFIL; and which variables a stretch of program may change.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "lang/directives.hpp"
#include "lang/flow.hpp"
#include "lang/lines.hpp"

namespace abbe::lang {

namespace {

using ArgumentKind = RawArgument::Kind;

bool is_word(const RawArgument& a, std::string_view word) { return a.kind == ArgumentKind::word && a.word == word; }

const RawArgument* labelled_argument(const RawStatement& raw, std::string_view kind) {
  for (const RawArgument& a : raw.arguments)
    if (a.kind == ArgumentKind::label && a.label.kind == kind) return &a;
  return nullptr;
}

/// What is read or lowered while it lives stands in another file or in a macro, called where the current statement is.
struct Elsewhere {
  Elsewhere(Lowering& lowering, const SourceFile& there, const std::string& where)
      : statement(lowering.statement, lowering.statement),
        place(lowering.place, &there == &lowering.source ? std::nullopt : std::optional(lowering.here())),
        file(lowering.file, &there),
        call(lowering.call, where) {}

  Changed<const RawStatement*> statement;
  Changed<std::optional<std::pair<Span, int>>> place;
  Changed<const SourceFile*> file;
  Changed<std::string> call;
};

}  // namespace

void Flow::define_macro(int at) {
  const Line& line = (*routine_)[at];
  if (!line.raw.label || line.raw.label->kind != "M" || line.partner < 0) {
    lowering_.statement = &line.raw;
    lowering_.failed = false;
    if (line.partner >= 0)
      lowering_.error(Code::E0109, line.raw.word_span, "MACRO needs a label M(name)", "for example: M(HOLE)=MACRO/X,Y");
    return;
  }
  macros_[upper(line.raw.label->name)] = macro_at(*routine_, at);
}

void Flow::call(int at) {
  const RawStatement& raw = (*routine_)[at].raw;
  if (!matched(raw)) return;
  if (raw.arguments.empty()) {
    lowering_.error(Code::E0107, raw.span, "CALL ends where a macro is expected",
                    "write CALL/M(name),argument,argument");
    return failed_control();
  }
  const RawArgument* macro = labelled_argument(raw, "M");
  const bool external = is_word(raw.arguments[0], "EXTERN");
  if (macro) {
    const auto place = static_cast<std::size_t>(macro - raw.arguments.data());
    call_macro(macro->label, std::span(raw.arguments).subspan(place + 1));
  } else if (external && raw.arguments.size() >= 3 && is_word(raw.arguments[1], "DMIS")) {
    run_module(raw.arguments[2], false);
  } else if (external) {
    lowering_.warn(Code::W0122, raw.span, "a program outside DMIS is not called here",
                   "the results are those without it");
  } else {
    lowering_.error(Code::E0240, raw.span, "CALL names no macro", "write CALL/M(name),argument,argument");
    failed_control();
  }
}

/// An argument that MACRO has in quotes takes the name itself; who gives a variable may have meant its text.
void Flow::warn_of_variable(const Macro& macro, const std::string& dummy, const RawArgument& actual) {
  std::string_view name = actual.text;
  if (name.starts_with('(') && name.ends_with(')')) name = name.substr(1, name.size() - 2);
  const Variable* variable = actual.kind == ArgumentKind::text ? nullptr : find_variable(lowering_, name);
  if (variable && variable->type == Type::text)
    lowering_.warn(
        Code::W0227, actual.span,
        fmt::format("M({0}) takes '{1}' as it is written: here the name {2}, not what the variable {2} holds",
                    macro.name, dummy, name),
        fmt::format("write '{}' if that is meant; for what the variable holds, MACRO/{} without quotes and F(@{})",
                    name, dummy, dummy));
}

void Flow::call_macro(const LabelRef& label, std::span<const RawArgument> actuals) {
  const RawStatement& raw = *lowering_.statement;
  const auto found = macros_.find(upper(label.name));
  if (found == macros_.end()) {
    std::vector<std::string_view> names;
    for (const auto& [key, macro] : macros_) names.push_back(macro.name);
    const std::string near = nearest_word(label.name, names);
    lowering_.error(
        Code::E0240, label.span, fmt::format("there is no macro M({})", label.name),
        near.empty() ? "define it: M(name)=MACRO/arguments ... ENDMAC" : fmt::format("did you mean M({})?", near),
        near.empty() ? "" : fmt::format("M({})", near));
    return failed_control();
  }
  const Macro macro = found->second;
  if (macro.dummies.size() != actuals.size()) {
    lowering_.error(Code::E0240, raw.span,
                    fmt::format("M({}) takes {} argument{}, {} given", macro.name, macro.dummies.size(),
                                macro.dummies.size() == 1 ? "" : "s", actuals.size()),
                    "write one for each argument of its MACRO statement");
    return failed_control();
  }
  for (std::size_t k = 0; k < actuals.size(); ++k)
    if (macro.dummies[k].kind == ArgumentKind::text) warn_of_variable(macro, macro.dummies[k].text, actuals[k]);
  if (depth_ >= kMaximumCalls) {
    lowering_.error(Code::E0237, raw.span, fmt::format("macros call each other more than {} deep", kMaximumCalls),
                    "does M(" + macro.name + ") call itself without end?");
    failed_control();
    throw TooLong{};
  }
  std::optional<std::vector<LogicalLine>> lines = expand(macro, actuals);
  if (!lines) {
    lowering_.error(Code::E0104, raw.span,
                    fmt::format("the arguments make a line of M({}) longer by more than {} characters", macro.name,
                                kLongestArguments),
                    "assign them to variables first");
    failed_control();
    throw TooLong{};  // who hands arguments on twice does so in every macro
  }
  const std::string outer = lowering_.call.empty() ? "" : ", " + lowering_.call.substr(1, lowering_.call.size() - 2);
  const std::string where = fmt::format("(in M({}), called in line {}{})", macro.name, raw.line, outer);
  Routine body = read_routine(*macro.file, std::move(*lines), where);
  inside(body, where, fmt::format("#{}/", ++calls_));
}

/// The lines of another routine; what is wrong with them is said of its file.
Routine Flow::read_routine(const SourceFile& file, std::vector<LogicalLine> lines, const std::string& where) {
  const Elsewhere there(lowering_, file, where);
  return make_routine(file, std::move(lines), lowering_);
}

/// Lowers another routine and comes back.
void Flow::inside(Routine& routine, const std::string& where, const std::string& scope) {
  std::vector<std::string> scopes = lowering_.scopes;
  if (!scope.empty()) scopes.push_back(scope);
  const Elsewhere there(lowering_, *routine.file, where);
  const Changed around(lowering_.scopes, std::move(scopes));
  const Changed here(routine_, &routine);
  const Changed targets(targets_, {});
  const Changed depth(depth_, depth_ + 1);
  range(0, routine.size(), -1);
  if (!scope.empty())
    std::erase_if(lowering_.variables, [&](const auto& entry) { return entry.first.starts_with(scope); });
}

void Flow::module(int at) {
  const RawStatement& raw = (*routine_)[at].raw;
  if (!matched(raw)) return;
  run_module(raw.arguments[1], raw.word == "EXTFIL");
}

void Flow::run_module(const RawArgument& name, bool only_macros) {
  const RawStatement& raw = *lowering_.statement;
  if (depth_ >= kMaximumCalls) {
    lowering_.error(Code::E0237, raw.span, fmt::format("modules include each other more than {} deep", kMaximumCalls),
                    "does a module include itself?");
    failed_control();
    throw TooLong{};
  }
  Module* found = load(name);
  if (!found) return failed_control();
  const std::string where = fmt::format("(read in line {} of '{}')", raw.line, lowering_.file->name());
  Routine body = read_routine(*found->file, found->lines, where);
  {
    const Elsewhere there(lowering_, *found->file, where);
    const Changed here(routine_, &body);
    for (const LogicalLine& line : found->lines) refuse_directives(line, lowering_);
    for (int k = 0; k < body.size(); ++k)
      if (body[k].control == Control::macro && !body[k].skipped) define_macro(k);
  }
  if (!only_macros) inside(body, where, "");
}

/// The file beside the program, as written or with the ending .dmi; nullptr after an error.
Flow::Module* Flow::load(const RawArgument& name) {
  namespace fs = std::filesystem;
  std::string path = name.text;
  std::replace(path.begin(), path.end(), '\\', '/');
  const fs::path folder = fs::path(lowering_.file->name()).parent_path();
  std::error_code ignored;
  fs::path file = folder / path;
  if (!fs::is_regular_file(file, ignored)) file = folder / (path + ".dmi");
  if (name.kind != ArgumentKind::text || !fs::is_regular_file(file, ignored)) {
    lowering_.error(Code::E0241, name.span,
                    name.kind == ArgumentKind::text ? fmt::format("there is no file '{}' beside the program", name.text)
                                                    : fmt::format("'{}' is no file name", name.text),
                    name.kind == ArgumentKind::text ? "put the module into the folder of the program"
                                                    : "write the name of the file in quotes");
    return nullptr;
  }
  Module& module = modules_[file.string()];
  if (!module.file) {
    try {
      module.file = std::make_unique<SourceFile>(read_source(file.string()));
    } catch (const UserError& e) {
      lowering_.error(Code::E0241, name.span, e.diagnostics().front().message, e.diagnostics().front().help);
      return nullptr;
    }
    lowering_.out.modules.push_back(file.string());
    module.lines = logical_lines(*module.file);
  }
  return &module;
}

VariableNames Flow::assigned(int begin, int end) const {
  VariableNames names;
  std::set<std::string> macros;
  for (int at = begin; at < end; ++at)
    if (!(*routine_)[at].skipped) add_assigned((*routine_)[at].raw, names, macros);
  return names;
}

/// The variables that a statement sets, and of a call those that the macro sets.
void Flow::add_assigned(const RawStatement& raw, VariableNames& names, std::set<std::string>& macros) const {
  const auto add = [&](std::string_view name) { names.names.insert(upper(name.substr(0, name.find_first_of(" [(")))); };
  if (raw.label && raw.label->kind.empty()) add(raw.label->name);
  if (raw.word == "DO" && !raw.arguments.empty()) add(raw.arguments[0].text);
  if (raw.word == "DECL")
    for (const RawArgument& a : raw.arguments) add(a.text);
  if (raw.word == "INCLUD") names.all = true;
  if (raw.word != "CALL") return;
  const RawArgument* label = labelled_argument(raw, "M");
  if (!label) {
    names.all = true;
    return;
  }
  for (const RawArgument& a : raw.arguments)
    if (a.kind == ArgumentKind::word || a.kind == ArgumentKind::expression) add(a.text);
  const auto macro = macros_.find(upper(label->label.name));
  if (macro == macros_.end() || !macros.insert(macro->first).second) return;
  for (const LogicalLine& line : macro->second.lines) {
    Sink unheard;  // mistakes are reported where the macro is read
    if (const auto inner = parse_statement(line, *macro->second.file, unheard)) add_assigned(*inner, names, macros);
  }
}

}  // namespace abbe::lang
