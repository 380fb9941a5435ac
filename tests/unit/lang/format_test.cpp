#include "lang/format.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "lang/blocks.hpp"
#include "lang/compile.hpp"
#include "lang/vocabulary.hpp"

namespace abbe::lang {

namespace fs = std::filesystem;

namespace {

std::string formatted(const std::string& text) { return format(SourceFile("t.dmi", text)); }

struct Meaning {
  std::string plan, codes;
  bool operator==(const Meaning&) const = default;
};

/// The plan and the messages, without their places.
Meaning meaning(const std::string& text) {
  Sink sink;
  const Compilation compilation = compile(SourceFile("t.dmi", text), sink);
  Meaning out{to_text(compilation.plan), ""};
  for (const Diagnostic& d : sink.list()) out.codes += fmt::format("{} ", info(d.code).name);
  return out;
}

/// All programs of the project.
std::vector<std::pair<std::string, std::string>> programs() {
  std::vector<std::pair<std::string, std::string>> out;
  for (const char* folder : {"tests/lang", "examples"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(ABBE_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".dmi") continue;
      std::ostringstream text;
      text << std::ifstream(entry.path(), std::ios::binary).rdbuf();
      out.emplace_back(entry.path().string(), text.str());
    }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

TEST_CASE("the style") {
  CHECK(formatted("f ( a b ) = feat / plane , cart , 0,0 ,0, 0,0,+1\n") == "F(a b)=FEAT/PLANE,CART,0,0,0,0,0,+1\n");
  CHECK(formatted("text/oper,'it''s $$ here' $$ a comment  \n") == "TEXT/OPER,'it''s $$ here' $$ a comment\n");
  CHECK(formatted("meas/plane,f(A),3\nptmeas/cart,1,2,3\n\n$$ note\nendmes") ==
        "MEAS/PLANE,F(A),3\n  PTMEAS/CART,1,2,3\n\n  $$ note\nENDMES\n");
  CHECK(formatted("if/(a .gt. 1)\ngoto/1,2,3\nelse\ngoto/x,y,z\nendif\n( l1 )\n") ==
        "IF/(a .gt. 1)\n  GOTO/1,2,3\nELSE\n  GOTO/x,y,z\nENDIF\n(l1)\n");
}

TEST_CASE("lines are joined, and cut only where they are too long") {
  CHECK(formatted("GO$\nTO/1$\n,2,3\n") == "GOTO/1,2,3\n");
  const std::string number(20, '1');
  CHECK(formatted(fmt::format("goto/{0},{0},{0},{0},{0}\n", number)) ==
        fmt::format("GOTO/{0},{0},{0},$\n    {0},{0}\n", number));
  const std::string text = fmt::format("TEXT/OPER,'{}'\n", std::string(100, 'x'));
  CHECK(formatted(text) == fmt::format("TEXT/OPER,$\n    '{}'\n", std::string(100, 'x')));
}

TEST_CASE("behind a last comma no line is begun, however long the statement") {
  for (int digits = 20; digits < 100; ++digits) {
    CAPTURE(digits);
    const std::string text = "F(A)=FEAT/POINT,CART," + std::string(digits, '1') + ",2,3,$\n \nGOTO/1,2,3\n";
    const std::string once = formatted(text);
    CHECK(once.ends_with("3,\nGOTO/1,2,3\n"));
    CHECK(formatted(once) == once);
    CHECK(meaning(once) == meaning(text));
  }
}

TEST_CASE("what is no statement, comments over lines, line ends and marks stay") {
  for (const std::string text : {"Please  do not touch\n", "TEXT/OPER,'not closed  \n", "  GOTO/(1,2\n",
                                 "$$ goes on $\n   here\n", "$$$$ a rule $$$$\n", "\xEF\xBB\xBFGOTO/1,2,3\r\n",
                                 "GOTO/1,2,3\r", "F(\xC4)=FEAT/POINT,CART,0,0,0,0,0,1\n", "GOTO/1,2,3\n\n\nENDFIL\n"})
    CHECK(formatted(text) == text);
  CHECK(formatted("") == "");
  CHECK(formatted("\n\n") == "");
}

TEST_CASE("formatting keeps the meaning, and formatting again changes nothing") {
  const auto all = programs();
  REQUIRE(all.size() > 40);
  for (const auto& [path, text] : all) {
    INFO(path);
    const std::string once = formatted(text);
    CHECK(formatted(once) == once);
    CHECK(meaning(once) == meaning(text));
  }
}

TEST_CASE("blanks and cuts of lines leave no trace") {
  std::mt19937 random(20261121);  // the standard fixes its sequence
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  int changed = 0;
  for (const auto& [path, text] : programs()) {
    if (path.find("lang/ok") == std::string::npos && path.find("examples") == std::string::npos) continue;
    if (text.find('\r') != std::string::npos || text.find("\xEF\xBB\xBF") == 0) continue;
    INFO(path);
    // Statements without comments and without cuts of their own, so that a cut may come anywhere.
    std::istringstream lines(text);
    std::string plain, mutated;
    for (std::string line; std::getline(lines, line);) {
      if (line.find('$') != std::string::npos) continue;
      plain += line + "\n";
      const bool statement = line.find('/') != std::string::npos;  // free text stays as it is
      bool quote = false;
      int depth = 0, slashes = 0;
      for (std::size_t at = 0; at < line.size(); ++at) {
        const char c = line[at];
        if (c == '\'') quote = !quote;
        depth += quote ? 0 : c == '(' ? 1 : c == ')' ? -1 : 0;
        // A second slash divides: blanks within expressions are the writer's.
        slashes += !quote && c == '/' ? 1 : 0;
        const bool separator =
            statement && !quote && depth == 0 && (c == ',' || (c == '/' && slashes == 1) || c == '=');
        if (separator && below(4) == 0) mutated += " ";
        mutated += c;
        if (separator && below(4) == 0) mutated += "\t ";
        // A blank behind a cut may be the indentation of the rest of a word.
        if (statement && line[at + 1] != ' ' && below(12) == 0) mutated += below(2) == 0 ? "$\n" : "$ \n";
      }
      mutated += "\n";
    }
    CHECK(formatted(mutated) == formatted(plain));
    CHECK(meaning(formatted(mutated)) == meaning(plain));
    changed += mutated != plain ? 1 : 0;
  }
  CHECK(changed > 20);
}

TEST_CASE("a program that forgets its ENDMES a thousand times stays small") {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += "MEAS/PLANE,F(A),3\n";
  CHECK(formatted(text).size() < 3 * text.size());
}

TEST_CASE("vocabulary") {
  CHECK(minor_words().contains("CART"));
  CHECK(minor_words().contains("CIRCLE"));
  CHECK(minor_words().contains("-XDIR"));
  const auto after = [](std::string_view statement) {
    Sink sink;
    const SourceFile source("t.dmi", std::string(statement));
    const auto raw = parse_statement(logical_lines(source).front(), source, sink);
    return fmt::format(" {} ", fmt::join(argument_words(raw->word, raw->arguments), " "));
  };
  CHECK(after("FEAT/").find(" PLANE ") != std::string::npos);
  CHECK(after("FEAT/CIRCLE").find(" INNER ") != std::string::npos);
  CHECK(after("TOL/DISTB").find(" NOMINL ") != std::string::npos);
  CHECK(after("TOL/").find(" PLANE ") == std::string::npos);
  CHECK(after("CONST/LINE,F(A)").find(" INTOF ") != std::string::npos);
  CHECK(argument_words("NOTHING", {}).empty());
  CHECK(shared_kind("FA") == "F");
  CHECK(shared_kind("DAT") == "DAT");
  const std::vector<std::string_view> majors = major_words();
  for (const std::string_view word : {"GOTO", "CALIB"}) CHECK(std::count(majors.begin(), majors.end(), word) == 1);
}

}  // namespace abbe::lang
