// What holds for every statement of the list, and what single statements put into the plan beyond
// its text.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <set>

#include "engine/features/construct.hpp"
#include "engine/features/feature.hpp"
#include "engine/tolerances/tolerance.hpp"
#include "lang/compile.hpp"
#include "lang/parser.hpp"
#include "lang/reference.hpp"
#include "lang/statement.hpp"

using namespace abbe;
using namespace abbe::lang;

namespace {

struct Compiled {
  Compilation result;
  Sink sink;
};

Compiled compile_text(const std::string& text) {
  Compiled out;
  out.result = compile(SourceFile("test.dmi", text), out.sink);
  return out;
}

}  // namespace

TEST_CASE("every statement explains itself and its example fits its signature") {
  std::set<std::string_view> words;
  for (const Statement* s : statements()) {
    INFO(s->word);
    CHECK(words.insert(s->word).second);
    CHECK(find_statement(s->word) == s);
    CHECK((is_standard_word(s->word) || s->word == "PAUSE"));
    CHECK(s->help.size() > 10);
    CHECK_FALSE(s->source.empty());
    const SourceFile source("example", std::string(s->example));
    Sink sink;
    const auto raw = parse_statement(logical_lines(source).at(0), source, sink);
    REQUIRE(raw.has_value());
    CHECK(raw->word == s->word);
    CHECK(std::holds_alternative<Match>(match(parse_signature(s->signature), raw->arguments, Units{},
                                              [](const RawArgument&) -> Evaluation { return boolean(true); })));
    const std::string label = !raw->label ? "" : raw->label->kind.empty() ? "=" : raw->label->kind;
    if (s->label != "*") CHECK(label == s->label);
  }
}

TEST_CASE("the signatures that the engine publishes are in the notation") {
  for (const FeatureKind* k : feature_kinds()) CHECK_NOTHROW(parse_signature(k->signature));
  for (const Construction* c : constructions()) CHECK_NOTHROW(parse_signature(c->signature));
  for (const ToleranceKind* t : tolerance_kinds()) CHECK_NOTHROW(parse_signature(t->signature));
}

TEST_CASE("the help knows every word that compiles") {
  const std::string markdown = reference_markdown(), list = list_of_words();
  for (const Statement* s : statements()) {
    REQUIRE(explain_word(s->word).has_value());
    CHECK(explain_word(s->word)->find(s->help) != std::string::npos);
    CHECK(markdown.find(s->word) != std::string::npos);
    CHECK(list.find(s->word) != std::string::npos);
  }
  CHECK(explain_word("circle").has_value());
  CHECK(explain_word("SCNMOD")->find("not supported yet") != std::string::npos);
  CHECK_FALSE(explain_word("wibble").has_value());
}

TEST_CASE("directives reach the compilation") {
  const Compiled c = compile_text(
      "$$! machine coord3-mc16  machines 200 seed 18446744073709551615\n$$! workpiece block.json "
      "place 1 -2.5 3e2\n"
      "$$! expect accepted between 0.3 0.45\n$$! expect accepted >= 0.3\n$$! expect accepted between 0.3 0.3\n"
      "UNITS/INCH,ANGDEC\n");
  CHECK_FALSE(c.sink.has_errors());
  const Directives& d = c.result.directives;
  CHECK(d.machine == "coord3-mc16");
  CHECK(d.machines == 200);
  CHECK(d.seed == 18446744073709551615u);
  CHECK(d.workpiece == "block.json");
  REQUIRE(d.place_mm.has_value());
  CHECK(*d.place_mm == Vec3{1, -2.5, 300});
  REQUIRE(d.expectations.size() == 3);
  CHECK(d.expectations[0].subject == "accepted");
  CHECK(d.expectations[0].low == 0.3);
  CHECK(d.expectations[0].high == 0.45);
  CHECK(d.expectations[0].line == 3);
  CHECK(d.expectations[0].text == "expect accepted between 0.3 0.45");
  CHECK_FALSE(d.expectations[1].high.has_value());
  CHECK(d.expectations[2].high == 0.3);
}

