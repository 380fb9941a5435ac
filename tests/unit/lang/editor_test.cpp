// The grammar for editors has its words from the tables of the compiler.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "lang/blocks.hpp"
#include "lang/directives.hpp"
#include "lang/vocabulary.hpp"

namespace abbe::lang {

namespace {

const std::string kEditor = std::string(ABBE_SOURCE_DIR) + "/lang/editor/";

nlohmann::ordered_json read_json(const std::string& path) {
  return nlohmann::ordered_json::parse(std::ifstream(kEditor + path));
}

std::string alternatives(const std::vector<std::string_view>& words) {
  return fmt::format("{}", fmt::join(words, "|"));
}

}  // namespace

TEST_CASE("the grammar for editors knows the words of the language") {
  std::vector<std::string_view> kinds, directive_words;
  for (const LabelKind& kind : label_kinds()) kinds.push_back(kind.kind);
  for (const DirectiveHelp& directive : directives()) directive_words.push_back(directive.word);
  const std::string majors = alternatives(major_words());
  const std::string file = "syntaxes/dmis.tmLanguage.json";
  const nlohmann::ordered_json found = read_json(file);
  nlohmann::ordered_json expected = found;
  nlohmann::ordered_json& rules = expected["repository"];
  rules["statement"]["match"] = fmt::format("(?i)^\\s*({})(?![A-Z0-9_(])(?!\\s*=)", majors);
  rules["statement_of_label"]["match"] = fmt::format("(?i)(=)\\s*({})(?![A-Z0-9_(])", majors);
  rules["label"]["match"] = fmt::format("(?i)\\b({})\\s*(\\([^(),]*\\))", alternatives(kinds));
  rules["directive"]["patterns"][0]["match"] = fmt::format("\\b(?:{})\\b", alternatives(directive_words));
  if (std::getenv("ABBE_REFRESH_GOLDEN")) std::ofstream(kEditor + file) << expected.dump(2) << "\n";
  INFO("ABBE_REFRESH_GOLDEN=1 test_lang writes the grammar anew");
  CHECK(read_json(file) == expected);
}

TEST_CASE("editors indent by the blocks of the language") {
  const auto rules = read_json("language-configuration.json")["indentationRules"];
  const std::string more = rules["increaseIndentPattern"].get<std::string>().substr(4);
  const std::string less = rules["decreaseIndentPattern"].get<std::string>().substr(4);
  for (const Block& block : blocks()) {
    INFO(block.begin);
    CHECK(std::regex_search(std::string(block.begin), std::regex(more)));
    CHECK(std::regex_search(std::string(block.end), std::regex(less)));
    if (block.middle.empty()) continue;
    CHECK(std::regex_search(std::string(block.middle), std::regex(more)));
    CHECK(std::regex_search(std::string(block.middle), std::regex(less)));
  }
}

}  // namespace abbe::lang
