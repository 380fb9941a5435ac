// Tolerances that look at the touches of measured features: what a program gets, from the error-free machine.
#include "tests/unit/whole/programs.hpp"

using namespace abbe;
using namespace abbe::test;
using doctest::Approx;

namespace {

/// Two faces 20 mm apart, the upper one rising by 1 um/mm along x, touched from x = 5 to 95.
std::string wedge() {
  return measured("LOW", "PLANE,CART,50,30,0,0,0,1", {"5,5,0,0,0,1", "5,55,0,0,0,1", "95,5,0,0,0,1", "95,55,0,0,0,1"}) +
      measured("TOP", "PLANE,CART,50,30,20,0,0,1",
               {"5,5,19.955,0,0,1", "5,55,19.955,0,0,1", "95,5,20.045,0,0,1", "95,55,20.045,0,0,1"});
}

}  // namespace

TEST_CASE("the farthest and the nearest touches of two faces") {
  const Ran ran(
      wedge() +
      "T(MAX)=TOL/DISTB,NOMINL,20,-.1,.1,ZAXIS,MAX\nT(MIN)=TOL/DISTB,NOMINL,20,-.1,.1,ZAXIS,MIN\nT(AVG)=TOL/DISTB,NOMINL,20,-.1,.1,PT2PT\n"
      "OUTPUT/FA(LOW),FA(TOP),TA(MAX),TA(MIN),TA(AVG)\n"
      "T(WRT)=TOL/DISTWRT,NOMINL,20,-.1,.1,FA(TOP),ZAXIS,MAX\nOUTPUT/FA(LOW),TA(WRT)\n");
  CHECK(ran["MAX"] == Approx(20.045));
  CHECK(ran["MIN"] == Approx(19.955));
  CHECK(ran["AVG"] == Approx(20));
  CHECK(ran["WRT"] == Approx(20.045));
}

TEST_CASE("a line of a surface is as straight as its section, an axis as its cylinder") {
  std::vector<std::string> touches;
  std::string points, used;
  for (int k = 0; k <= 10; ++k) {
    touches.push_back(fmt::format("{},{},-5,0,-1,0", 10 * k, k == 5 ? 0.01 : 0.0));
    points += measured(fmt::format("P{}", k), fmt::format("POINT,CART,{},0,-5,0,-1,0", 10 * k), {touches.back()});
    used += fmt::format(",FA(P{})", k);
  }
  const Ran ran(measured("EDGE", "LINE,BND,CART,0,0,-5,100,0,-5,0,-1,0", touches) + points +
                "F(AXIS)=FEAT/LINE,BND,CART,0,0,-5,100,0,-5,0,-1,0\nCONST/LINE,F(AXIS),BF" + used +
                "\nT(S)=TOL/STRGHT,0.02\nT(C)=TOL/STRGHT,0.02\nOUTPUT/FA(EDGE),TA(S)\nOUTPUT/FA(AXIS),TA(C)\n");
  CHECK(ran["S"] == Approx(0.01));
  CHECK(ran["C"] == Approx(0.2 / 11));
}

TEST_CASE("MAX and MIN of an arc are at its centre, of a circle at its rim") {
  const std::vector<std::string> touches{"20,0,0,1,0,0", "12,16,0,.6,.8,0", "0,20,0,0,1,0"};
  const auto farthest = [&](const std::string& form) {
    return Ran(measured("R", form, touches) + measured("P", "POINT,CART,-100,0,0,-1,0,0", {"-100,0,0,-1,0,0"}) +
               "T(D)=TOL/DISTB,NOMINL,100,-1,1,XAXIS,MAX\nOUTPUT/FA(R),FA(P),TA(D)\n")["D"];
  };
  CHECK(farthest("CIRCLE,OUTER,CART,0,0,0,0,0,1,40") == Approx(120));
  CHECK(farthest("ARC,OUTER,CART,0,0,0,0,0,1,20,0,90") == Approx(100));
}

TEST_CASE("a median plane is judged without the touches of its faces") {
  const Ran ran(measured("BASE", "PLANE,CART,0,0,0,0,1,0", {"0,0,0,0,1,0", "50,0,0,0,1,0", "0,0,20,0,1,0"}) +
                measured("SLOT", "PARPLN,INNER,MIDPL,CART,40,30,-5,0,1,0,10",
                         {"20,25,-2,0,1,0", "60,25,-2,0,1,0", "60,25,-8,0,1,0", "20,35,-2,0,-1,0", "60,35,-2,0,-1,0",
                          "20,35,-8,0,-1,0"}) +
                "DATDEF/FA(BASE),DAT(A)\nT(PAR)=TOL/PARLEL,0.05,DAT(A)\nT(FAR)=TOL/DISTB,NOMINL,30,-.1,.1,PT2PT,MAX\n"
                "OUTPUT/FA(SLOT),TA(PAR)\nOUTPUT/FA(BASE),FA(SLOT),TA(FAR)\n");
  CHECK(ran["PAR"] == Approx(0).scale(1));
  CHECK(ran["FAR"] == Approx(30));
}