TEST_CASE("an operation carries the statement that it came from") {
  const std::string text = "DMISMN/'spans'\nGO$\nTO/1,2,3 $$ there\nENDFIL\n";
  const Compiled c = compile_text(text);
  REQUIRE(c.result.plan.operations.size() == 1);
  const plan::Operation& o = c.result.plan.operations[0];
  CHECK(o.line == 2);
  CHECK(text.substr(o.span.begin, o.span.end - o.span.begin) == "GO$\nTO/1,2,3");
}

TEST_CASE("messages say what was written and offer the nearest word") {
  const Compiled c = compile_text("DMISMN/'near'\nPTMAES/CART,1,2,3\nMODE/PRAG\nENDFIL\n");
  REQUIRE(c.sink.list().size() == 2);
  CHECK(c.sink.list()[0].help == "did you mean PTMEAS?");
  CHECK(c.sink.list()[0].replacement == "PTMEAS");
  CHECK(c.sink.list()[1].message == "argument 1 of MODE is 'PRAG', expected AUTO|PROG|MAN");
  CHECK(c.sink.list()[1].help == "did you mean PROG?");
}

TEST_CASE("where a statement may end, the message about an argument says so") {
  const Compiled c = compile_text("DMISMN/'end'\nT(P)=TOL/PERP,0.05,RFS,DAT(A),DAT(B)\nENDFIL\n");
  REQUIRE(c.sink.list().size() == 1);
  CHECK(c.sink.list()[0].message == "argument 5 of TOL/PERP is 'DAT(B)', expected MMC|LMC|RFS or nothing more");
}

TEST_CASE("a common datum is said to be constructed") {
  const Compiled c = compile_text(
      "DMISMN/'common'\nSNSLCT/SA(P)\nF(J)=FEAT/CYLNDR,OUTER,CART,0,0,0,0,0,1,20,9\nMEAS/CYLNDR,F(J),6\nENDMES\n"
      "DATDEF/FA(J),DAT(A)\nDATDEF/FA(J),DAT(B)\nT(R)=TOL/CRNOUT,0.05,DAT(A-B)\nOUTPUT/FA(J),TA(R)\nENDFIL\n");
  REQUIRE(c.sink.list().size() == 1);
  CHECK(c.sink.list()[0].message == "datum DAT(A-B) is not defined above");
  CHECK(c.sink.list()[0].help.ends_with("bind it with DATDEF/FA(both),DAT(A-B)"));
}

TEST_CASE("what is lost says why") {
  const Compiled c = compile_text(
      "DMISMN/'lost'\nSNSLCT/SA(P)\nF(A)=FEAT/POINT,CART,0,0,0,0,0\nT(T)=TOL/CORTOL,XAXIS,-1,1\n"
      "MEAS/POINT,F(A),1\nPTMEAS/CART,0,0,0,0,0,1\nENDMES\nOUTPUT/FA(A),TA(T)\nENDFIL\n");
  CHECK(c.sink.list().size() == 1);
  REQUIRE(c.result.lost.size() == 1);
  CHECK(c.result.lost[0].line == 8);
  CHECK(c.result.lost[0].feature == "A");
  CHECK(c.result.lost[0].reason.find("line 3") != std::string::npos);
  CHECK(c.result.plan.characteristics.empty());
}

/// Processor time of four times as much text over that of the text, the best of three each: 4 where a line
/// costs the same in both, 16 where it costs in proportion to their number.
template <class Program>
double cost_of_four_times(int lines, Program program) {
  const auto seconds = [&](int n) {
    const std::string text = program(n);
    double best = 1e9;
    for (int k = 0; k < 3; ++k) {
      const std::clock_t begin = std::clock();
      compile_text(text);
      best = std::min(best, double(std::clock() - begin) / CLOCKS_PER_SEC);
    }
    return best;
  };
  return seconds(4 * lines) / seconds(lines);
}

TEST_CASE("the time that a program takes grows with its length") {
  const auto program = [](int points) {
    std::string text = "DMISMN/'long'\nSNSLCT/SA(P)\n";
    for (int i = 0; i < points; ++i)
      text += fmt::format(
          "F(P{0})=FEAT/POINT,CART,{0},0,0,0,0,1\nMEAS/POINT,F(P{0}),1\nPTMEAS/"
          "CART,{0},0,0,0,0,1\nENDMES\nOUTPUT/FA(P{0})\n",
          i);
    return text + "ENDFIL\n";
  };
  const Compiled c = compile_text(program(10000));
  CHECK(c.sink.list().empty());
  CHECK(c.result.plan.features.size() == 10000);
  CHECK(cost_of_four_times(2500, program) < 9);
}

