// Variables: DECL, ASSIGN, PROMPT, VALUE. (OBTAIN is in obtain.cpp.)
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "engine/base/numbers.hpp"
#include "lang/statement.hpp"
#include "lang/statements/target.hpp"

namespace abbe::lang {

namespace {

/// NAME, NAME[index] or NAME(index), as it is written.
struct WrittenVariable {
  std::string name;
  char closing = 0;    ///< ends the index; 0: there is none
  bool closed = true;  ///< whether it does
  RawArgument index;   ///< where it stands in the text of the statement
};

/// `begin`: where `text` stands in the text of the statement.
WrittenVariable parse_variable(std::string_view text, std::size_t begin) {
  WrittenVariable out;
  const std::size_t open = std::min(text.find_first_of("[("), text.size());
  out.name = text.substr(0, open);
  out.name.erase(out.name.find_last_not_of(" \t") + 1);
  if (open == text.size()) return out;
  out.closing = text[open] == '[' ? ']' : ')';
  out.closed = text.back() == out.closing;
  out.index.begin = begin + open + 1;
  out.index.end = begin + text.size() - 1;
  return out;
}

}  // namespace

bool assign_to_label(Lowering& lowering, const RawStatement& raw, Value value) {
  const std::string& written = raw.label->name;
  const WrittenVariable label = parse_variable(written, raw.code->text().find(written));
  const std::string& name = label.name;
  std::optional<Value> index;
  if (label.closing) {
    index = lowering.value(label.index);
    if (!index) return false;
    if (!index->is_index()) {
      lowering.error(Code::E0236, raw.label->span,
                     fmt::format("an index is a whole number, this is {}", name_of(index->type)));
      return false;
    }
  }
  Variable* variable = find_variable(lowering, name);
  if (!variable && !index) {
    const Type type = value.type == Type::integer ? Type::real : value.type;  // X=ASSIGN/5 does not say that X is whole
    lowering.warn(Code::W0124, raw.label->span,
                  fmt::format("{} is not declared: it is taken as {}", name, name_of(type)),
                  fmt::format("declare it: DECL/{},{}", name_of(type), name));
    variable = &declare(lowering, name, type, 0, 0, false);
  }
  try {
    if (!variable)
      throw Mistake{Code::E0230,
                    0,
                    0,
                    fmt::format("{} is no variable here", name),
                    fmt::format("declare it: DECL/REAL,{}[10]", name),
                    ""};
    assign(lowering, *variable, index, std::move(value));
    return true;
  } catch (const Mistake& m) {
    lowering.error(m.code, raw.label->span, m.message, m.help);
    return false;
  }
}

namespace {

constexpr double kMostElements = 10000, kMostCharacters = 65536;

Type type_of(const std::string& word) {
  return word == "BOOL"                   ? Type::boolean
      : word == "INTGR" || word == "LONG" ? Type::integer
      : word == "CHAR"                    ? Type::text
      : word == "VECTOR"                  ? Type::vector
                                          : Type::real;
}

/// NAME or NAME[size]; name and size, or nothing after an error.
std::optional<std::pair<std::string, int>> declared(Lowering& lowering, const RawArgument& a) {
  const WrittenVariable variable = parse_variable(a.text, a.begin);
  const std::string& name = variable.name;
  const auto letter = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || static_cast<unsigned char>(c) >= 0x80;
  };
  bool sound = !name.empty() && !std::isdigit(static_cast<unsigned char>(name[0]));
  for (const char c : name) sound = sound && letter(c);
  if (!sound || a.kind == RawArgument::Kind::text) {
    lowering.error(Code::E0243, a.span, fmt::format("'{}' is no name for a variable", a.text),
                   "a name has letters, digits and _ and does not begin with a digit");
    return std::nullopt;
  }
  if (!variable.closing) return std::pair{name, 0};
  if (!variable.closed) {
    lowering.error(Code::E0243, a.span, fmt::format("the size of an array ends with '{}'", variable.closing),
                   fmt::format("write {}[10] for ten elements; there is one index", name));
    return std::nullopt;
  }
  const std::optional<Value> size = lowering.value(variable.index);
  if (!size) return std::nullopt;
  if (!size->is_number() || !size->known() || !(size->constant() >= 1 && size->constant() <= kMostElements)) {
    lowering.error(Code::E0243, a.span, fmt::format("an array has 1 to {} elements", kMostElements),
                   fmt::format("write {}[10] for ten elements; there is one index", name));
    return std::nullopt;
  }
  return std::pair{name, static_cast<int>(size->constant())};
}

void declare_all(Lowering& lowering, const RawStatement& raw, const Match& match) {
  const Type type = type_of(match.text("type"));
  const std::string scope = match.text("scope", lowering.scopes.empty() ? "GLOBAL" : "LOCAL");
  const MatchedValue* size = match.find("length");
  if (size && !(size->number >= 1 && size->number <= kMostCharacters))
    return lowering.error(Code::E0243, size->span, fmt::format("a CHAR holds 1 to {} characters", kMostCharacters),
                          "for example: DECL/CHAR,20,TEXT");
  const int length = static_cast<int>(match.number("length"));
  if (match.used >= raw.arguments.size())
    lowering.error(Code::E0107, raw.span, "DECL ends where a variable is expected", "for example: DECL/REAL,X,Y,Z[10]");
  for (std::size_t k = match.used; k < raw.arguments.size(); ++k) {
    const auto name = declared(lowering, raw.arguments[k]);
    if (!name) continue;
    const bool global = scope != "LOCAL" || lowering.scopes.empty();
    const std::string key = (global ? "" : lowering.scopes.back()) + upper(name->first);
    const auto known = lowering.variables.find(key);
    const bool repeats =
        known != lowering.variables.end() && known->second.type == type && known->second.size == name->second;
    if (repeats) continue;  // a DECL in a loop or said again: the variable keeps its value
    declare(lowering, name->first, type, length, name->second, global);
  }
}

void assign_value(Lowering& lowering, const RawStatement& raw, const Match& match) {
  assign_to_label(lowering, raw, *match.find("value")->value);
}

/// The answer as a value of this type, or of the type that it looks like.
std::optional<Value> answer_value(Lowering& lowering, const std::string& answer, const Variable* variable) {
  if (variable && variable->type == Type::text) return lowering.texts.value(answer);
  const std::string word = upper(answer);
  for (const bool v : {true, false})
    if (word == (v ? "TRUE" : "FALSE") || word == (v ? ".TRUE." : ".FALSE.")) return boolean(v);
  if (const std::optional<double> v = finite_number(answer))
    return answer.find_first_of(".eE") == std::string::npos ? integer(*v) : number(*v);
  return variable ? std::nullopt : std::optional(lowering.texts.value(answer));
}

void prompt(Lowering& lowering, const RawStatement& raw, const Match& match) {
  const std::string name = parse_variable(raw.label->name, 0).name;
  lowering.asked.insert(upper(name));
  const auto answer = lowering.answers.find(upper(name));
  if (answer == lowering.answers.end())
    return lowering.error(
        Code::E0235, raw.span, fmt::format("nobody is here to answer '{}'", match.text("question")),
        fmt::format("give the answer on the command line, --answer {0}=VALUE, or in the program: $$! answer {0}=VALUE",
                    name));
  if (const auto value = answer_value(lowering, answer->second, find_variable(lowering, name)))
    assign_to_label(lowering, raw, *value);
  else
    lowering.error(Code::E0235, raw.span, fmt::format("the answer '{}' is no value for {}", answer->second, name),
                   fmt::format("--answer {}=VALUE takes a number, TRUE or FALSE here", name));
}

void setting(Lowering& lowering, const RawStatement& raw, const Match& match) {
  const std::string word = match.text("word");
  const std::string* found = lowering.settings.find(match.has("which") ? word + "," + match.text("which") : word);
  if (!found)
    return lowering.error(Code::E0244, match.find("word")->span,
                          fmt::format("{} has not been set above on every path", word),
                          "VALUE reads what the last statement of that word set");
  if (const auto value = answer_value(lowering, *found, nullptr)) assign_to_label(lowering, raw, *value);
}

}  // namespace

