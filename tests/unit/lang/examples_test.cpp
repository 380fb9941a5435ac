// Every example of the reference (docs/language.md) compiles without an error, in a program that has what it names.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <map>
#include <set>

#include "engine/features/construct.hpp"
#include "engine/features/feature.hpp"
#include "engine/tolerances/tolerance.hpp"
#include "lang/compile.hpp"
#include "lang/labels.hpp"
#include "lang/statement.hpp"

using namespace abbe;
using namespace abbe::lang;

namespace {

/// What stands around an example of a word that cannot stand alone; {} is the example.
const std::map<std::string_view, const char*> kAround = {
    {"MEAS", "{}\nENDMES"},
    {"RMEAS", "{}\nENDMES"},
    {"CALIB", "{}\nENDMES"},
    {"PTMEAS", "MEAS/CIRCLE,F(ANY),3\n{}\n{}\n{}\nENDMES"},
    {"ENDMES", "MEAS/CIRCLE,F(ANY),4\n{}"},
    {"IF", "{}\nENDIF"},
    {"ELSE", "IF/(1 .LT. 2)\n{}\nENDIF"},
    {"ENDIF", "IF/(1 .LT. 2)\n{}"},
    {"DO", "{}\nENDDO"},
    {"ENDDO", "DO/I,1,2\n{}"},
    {"SELECT", "{}\nENDSEL"},
    {"CASE", "SELECT/1\n{}\nENDCAS\nENDSEL"},
    {"DFTCAS", "SELECT/1\n{}\nENDCAS\nENDSEL"},
    {"ENDCAS", "SELECT/1\nCASE/1\n{}\nENDSEL"},
    {"ENDSEL", "SELECT/1\n{}"},
    {"JUMPTO", "{}\n(AGAIN)"},
    {"MACRO", "{}\nENDMAC"},
    {"ENDMAC", "M(EMPTY)=MACRO/Q\n{}"},
    {"XTERN", "{}\nENDXTN"},
    {"EXTFIL", "XTERN\n{}\nENDXTN"},
    {"ENDXTN", "XTERN\n{}"}};

std::string circle(const std::string& label) {
  return fmt::format("F({0})=FEAT/CIRCLE,INNER,CART,50,50,0,0,0,1,20\nMEAS/CIRCLE,F({0}),4\nENDMES\n", label);
}

/// Definitions of all labels that the example uses and does not define itself.
std::string definitions(const std::string& example) {
  std::string out = circle("ANY");
  std::set<std::string> done;
  for (const LabelUse& use : label_uses(SourceFile("example", example))) {
    if (use.definition || !done.insert(use.kind + upper(use.name)).second) continue;
    if (use.kind == "F") out += circle(use.name);
    if (use.kind == "D") out += fmt::format("D({})=TRANS/XORIG,1\n", use.name);
    if (use.kind == "S") out += fmt::format("S({})=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,100,4\n", use.name);
    if (use.kind == "DAT") out += fmt::format("DATDEF/FA(ANY),DAT({})\n", use.name);
    if (use.kind == "T") out += fmt::format("T({})=TOL/CIRLTY,0.01\n", use.name);
    if (use.kind == "M") out += fmt::format("M({})=MACRO/'NAME',U,V\nENDMAC\n", use.name);
  }
  return out;
}

std::string program(std::string_view word, std::string_view example) {
  const std::string text(example);
  const bool first = word == "DMISMN" || word == "DMISMD";
  const auto around = kAround.find(word);
  std::string body = text;
  if (around != kAround.end()) {
    body = around->second;
    for (std::size_t at = body.find("{}"); at != std::string::npos; at = body.find("{}", at + text.size())) body.replace(at, 2, text);
  }
  if (first) return body + "\nENDFIL\n";
  return "DMISMN/'example',5.2\nSNSET/APPRCH,5\nDECL/REAL,X,Y\nDECL/INTGR,I,N\nX=ASSIGN/1\nY=ASSIGN/2\nN=ASSIGN/3\n"
         "S(ANY)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,100,4\nSNSLCT/S(ANY)\n" +
         definitions(text) + body + "\nENDFIL\n";
}

void check_example(std::string_view word, std::string_view example) {
  // Modules are looked for beside the program.
  const SourceFile source(std::string(ABBE_SOURCE_DIR) + "/tests/lang/modules/example.dmi", program(word, example));
  Sink sink;
  compile(source, sink, {{{"X", "1"}}});
  std::string messages;
  for (const Diagnostic& d : sink.sorted()) messages += render(d);
  INFO(source.text());
  INFO(messages);
  if (word == "READ") {  // its help says that it is an error
    REQUIRE(sink.list().size() == 1);
    CHECK(sink.list()[0].code == Code::E0258);
  } else {
    CHECK_FALSE(sink.has_errors());
  }
}

}  // namespace

TEST_CASE("the examples of statements, features, constructions and tolerances compile") {
  for (const Statement* s : statements()) check_example(s->word, s->example);
  for (const FeatureKind* k : feature_kinds()) check_example(k->word, k->example);
  for (const Construction* c : constructions()) check_example(c->word, c->example);
  for (const ToleranceKind* t : tolerance_kinds()) check_example(t->word, t->example);
}