TEST_CASE("a thousand jumps on measured values are found in a few passes") {
  const auto program = [](int jumps) {
    std::string text = "DMISMN/'jumps'\nSNSLCT/SA(P)\nDECL/REAL,X\n";
    for (int i = 0; i < jumps; ++i)
      text += fmt::format(
          "F(P{0})=FEAT/POINT,CART,{0},0,0,0,0,1\nMEAS/POINT,F(P{0}),1\nPTMEAS/CART,{0},0,0,0,0,1\nENDMES\n"
          "X=OBTAIN/FA(P{0}),6\nIF/(X .GT. 0.1)\nJUMPTO/(END)\nENDIF\n",
          i);
    return text + "(END)\nENDFIL\n";
  };
  const Compiled c = compile_text(program(1000));
  CHECK(c.sink.list().empty());
  CHECK(c.result.plan.features.size() == 1000);
  CHECK(cost_of_four_times(250, program) < 9);
}

namespace {

/// Where the GOTO statements of a program lead along x.
std::vector<double> goto_places(const Compilation& c) {
  std::vector<double> x;
  for (const plan::Operation& o : c.plan.operations)
    if (const auto* move = std::get_if<plan::Move>(&o.action)) x.push_back(move->to[0].constant);
  return x;
}

}  // namespace

TEST_CASE("the turns of a DO are counted, not added up") {
  const auto places = [](const std::string& text) { return goto_places(compile_text(text).result); };
  const std::vector<double> tenths = places("DECL/REAL,X\nDO/X,0,0.3,0.1\nGOTO/X,0,0\nENDDO\nGOTO/X,0,0\n");
  REQUIRE(tenths.size() == 5);
  for (int k = 0; k < 5; ++k) CHECK(tenths[k] == doctest::Approx(0.1 * k));
  CHECK(places("DECL/INTGR,I\nDO/I,0,2,0.5\nGOTO/I,0,0\nENDDO\n") == std::vector<double>{0, 0, 1, 1, 2});
  CHECK(places("DO/X,0,1,0.5\nGOTO/X,0,0\nENDDO\n") == std::vector<double>{0, 0.5, 1});
  CHECK(places("DO/X,0.5,2\nGOTO/X,0,0\nENDDO\n") == std::vector<double>{0.5, 1.5});
  CHECK(places("DO/I,3,1,-1\nGOTO/I,0,0\nENDDO\n") == std::vector<double>{3, 2, 1});
  CHECK(places("DO/I,3,1\nGOTO/I,0,0\nENDDO\n").empty());
}

TEST_CASE("signs, negations and whole numbers are what they say") {
  const auto places = [](const std::string& text) { return goto_places(compile_text(text).result); };
  CHECK(places("GOTO/3*(--2),0,0\nGOTO/3*(-+2),0,0\n") == std::vector<double>{6, -6});
  CHECK(places("IF/(.NOT. .NOT. (1 .GT. 2))\nGOTO/1,0,0\nENDIF\n").empty());
  // What is no whole number is cut off by INTGR, whatever the numbers that it is made of.
  CHECK(places("DECL/INTGR,I\nI=ASSIGN/2**-1\nGOTO/I,0,0\nI=ASSIGN/MX(1,2.5)\nGOTO/I,0,0\n") ==
        std::vector<double>{0, 2});
  CHECK(places("SELECT/1\nCASE/1\nGOTO/1,0,0\nENDCAS\nDFTCAS\nGOTO/2,0,0\nENDCAS\nENDSEL\n") == std::vector<double>{1});
  // An index counts, also where it is computed.
  for (const char* half : {"DECL/REAL,A[2],X\nA[1]=ASSIGN/1\nX=ASSIGN/A[1.5]\n",
                           "DECL/REAL,X\nX=ASSIGN/3.5\nF(P)=FEAT/POINT,CART,1,2,3,0,0,1\nX=OBTAIN/F(P),X\n"})
    CHECK_MESSAGE(compile_text(half).sink.has_errors(), std::string(half));
}

