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
const std::map<std::string_view, const char*> kAround = {{"MEAS", "{}\nENDMES"},
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

/// By label in upper case; a circle where there is none.
using Kinds = std::map<std::string, std::string>;

std::string feature(const std::string& label, const Kinds& kinds = {}) {
  static const std::map<std::string, const char*> kForms = {{"POINT", "CART,50,50,0,0,0,1"},
                                                            {"LINE", "UNBND,CART,50,50,0,1,0,0,0,0,1"},
                                                            {"PLANE", "CART,50,50,0,0,0,1"},
                                                            {"CIRCLE", "INNER,CART,50,50,0,0,0,1,20"},
                                                            {"CONE", "INNER,CART,50,50,-10,0,0,1,90"}};
  const auto found = kinds.find(upper(label));
  const std::string kind = found == kinds.end() ? "CIRCLE" : found->second;
  std::string out = fmt::format("F({0})=FEAT/{1},{2}\nMEAS/{1},F({0}),6\n", label, kind, kForms.at(kind));
  if (kind == "CONE")  // which has no default points
    for (const char* at : {"55,50,-5", "50,55,-5", "45,50,-5", "58,50,-2", "50,58,-2", "42,50,-2"})
      out += fmt::format("PTMEAS/CART,{}\n", at);
  return out + "ENDMES\n";
}

/// The kind that a CONST statement names, for its result; for the features it takes, kinds of which the
/// method makes that.
Kinds kinds_in(const Construction& method, const std::string& example) {
  const std::size_t begin = example.find('/') + 1;
  const std::string result = example.substr(begin, example.find(',') - begin);
  std::vector<std::string> labels;
  for (const LabelUse& use : label_uses(SourceFile("example", example))) labels.push_back(upper(use.name));
  const std::vector<std::string> words{"POINT", "LINE", "PLANE", "CIRCLE", "CONE"};
  std::size_t combinations = 1;
  for (std::size_t i = 1; i < labels.size(); ++i) combinations *= words.size();
  for (std::size_t c = 0; c < combinations; ++c) {
    Kinds kinds{{labels[0], result}};
    std::vector<Shape> shapes;
    for (std::size_t i = 1, rest = c; i < labels.size(); ++i, rest /= words.size()) {
      kinds[labels[i]] = words[rest % words.size()];
      shapes.push_back(find_feature_kind(kinds[labels[i]])->shape);
    }
    if (!method.applies(find_feature_kind(result)->shape, shapes)) return kinds;
  }
  FAIL("the example cannot be: ", example);
  return {};
}

/// Definitions of all labels that the example uses and does not define itself.
std::string definitions(const std::string& example, const Kinds& kinds) {
  std::string out = feature("ANY");
  std::set<std::string> done;
  for (const LabelUse& use : label_uses(SourceFile("example", example))) {
    if (use.definition || !done.insert(use.kind + upper(use.name)).second) continue;
    if (use.kind == "F") out += feature(use.name, kinds);
    if (use.kind == "D") out += fmt::format("D({})=TRANS/XORIG,1\n", use.name);
    if (use.kind == "S") out += fmt::format("S({})=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,100,4\n", use.name);
    if (use.kind == "DAT") out += fmt::format("DATDEF/FA(ANY),DAT({})\n", use.name);
    if (use.kind == "T") out += fmt::format("T({})=TOL/CIRLTY,0.01\n", use.name);
    if (use.kind == "M") out += fmt::format("M({})=MACRO/'NAME',U,V\nENDMAC\n", use.name);
  }
  return out;
}

std::string program(std::string_view word, std::string_view example, const Kinds& kinds) {
  const std::string text(example);
  const bool first = word == "DMISMN" || word == "DMISMD";
  const auto around = kAround.find(word);
  std::string body = text;
  if (around != kAround.end()) {
    body = around->second;
    for (std::size_t at = body.find("{}"); at != std::string::npos; at = body.find("{}", at + text.size()))
      body.replace(at, 2, text);
  }
  if (first) return body + "\nENDFIL\n";
  return "DMISMN/'example',5.2\nSNSET/APPRCH,5\nDECL/REAL,X,Y\nDECL/INTGR,I,N\nX=ASSIGN/1\nY=ASSIGN/2\nN=ASSIGN/3\n"
         "S(ANY)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,100,4\nSNSLCT/S(ANY)\n" +
      definitions(text, kinds) + body + "\nENDFIL\n";
}

void check_example(std::string_view word, std::string_view example, const Kinds& kinds = {}) {
  // Modules are looked for beside the program.
  const SourceFile source(std::string(ABBE_SOURCE_DIR) + "/tests/lang/modules/example.dmi",
                          program(word, example, kinds));
  Sink sink;
  const bool asks = word == "PROMPT";
  compile(source, sink, asks ? CompileOptions{{{"X", "1"}}} : CompileOptions{});
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
  for (const Statement* s : statements()) {
    const bool constructs = s->word == "CONST";
    check_example(s->word, s->example,
                  constructs ? kinds_in(*find_construction("INTOF"), std::string(s->example)) : Kinds{});
  }
  for (const FeatureKind* k : feature_kinds()) check_example(k->word, k->example);
  for (const Construction* c : constructions())
    check_example(c->word, c->example, kinds_in(*c, std::string(c->example)));
  for (const ToleranceKind* t : tolerance_kinds()) check_example(t->word, t->example);
}
