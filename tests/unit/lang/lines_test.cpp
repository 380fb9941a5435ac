#include "lang/lines.hpp"

#include <doctest/doctest.h>

using namespace abbe;
using namespace abbe::lang;

namespace {

std::vector<LogicalLine> lines_of(std::string text) { return logical_lines(SourceFile("test.dmi", std::move(text))); }

}  // namespace

TEST_CASE("a dollar at the end of a line joins it to the first column of the next") {
  const auto lines = lines_of("GO$\nTO/1$ \t\r\n  ,2\nENDFIL");
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].code.text() == "GOTO/1  ,2");
  CHECK(lines[0].line == 1);
  CHECK(lines[1].code.text() == "ENDFIL");
  CHECK(lines[1].line == 4);
}

TEST_CASE("the indentation before the rest of what was cut does not count, but in a quoted text") {
  const std::string text = "F(C0$\n    2F4)=TEXT/'a$\n  b',1$\n\t 0";
  const auto lines = lines_of(text);
  REQUIRE(lines.size() == 1);
  CHECK(lines[0].code.text() == "F(C02F4)=TEXT/'a  b',10");
  CHECK(lines_of("IF/(X$\n .EQ.$\n 3$\n - 1)")[0].code.text() == "IF/(X .EQ. 3 - 1)");
  CHECK(lines_of("GOTO/1$\n .5,2.$\n 5,3")[0].code.text() == "GOTO/1.5,2.5,3");
  const Span label = lines[0].code.span(4, 8);
  CHECK(text.substr(label.begin, label.end - label.begin) == "2F4)");
}

TEST_CASE("spans lead back to the bytes of the file") {
  const std::string text = "GO$\r\nTO/1,2";
  const auto lines = lines_of(text);
  const Span word = lines[0].code.span(0, 4);
  CHECK(text.substr(word.begin, word.end - word.begin) == "GO$\r\nTO");
  const Span second = lines[0].code.span(2, 4);
  CHECK(text.substr(second.begin, second.end - second.begin) == "TO");
  const Span last = lines[0].code.span(7, 8);
  CHECK(text.substr(last.begin, last.end - last.begin) == "2");
  const Span nothing = lines[0].code.span(4, 4);
  CHECK(nothing.begin == nothing.end);
}

TEST_CASE("comments stand after code, go on after a single dollar, and are not seen in strings") {
  const auto lines = lines_of("TEXT/OPER,'5 $$ each' $$ a price $\nfor each\n$$$$$$\nENDFIL");
  REQUIRE(lines.size() == 3);
  CHECK(lines[0].code.text() == "TEXT/OPER,'5 $$ each' ");
  REQUIRE(lines[0].comment.has_value());
  CHECK(lines[0].comment->text() == " a price for each");
  CHECK(lines[1].code.text().empty());
  CHECK(lines[2].code.text() == "ENDFIL");
}

TEST_CASE("a string may be cut, and a doubled quote does not end it") {
  const auto lines = lines_of("TEXT/OPER,'it''s $\nlong $$ and ''odd''' $$ comment");
  REQUIRE(lines.size() == 1);
  CHECK(lines[0].code.text() == "TEXT/OPER,'it''s long $$ and ''odd''' ");
}

TEST_CASE("byte order mark, carriage returns and a missing final newline") {
  const auto lines = lines_of(
      "\xEF\xBB\xBF"
      "A\rB\r\nC\nD$");
  REQUIRE(lines.size() == 4);
  CHECK(lines[0].code.text() == "A");
  CHECK(lines[0].code.file_offset(0) == 3);
  CHECK(lines[1].code.text() == "B");
  CHECK(lines[2].code.text() == "C");
  CHECK(lines[3].code.text() == "D");
}
