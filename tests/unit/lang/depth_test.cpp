// No program exhausts the stack, however deep its blocks are nested.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "lang/compile.hpp"

using namespace abbe;
using namespace abbe::lang;

namespace {

std::string times(int n, const std::string& text) {
  std::string out;
  for (int k = 0; k < n; ++k) out += text;
  return out;
}

/// A program in which X is a measured value.
std::string measured(const std::string& body) {
  return "DMISMN/'deep',5.2\nS(P)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,100,4\nSNSLCT/S(P)\nF(A)=FEAT/POINT,CART,1,2,3,0,0,1\nMEAS/POINT,F(A),1\n"
         "PTMEAS/CART,1,2,3,0,0,1\nENDMES\nDECL/REAL,X\nX=OBTAIN/FA(A),6\n" +
      body + "ENDFIL\n";
}

std::string messages(const std::string& text) {
  Sink sink;
  compile(SourceFile("deep.dmi", text), sink);
  std::string out;
  for (const Diagnostic& d : sink.list()) out += fmt::format("{}{}", out.empty() ? "" : " ", info(d.code).name);
  return out;
}

}  // namespace

TEST_CASE("blocks are nested as deep as the limit, and no deeper") {
  const auto nested = [](int n, const std::string& begin, const std::string& end) {
    return measured(times(n, begin) + times(n, end));
  };
  for (const auto& [begin, end] : {std::pair{"IF/(.TRUE.)\n", "ENDIF\n"}, {"DO/I,1,1\n", "ENDDO\n"}}) {
    INFO(begin);
    CHECK(messages(nested(256, begin, end)) == "");
    CHECK(messages(nested(257, begin, end)) == "E0126");
    CHECK(messages(nested(20'000, begin, end)) == "E0126");
  }
  for (const auto& [begin, end] :
       {std::pair{"IF/(X .GT. 1)\n", "ENDIF\n"}, {"IF/(X .GT. 1)\nELSE\n", "ENDIF\n"}, {"DO/I,1,X\n", "ENDDO\n"}}) {
    INFO(begin);
    CHECK(messages(nested(256, begin, end)) == "");
    CHECK(messages(nested(5'000, begin, end)) == "E0126");
  }
}

TEST_CASE("cases of a measured value are nested too") {
  std::string cases;
  for (int k = 0; k < 5'000; ++k) cases += fmt::format("CASE/{}\nENDCAS\n", k);
  CHECK(messages(measured("SELECT/X\n" + cases + "ENDSEL\n")) == "E0126");
  CHECK(messages(measured("DECL/REAL,Y\nY=ASSIGN/4999\nSELECT/Y\n" + cases + "ENDSEL\n")) == "");
}

TEST_CASE("macros with deep blocks call each other") {
  std::string text;
  for (int k = 0; k < 20; ++k)
    text += fmt::format("M(A{})=MACRO\n{}CALL/M(A{})\n{}ENDMAC\n", k, times(20, "IF/(X .GT. 1)\n"), k + 1,
                        times(20, "ENDIF\n"));
  CHECK(messages(measured(text + "M(A20)=MACRO\nENDMAC\nCALL/M(A0)\n")) == "E0126");
}

TEST_CASE("expressions over measured values are limited, constants and texts of calls too") {
  const auto sum = [](int n) { return measured("X=ASSIGN/X" + times(n, "+X") + "\n"); };
  CHECK(messages(sum(4'999)) == "");
  CHECK(messages(sum(5'000)) == "E0104");
  const auto units = [](int n) {
    return measured("DECL/VECTOR,V\nV=ASSIGN/VCART(X,1,2)\nV=ASSIGN/" + times(n, "VUNIT(") + "V" + times(n, ")") +
                    "\n");
  };
  CHECK(messages(units(3)) == "");
  CHECK(messages(units(60)) == "E0104");
  const auto handed_on = [](const std::string& first) {
    std::string macros = "M(M0)=MACRO/A\nGOTO/A,1,1\nENDMAC\n";
    for (int k = 1; k < 30; ++k) macros += fmt::format("M(M{})=MACRO/A\nCALL/M(M{}),(A+A)/2\nENDMAC\n", k, k - 1);
    return measured(macros + "CALL/M(M29)," + first + "\n");
  };
  CHECK(messages(handed_on("1")) == "");
  CHECK(messages(handed_on("X")) == "E0104");
}
