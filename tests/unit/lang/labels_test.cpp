// Which names a text defines and uses, and which of them are the same.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "lang/labels.hpp"

namespace abbe::lang {

namespace {

/// "KIND:NAME" of all uses, in order: definitions with =, computed labels with ?, the scope behind # unless it is 0.
std::string uses(const std::string& text) {
  std::string out;
  const SourceFile source("program", text);
  for (const LabelUse& use : label_uses(source)) {
    CHECK(source.text(use.name_span) == use.name);
    CHECK(use.span.begin <= use.name_span.begin);
    CHECK(use.name_span.end <= use.span.end);
    out += fmt::format("{}{}:{}{}{}{}", out.empty() ? "" : " ", use.kind, use.name, use.definition ? "=" : "",
                       use.computed ? "?" : "", use.scope > 0 ? fmt::format("#{}", use.scope) : "");
  }
  return out;
}

}  // namespace

TEST_CASE("labels share the names of their kinds") {
  CHECK(uses("T(D)=TOL/DIAM,-1,1\nOUTPUT/FA( A ),TA(D)\n") == "T:D= F:A T:D");
  CHECK(uses("DATDEF/FA(P),DAT(A)\nD(X)=DATSET/DAT(A),ZDIR\n") == "F:P DAT:A= D:X= DAT:A");
  CHECK(uses("TEXT/OPER,'F(A)'\n$$ F(A)\n").empty());
}

TEST_CASE("variables are what a program declares or gives a value") {
  CHECK(uses("DECL/GLOBAL,REAL,X,A[5]\nDECL/CHAR,20,S\nDECL/LOCAL,CHAR,C\n") == ":X= :A= :S= :C=");
  CHECK(uses("Y=ASSIGN/1\nA [Y]=ASSIGN/SQRT(Y)+Z+'Y'\n") == ":Y= :A= :Y :Y");
  CHECK(uses("DO/I,1,N\nGOTO/I,1E5,0\nENDDO\n") == ":I= :I");
  CHECK(uses("DECL/REAL,CART,EQ\nGOTO/CART,CART+1,0,0\nIF/(CART.EQ.EQ)\nENDIF\n") == ":CART= :EQ= :CART :CART :EQ");
}

TEST_CASE("what a label is computed from is a use of its own") {
  CHECK(uses("DECL/INTGR,I,K[3]\nF(H@I)=FEAT/POINT,CART,0,0,0,0,0,1\nOUTPUT/FA(@K[I]-1)\n") ==
        ":I= :K= F:H@I=? :I F:@K[I]-1? :K :I");
}

TEST_CASE("names in a macro are its own where it declares them or has them as arguments") {
  CHECK(uses("X=ASSIGN/1\nM(A)=MACRO/X,'N'\nDECL/REAL,Y\nY=ASSIGN/X\nX=ASSIGN/2\nF(X)=FEAT/POINT,CART,0,0,0,0,0,1\n"
             "OUTPUT/FA('N'),FA(N)\nENDMAC\nCALL/M(A),X,'N'\n") ==
        ":X= M:A= :X=#1 '':N=#1 :Y=#1 :Y=#1 :X#1 :X=#1 F:X=?#1 :X#1 F:'N'?#1 '':N#1 F:N M:A :X");
  CHECK(uses("DECL/REAL,X\nM(A)=MACRO/Y\nX=ASSIGN/Y\nDECL/GLOBAL,REAL,Z\nV=ASSIGN/1\nENDMAC\nZ=ASSIGN/V\n") ==
        ":X= M:A= :Y=#1 :X= :Y#1 :Z= :V=#1 :Z=");
}

TEST_CASE("targets of jumps are no variables") { CHECK(uses("DECL/REAL,X\n(X)\nJUMPTO/( X )\n") == ":X= ():X= ():X"); }

TEST_CASE("directives name labels and variables") {
  CHECK(uses("$$! machines 5 expect FA(A) TA(D) occurrence 2 u <= 1\n$$! answer N = F(A)\nN=PROMPT/'how many'\n") ==
        "F:A T:D :N :N=");
  CHECK(uses("$$! machine TA(D)\n$$! expect\n$$! answer\n").empty());
}

}  // namespace abbe::lang