TEST_CASE("angles are degrees where UNITS says nothing of them, and where colons stand in them") {
  const auto places = [](const std::string& text) { return goto_places(compile_text(text).result); };
  CHECK(places("UNITS/INCH\nGOTO/POL,2,60,0\n").at(0) == doctest::Approx(25.4));  // cos 60 degrees is a half
  CHECK(places("UNITS/MM,ANGRAD\nGOTO/POL,2,60:00:00,0\n").at(0) == doctest::Approx(1));
  CHECK(compile_text("GOTO/POL,2,59:60:00,0\n").sink.has_errors());
}

TEST_CASE("a matrix of few decimals is squared up") {
  const Compiled c = compile_text("D(M)=DATSET/TRMATX,1,0.0005,0,0,1,0,0,0,1,7,8,9\n");
  REQUIRE(c.result.plan.operations.size() == 1);
  const Rigid X_MD = std::get<plan::SetMatrixFrame>(c.result.plan.operations[0].action).X_MD;
  CHECK(std::fabs(dot(X_MD.R.cx, X_MD.R.cy)) < 1e-15);
  CHECK(norm(X_MD.R.cy) == doctest::Approx(1).epsilon(1e-15));
  CHECK(X_MD.p == Vec3{7, 8, 9});
}

TEST_CASE("a stylus hangs down whatever the sign of its length") {
  const Compiled c = compile_text("S(P)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,-150,4\n");
  CHECK(c.result.plan.sensors.at(0).tip_in_r == Vec3{0, 0, -150});
}

TEST_CASE("a tolerance is the one that its numbers make, however they are written") {
  // X is another number the second time; limits that are the same number are limits in order.
  const Compiled c = compile_text(
      "DMISMN/'sizes'\nSNSLCT/SA(P)\nF(C)=FEAT/CIRCLE,INNER,CART,0,0,0,0,0,1,10\nMEAS/CIRCLE,F(C),4\nENDMES\nDECL/REAL,X\n"
      "X=ASSIGN/0.1\nT(D)=TOL/DIAM,-X,X\nOUTPUT/FA(C),TA(D)\nX=ASSIGN/0\nT(D)=TOL/DIAM,-X,X\nOUTPUT/FA(C),TA(D)\nENDFIL\n");
  REQUIRE(c.sink.list().size() == 1);
  CHECK(c.sink.list()[0].code == Code::N0611);
  const plan::Plan& plan = c.result.plan;
  REQUIRE(plan.characteristics.size() == 2);
  CHECK(plan[plan.characteristics[0].tolerance].arguments.number("upper") == 0.1);
  CHECK(plan[plan.characteristics[1].tolerance].arguments.number("upper") == 0);
}

TEST_CASE("texts are counted in characters, whatever their bytes") {
  const auto places = [](const std::string& text) { return goto_places(compile_text(text).result); };
  CHECK(places("GOTO/LEN('Ä€x'),0,0\nGOTO/INDX('Ä€x','x'),0,0\nGOTO/ORD('Ä'),0,0\nGOTO/ORD(CHR(196)),0,0\n") ==
        std::vector<double>{3, 3, 196, 196});
  CHECK(places("GOTO/LEN(SUBSTR('ab',3,2)),0,0\n") == std::vector<double>{0});  // behind the last one is nothing
  const std::string same = "GOTO/1,0,0\nENDIF\n";
  CHECK(places("IF/(SUBSTR('Ä€x',2,2) .EQ. '€')\n" + same) == std::vector<double>{1});
  CHECK(places("IF/(UPC('äσςß') .EQ. 'ÄΣΣß')\n" + same) == std::vector<double>{1});
  CHECK(places("IF/(LWC('ÄΣŸДЖΜ') .EQ. 'äσÿджμ')\n" + same) == std::vector<double>{1});
  CHECK(places("DECL/CHAR,2,T\nT=ASSIGN/'Ä€x'\nIF/(T .EQ. 'Ä€')\n" + same) == std::vector<double>{1});
}