extern const Statement kDecl, kAssign, kPrompt, kValue;

const Statement kDecl = {
    .word = "DECL",
    .signature =
        "[ scope:GLOBAL|COMMON|LOCAL ], ( type:CHAR, length:integer ; type:BOOL|INTGR|LONG|REAL|DOUBLE|CHAR|VECTOR ), ...",
    .help = "Declares variables, or arrays: X[10]. In a macro they are local to the call, unless GLOBAL or COMMON.",
    .example = "DECL/REAL,X,Y,DEV[10]",
    .source = "ISO 22093, DECL",
    .lower = declare_all,
};
const Statement kAssign = {
    .word = "ASSIGN",
    .label = "=",
    .signature = "value:value",
    .help =
        "Gives a variable a value. INTGR cuts fractions off. What depends on a measured value differs from machine to machine.",
    .example = "X=ASSIGN/2*SQRT(Y)+1",
    .source = "ISO 22093, ASSIGN",
    .lower = assign_value,
    .varying = Varying::taken,
};
const Statement kPrompt = {
    .word = "PROMPT",
    .label = "=",
    .signature = "question:text, ...",
    .help =
        "Asks the operator. Here the answer comes from the command line, --answer X=VALUE, or from a directive: $$! answer X=VALUE.",
    .example = "X=PROMPT/'serial number'",
    .source = "ISO 22093, PROMPT",
    .lower = prompt,
};
const Statement kValue = {
    .word = "VALUE",
    .label = "=",
    .signature = "word:word, [ which:word ]",
    .help =
        "A setting in force: the first argument of the last statement of that word (VALUE/UNITS), or the last argument of the last one that began with a "
        "second word (VALUE/SNSET,APPRCH).",
    .example = "X=VALUE/SNSET,APPRCH",
    .source = "ISO 22093, VALUE",
    .lower = setting,
};

}  // namespace abbe::lang
