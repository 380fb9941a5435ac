#include "lang/variables.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/base/utf8.hpp"
#include "lang/lowering.hpp"

namespace abbe::lang {

namespace {

plan::ColumnId column(Lowering& lowering, Variable& v, std::size_t cell) {
  if (!v.first.valid()) v.first = lowering.columns_of(v.slot, static_cast<int>(v.cells.size()));
  return {v.first.value + static_cast<int>(cell)};
}

bool chosen(const std::string& key, const VariableNames& names) {
  return names.all || names.names.count(key.substr(key.rfind('/') + 1)) > 0;
}

void store_cell(Lowering& lowering, Variable& v, std::size_t k) {
  Cell& cell = v.cells[k];
  if (!cell.known || cell.stored) return;
  lowering.emit(plan::Assign{column(lowering, v, k), {plan::PushConstant{cell.constant}}});
  cell.stored = true;
}

void store_all(Lowering& lowering, Variable& v) {
  for (std::size_t k = 0; k < v.cells.size(); ++k) store_cell(lowering, v, k);
}

/// The offset of an element that a known index names. Throws Mistake.
int known_offset(const Variable& v, const Value& index) {
  const int offset = plan::element_offset(index.constant(), v.size);
  if (offset < 0)
    throw Mistake{Code::E0236,
                  0,
                  0,
                  fmt::format("{} has no element {}", v.name, index.constant()),
                  fmt::format("its elements are 1 to {}", v.size),
                  ""};
  return offset;
}

void check_use(const Variable& v, const std::optional<Value>& index) {
  if (index && v.size == 0)
    throw Mistake{Code::E0236,
                  0,
                  0,
                  fmt::format("{} is no array", v.name),
                  fmt::format("declare it with its size: DECL/{},{}[10]", name_of(v.type), v.name),
                  ""};
  if (!index && v.size > 0)
    throw Mistake{Code::E0236,
                  0,
                  0,
                  fmt::format("{} is an array: an index is missing", v.name),
                  fmt::format("write {}[1] for its first element", v.name),
                  ""};
}

[[noreturn]] void wrong_type(const Variable& v, const Value& value) {
  throw Mistake{Code::E0232,
                0,
                0,
                fmt::format("{} is {} and cannot hold {}", v.name, name_of(v.type), name_of(value.type)),
                v.type == Type::text ? "STR(x) makes a text of a number" : "assign a value of its type",
                ""};
}

/// The value as the variable holds it.
Value converted(Lowering& lowering, const Variable& v, Value value) {
  const bool numbers = value.is_number() && (v.type == Type::integer || v.type == Type::real);
  if (!numbers && value.type != v.type) wrong_type(v, value);
  if (v.type == Type::integer && value.type == Type::real)
    value.parts[0] = combine(plan::Op1::truncate, std::move(value.parts[0]));
  if (v.type == Type::text && v.length > 0 && value.known()) {
    const std::string text = lowering.texts[value];
    if (const std::size_t characters = count_characters(text); characters > static_cast<std::size_t>(v.length)) {
      lowering.warn(Code::W0125, lowering.statement->span,
                    fmt::format("'{}' has {} characters, {} holds {}", text, characters, v.name, v.length),
                    "the rest is cut off; declare it longer");
      value = lowering.texts.value(first_characters(text, static_cast<std::size_t>(v.length)));
    }
  }
  value.type = v.type;
  return value;
}

}  // namespace

Variable* find_variable(Lowering& lowering, std::string_view name) {
  const std::string key = upper(name);
  for (auto scope = lowering.scopes.rbegin(); scope != lowering.scopes.rend(); ++scope)
    if (const auto it = lowering.variables.find(*scope + key); it != lowering.variables.end()) return &it->second;
  const auto it = lowering.variables.find(key);
  return it == lowering.variables.end() ? nullptr : &it->second;
}

Variable& declare(Lowering& lowering, std::string_view name, Type type, int length, int size, bool global) {
  const std::string key = (global || lowering.scopes.empty() ? "" : lowering.scopes.back()) + upper(name);
  Variable v;
  v.name = name;
  v.type = type;
  v.length = length;
  v.size = size;
  v.cells.resize(static_cast<std::size_t>(std::max(size, 1) * v.width()));
  v.slot = fmt::format("{}:{}", key, v.cells.size());
  return lowering.variables[key] = std::move(v);
}

Value read(Lowering& lowering, Variable& v, const std::optional<Value>& index) {
  check_use(v, index);
  if (const std::string* spoilt = lowering.symbols.spoilt.find(spoilt_key("", v.name)))
    throw Mistake{
        Code::E0230, 0, 0, fmt::format("{} has no usable value", v.name), fmt::format("because of {}", *spoilt), ""};
  Value out{v.type, {}};
  const int width = v.width();
  if (index && !index->known()) {
    store_all(lowering, v);
    for (int k = 0; k < width; ++k) {
      plan::Expression element = index->parts[0];
      element.push_back(plan::PushElement{{column(lowering, v, 0).value + k}, v.size, width});
      out.parts.push_back(std::move(element));
    }
    return out;
  }
  const int offset = index ? known_offset(v, *index) : 0;
  for (int k = 0; k < width; ++k) {
    const auto at = static_cast<std::size_t>(offset * width + k);
    const Cell& cell = v.cells[at];
    if (!cell.set) {
      const std::string name = index ? fmt::format("{}[{}]", v.name, offset + 1) : v.name;
      throw Mistake{
          Code::E0230, 0, 0, fmt::format("{} has no value yet", name), fmt::format("give it one: {}=ASSIGN/...", name),
          ""};
    }
    if (cell.known)
      out.parts.push_back({plan::PushConstant{cell.constant}});
    else
      out.parts.push_back({plan::PushColumn{column(lowering, v, at)}});
  }
  return out;
}

void assign(Lowering& lowering, Variable& v, const std::optional<Value>& index, Value given) {
  check_use(v, index);
  Value value = converted(lowering, v, std::move(given));
  const int width = v.width();
  if (index && !index->known()) {
    store_all(lowering, v);
    const plan::ColumnId at = lowering.evaluated(index->parts[0]);
    for (int k = 0; k < width; ++k)
      lowering.emit(plan::Assign{{column(lowering, v, 0).value + k},
                                 value.parts[static_cast<std::size_t>(k)],
                                 {plan::PushColumn{at}},
                                 v.size,
                                 width});
    for (Cell& cell : v.cells) cell = {true, false, true, 0};
    return;
  }
  const int offset = index ? known_offset(v, *index) : 0;
  // The parts of a vector may be made of the old parts: all are computed before any is changed.
  if (width > 1 && !value.known())
    for (plan::Expression& part : value.parts)
      if (!plan::constant(part)) part = {plan::PushColumn{lowering.evaluated(part)}};
  for (int k = 0; k < width; ++k) {
    const auto at = static_cast<std::size_t>(offset * width + k);
    const plan::Expression& part = value.parts[static_cast<std::size_t>(k)];
    if (const double* constant = plan::constant(part)) {
      v.cells[at] = {true, true, false, *constant};
    } else {
      lowering.emit(plan::Assign{column(lowering, v, at), part});
      v.cells[at] = {true, false, true, 0};
    }
  }
}

void store(Lowering& lowering, const VariableNames& names) {
  for (auto& [key, v] : lowering.variables)
    if (chosen(key, names)) store_all(lowering, v);
}

void forget(Lowering& lowering, const VariableNames& names) {
  for (auto& [key, v] : lowering.variables) {
    if (!chosen(key, names)) continue;
    // What is not set before a loop may be set by its first turn.
    for (Cell& cell : v.cells) cell = {true, false, true, 0};
  }
}

void merge(Variables& into, const Variables& other) {
  for (const auto& [key, theirs] : other) {
    const auto it = into.find(key);
    if (it == into.end() || it->second.cells.size() != theirs.cells.size()) {
      into[key] = theirs;
      continue;
    }
    for (std::size_t k = 0; k < theirs.cells.size(); ++k) {
      Cell& mine = it->second.cells[k];
      const Cell& other_cell = theirs.cells[k];
      const bool agree = mine.known && other_cell.known && mine.constant == other_cell.constant;
      mine.set |= other_cell.set;
      if (!it->second.first.valid()) it->second.first = theirs.first;
      if (!agree && (mine.set || other_cell.set)) mine = {mine.set, false, true, 0};
      mine.stored = mine.stored && other_cell.stored;
    }
  }
}

}  // namespace abbe::lang
