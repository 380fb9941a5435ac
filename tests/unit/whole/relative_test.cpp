// RMEAS, CALIB and moves: what they make of a program that runs.
#include "tests/unit/whole/programs.hpp"

#include <algorithm>
#include <cmath>

using namespace abbe;
using namespace abbe::test;
using doctest::Approx;

namespace {

/// A face that lies 0.3 mm above its nominal and is tilted by 1 : 100 about y, and a bore 0.2 mm beside its nominal.
std::string face_and_bore() {
  return measured("FACE", "PLANE,CART,0,0,0,0,0,1", {"0,0,0.3,-0.01,0,1", "50,0,0.8,-0.01,0,1", "0,50,0.3,-0.01,0,1"}) +
      measured("BORE", "CIRCLE,INNER,CART,20,20,-5,0,0,1,20",
               {"30.2,20,-5,-1,0,0", "20.2,30,-5,0,-1,0", "10.2,20,-5,1,0,0", "20.2,10,-5,0,1,0"});
}

/// A point at (10, 40, 0) measured relative to a feature; where it is found.
Vec3 point_beside(const std::string& reference, const std::string& before = "") {
  return Ran(face_and_bore() + before +
             measured("P", "POINT,CART,10,40,0,0,0,1", {"10,40,0,0,0,1"}, "RMEAS/{},F({}),{}", reference) +
             "OUTPUT/FA(P)\n")
      .output("P")
      .point;
}

}  // namespace

TEST_CASE("a relative measurement goes where the earlier feature was found") {
  check_near(point_beside(",FA(FACE)"), {10, 40, 0.3});  // at its nominal point, (0, 0, 0), the face lies 0.3 above it
  check_near(point_beside(",FA(BORE)"), {10.2, 40, 0});
}

TEST_CASE("a relative measurement along an axis takes that part only, and of a nominal nothing") {
  check_near(point_beside(",FA(BORE),YAXIS"), {10, 40, 0});
  check_near(point_beside(",FA(BORE),XAXIS"), {10.2, 40, 0});
  check_near(point_beside(",F(BORE)"), {10, 40, 0});
}

TEST_CASE("the displacement counts from where the feature was defined, whatever system is current") {
  check_near(point_beside(",FA(BORE)", "D(T)=ROTATE/ZAXIS,90\n"), {10, 40 - 0.2, 0});  // +x of the part is -y here
}

TEST_CASE("default touches of a relative measurement are displaced as well") {
  const Ran ran(face_and_bore() +
                "F(C)=FEAT/CIRCLE,OUTER,CART,60,20,0,0,0,1,10\nRMEAS/CIRCLE,F(C),4,FA(BORE)\nENDMES\nOUTPUT/FA(C)\n");
  check_near(ran.output("C").point, {60.2, 20, 0});
}

TEST_CASE("default touches are displaced in the system that is current, wherever the feature was defined") {
  // 0.2 along the old x, which is -y of the new system.
  const Ran ran(face_and_bore() +
                "F(C)=FEAT/CIRCLE,OUTER,CART,60,20,0,0,0,1,10\nD(T)=ROTATE/ZAXIS,90\n"
                "RMEAS/CIRCLE,F(C),4,FA(BORE)\nENDMES\nOUTPUT/FA(C)\n");
  check_near(ran.output("C").point, {20, -60.2, 0});
}

TEST_CASE("the vector of a touch may have any length, whether written or computed") {
  const Ran ran(measured("P", "POINT,CART,0,300,0,0,-1,0", {"0,300,0,0,-1,0"}) + "Y=OBTAIN/FA(P),5\nK=ASSIGN/Y/150\n" +
                measured("Q", "POINT,CART,10,20,0,0,0,1", {"10,20,0,0,0,K"}) + "OUTPUT/FA(Q)\n");
  check_near(ran.output("Q").point, {10, 20, 0});
}

TEST_CASE("without compensation the profile is that of the centres of the tip") {
  const std::string face =
      "PRCOMP/OFF\n" + measured("F", "PLANE,CART,0,0,0,0,0,1", {"0,0,0,0,0,1", "50,0,0,0,0,1", "0,50,0,0,0,1"});
  CHECK(Ran(face + "T(PROF)=TOL/PROFS,-.1,.1\nOUTPUT/FA(F),TA(PROF)\n")["PROF"] == Approx(0).scale(1));
}

TEST_CASE("a calibration measures its sphere") {
  const Ran ran("T(D)=TOL/DIAM,-1,1\n" +
                measured("BALL", "SPHERE,OUTER,CART,0,0,0,20",
                         {"10,0,0,1,0,0", "0,10,0,0,1,0", "-10,0,0,-1,0,0", "0,0,10,0,0,1"},
                         "CALIB/SENS,S(P),F({1}),{2}") +
                "EVAL/FA(BALL),T(D)\n");
  CHECK(ran["D"] == Approx(20));
}

TEST_CASE("moves by a distance and home take the time of their ways") {
  const auto seconds = [](const std::string& moves) { return Ran("GOTO/0,0,100\n" + moves).result.cycle_time_s; };
  CHECK(seconds("GOTO/INCR,50,0,0,2\n") == Approx(seconds("GOTO/0,0,150\n")));
  // After the turn y points up: from 100 by 50, and from there to 200.
  CHECK(seconds("D(T)=ROTATE/XAXIS,90\nGOTO/INCR,50,0,1,0\nGOTO/0,200,0\n") ==
        Approx(seconds("GOTO/0,0,150\nGOTO/0,0,200\n")));
  CHECK(seconds("FROM/0,0,300\nGOTO/0,0,200\nGOHOME\n") == Approx(seconds("GOTO/0,0,200\nGOTO/0,0,300\n")));
  CHECK(seconds("FROM/0,0,300\nD(T)=ROTATE/XAXIS,90\nGOHOME\n") == Approx(seconds("GOTO/0,0,300\n")));
  CHECK(seconds("GOHOME\n") == Approx(seconds("")));
}

TEST_CASE("an error-free machine on a path of its own knows where the part is on it") {
  // Y is 300 exactly without errors, so about half of the machines move the origin and the reference does not.
  const Ran ran(measured("P", "POINT,CART,0,300,0,0,-1,0", {"0,300,0,0,-1,0"}) +
                    "Y=OBTAIN/FA(P),5\nIF/(Y .GT. 300)\nD(A)=TRANS/XORIG,10,YORIG,5\nENDIF\n" +
                    measured("C", "CIRCLE,INNER,CART,20,20,-5,0,0,1,20",
                             {"30,20,-5,-1,0,0", "20,30,-5,0,-1,0", "10,20,-5,1,0,0"}) +
                    "D(B)=TRANS/XORIG,FA(C),YORIG,FA(C)\nT(X)=TOL/CORTOL,XAXIS,-1,1\n" +
                    measured("Q", "POINT,CART,30,0,0,1,0,0", {"30,0,0,1,0,0"}) + "EVAL/FA(Q),T(X)\n",
                40);
  const std::vector<double>& values = ran.samples("X").value;
  REQUIRE(values.size() == 40);
  for (const double v : values) CHECK(std::fabs(v) < 0.05);
}
