// Every construction through the language and the executor, against numbers worked out by hand.
#include <cmath>

#include "engine/features/construct.hpp"
#include "tests/unit/whole/programs.hpp"

using namespace abbe;
using namespace abbe::test;
using doctest::Approx;

namespace {

std::string spot(const std::string& label, const std::string& at) {
  return measured(label, "POINT,CART," + at + ",0,0,1", {at + ",0,0,1"});
}

std::string circle(const std::string& label, double x, double y, double r) {
  std::vector<std::string> touches;
  for (const auto& [i, j] : {std::pair{1, 0}, {0, 1}, {-1, 0}, {0, -1}})
    touches.push_back(fmt::format("{},{},0,{},{},0", x + r * i, y + r * j, -i, -j));
  return measured(label, fmt::format("CIRCLE,INNER,CART,{},{},0,0,0,1,{}", x, y, 2 * r), touches);
}

/// What the constructions work on: three points of a right triangle and one above, planes (the slope is z = x
/// + 10), two parallel lines, a circle about (50, 50), a cylinder upright through (20, 30).
std::string parts() {
  std::string out = spot("A", "0,0,0") + spot("B", "10,0,0") + spot("C", "0,20,0") + spot("D", "5,5,30") +
      spot("E", "24,50,0") + circle("K", 50, 50, 10) + circle("K2", 90, 50, 10);
  out += measured("TOP", "PLANE,CART,0,0,0,0,0,1", {"0,0,0,0,0,1", "40,0,0,0,0,1", "0,40,0,0,0,1"});
  out += measured("ROOF", "PLANE,CART,0,0,10,0,0,1", {"0,0,10,0,0,1", "40,0,10,0,0,1", "0,40,10,0,0,1"});
  out += measured("FRONT", "PLANE,CART,0,-5,0,0,-1,0", {"0,-5,0,0,-1,0", "40,-5,0,0,-1,0", "0,-5,40,0,-1,0"});
  out += measured("SIDE", "PLANE,CART,60,0,0,1,0,0", {"60,0,0,1,0,0", "60,40,0,1,0,0", "60,0,40,1,0,0"});
  out += measured("SLOPE", "PLANE,CART,0,0,10,-1,0,1", {"0,0,10,-1,0,1", "10,0,20,-1,0,1", "0,10,10,-1,0,1"});
  out += measured("L1", "LINE,UNBND,CART,0,0,0,1,0,0,0,0,1", {"0,0,0,0,0,1", "50,0,0,0,0,1"});
  out += measured("L2", "LINE,UNBND,CART,0,10,0,1,0,0,0,0,1", {"0,10,0,0,0,1", "50,10,0,0,0,1"});
  return out + "F(Z)=FEAT/CYLNDR,INNER,CART,20,30,0,0,0,1,16\nMEAS/CYLNDR,F(Z),8\nENDMES\n";
}

/// The element that a construction makes of parts(), in the system of the part.
Element made(const std::string& nominal, const std::string& arguments) {
  const Ran ran(parts() + "F(R)=FEAT/" + nominal + "\nCONST/" + nominal.substr(0, nominal.find(',')) + ",F(R)," +
                arguments + "\nOUTPUT/FA(R)\n");
  return ran.output("R");
}

const std::string kPoint = "POINT,CART,0,0,0,0,0,1", kLine = "LINE,UNBND,CART,0,0,0,1,0,0,0,0,1",
                  kUp = "LINE,UNBND,CART,0,0,0,0,0,1,1,0,0", kPlane = "PLANE,CART,0,0,0,0,0,1",
                  kSlope = "PLANE,CART,0,0,0,-1,0,1", kCircle = "CIRCLE,INNER,CART,0,0,0,0,0,1,20";

void check_point(const std::string& arguments, const Vec3& expected) {
  check_near(made(kPoint, arguments).point, expected);
}

}  // namespace

TEST_CASE("constructed points lie where hand calculation puts them") {
  check_point("INTOF,FA(TOP),FA(FRONT),FA(SIDE)", {60, -5, 0});
  check_point("INTOF,FA(Z),FA(SLOPE)", {20, 30, 30});
  check_point("MIDPT,FA(A),FA(B)", {5, 0, 0});
  check_point("PROJPT,FA(D),FA(SLOPE)", {12.5, 5, 22.5});
  check_point("MOVEPT,FA(A),10,0,-5", {10, 0, -5});
  check_point("MOVEPT,FA(A),FA(SLOPE),10", {-10 / std::sqrt(2), 0, 10 / std::sqrt(2)});
  check_point("EXTREM,MAX,FA(K),XDIR", {60, 50, 0});
  check_point("EXTREM,MIN,FA(K),0,1,0", {50, 40, 0});
  check_point("COG,FA(A),FA(B),FA(C)", {10.0 / 3, 20.0 / 3, 0});
  check_point("TR,FA(D)", {5, 5, 30});
  check_point("VECBLD,FA(A),FA(B),FA(C)", {0, 0, 0});
  check_near(made(kPoint, "VECBLD,FA(A),FA(B),FA(D)").direction, unit(Vec3{0, -30, 5}));
}

TEST_CASE("constructed lines run as hand calculation says") {
  check_near(made(kLine, "BF,FA(A),FA(B)").direction, {1, 0, 0});
  check_near(made(kLine, "BF,FA(Z),FA(K)").direction, unit(Vec3{30, 20, 0}));
  // L1 was touched about (25, 0, 0), but its nominal point is (0, 0, 0).
  check_near(made(kLine, "BF,FA(L1),FA(D)").direction, unit(Vec3{5, 5, 30}));
  const Element edge = made(kLine, "INTOF,FA(TOP),FA(FRONT)");
  check_near(edge.direction, {1, 0, 0});
  CHECK(edge.point.y == Approx(-5));
  CHECK(edge.point.z == Approx(0));
  const Element middle = made(kLine, "MIDLI,FA(L1),FA(L2)");
  check_near(middle.direction, {1, 0, 0});
  CHECK(middle.point.y == Approx(5));
  check_near(made(kLine, "PROJLI,FA(L1),FA(SLOPE)").direction, unit(Vec3{1, 0, 1}));
  const Element upright = made(kUp, "PERPTO,FA(TOP),THRU,FA(D)");
  check_near(upright.direction, {0, 0, 1});
  CHECK(upright.point.x == Approx(5));
  CHECK(upright.point.y == Approx(5));
  const Element beside = made(kLine, "PARTO,FA(L1),THRU,FA(C)");
  check_near(beside.direction, {1, 0, 0});
  CHECK(beside.point.y == Approx(20));
  // From (24, 50), 26 before the centre of a circle of radius 10, the tangent is 24 long.
  check_near(made("LINE,UNBND,CART,0,0,0,1,0.4,0,0,0,1", "TANTO,FA(K),THRU,FA(E)").direction,
             {24.0 / 26, 10.0 / 26, 0});
}

TEST_CASE("constructed planes and circles are those of hand calculation") {
  check_near(made(kPlane, "BF,FA(A),FA(B),FA(C)").direction, {0, 0, 1});
  CHECK(made(kPlane, "MIDPL,FA(TOP),FA(ROOF)").point.z == Approx(5));
  CHECK(made(kPlane, "OFFSET,FA(TOP),-30").point.z == Approx(-30));
  CHECK(made(kPlane, "TR,FA(ROOF)").point.z == Approx(10));
  const Element parallel = made(kSlope, "PARTO,FA(SLOPE),THRU,FA(B)");
  check_near(parallel.direction, unit(Vec3{-1, 0, 1}));
  CHECK(parallel.point.z - parallel.point.x == Approx(-10));
  const Element across = made("PLANE,CART,0,0,0,1,0,0", "PERPTO,FA(L1),THRU,FA(B)");
  check_near(across.direction, {1, 0, 0});
  CHECK(across.point.x == Approx(10));
  // The circle about a right triangle: its centre halves the longest side.
  const Element about = made(kCircle, "BF,FA(A),FA(B),FA(C)");
  check_near(about.point, {5, 10, 0});
  CHECK(about.size == Approx(std::sqrt(125)));
  CHECK(made(kCircle, "INTOF,FA(Z),FA(TOP)").size == Approx(8));
}

TEST_CASE("a gauge diameter of a countersink lies as deep as hand calculation says") {
  // 90 degrees, apex at (50, 50, -10): touched at radius 5 and 8, and 0.1 higher than the nominal is.
  std::vector<std::string> touches;
  for (const double r : {5.0, 8.0})
    for (const auto& [i, j] : {std::pair{1, 0}, {0, 1}, {-1, 0}, {0, -1}})
      touches.push_back(fmt::format("{},{},{},{},{},1", 50 + r * i, 50 + r * j, r - 9.9, -i, -j));
  const Ran ran(measured("SINK", "CONE,INNER,CART,50,50,-10,0,0,1,90", touches) +
                "F(G)=FEAT/CIRCLE,INNER,CART,50,50,-4,0,0,1,12\nCONST/CIRCLE,F(G),CONE,DIAM,12,FA(SINK)\n"
                "F(H)=FEAT/CIRCLE,INNER,CART,50,50,-3,0,0,1,14\nCONST/CIRCLE,F(H),CONE,DIST,7,FA(SINK)\n"
                "OUTPUT/FA(G)\nOUTPUT/FA(H)\n");
  check_near(ran.output("G").point, {50, 50, -3.9});
  CHECK(ran.output("G").size == Approx(6));
  check_near(ran.output("H").point, {50, 50, -2.9});
  CHECK(ran.output("H").size == Approx(7));
}

TEST_CASE("a torus is found where its touches are") {
  // The tube has a radius of 10.1 about a circle of radius 40: outside at 50.1, above at 10.1.
  const Ran ran(measured("T", "TORUS,OUTER,CART,0,0,0,0,0,1,80,20",
                         {"50.1,0,0,1,0,0", "0,50.1,0,0,1,0", "-50.1,0,0,-1,0,0", "0,-50.1,0,0,-1,0", "40,0,10.1,0,0,1",
                          "0,40,10.1,0,0,1", "-40,0,10.1,0,0,1", "0,-40,-10.1,0,0,-1"}) +
                "OUTPUT/FA(T)\n");
  CHECK(ran.output("T").size == Approx(40));
  CHECK(ran.output("T").minor_size == Approx(10.1));
  check_near(ran.output("T").point, {0, 0, 0});
}

TEST_CASE("every construction is tried here") {
  // A construction without a line in the cases above has no value that anyone worked out.
  const std::string_view tried =
      "INTOF MIDPT PROJPT MOVEPT EXTREM COG TR VECBLD BF MIDLI PROJLI PERPTO PARTO TANTO MIDPL OFFSET CONE";
  for (const Construction* method : constructions()) {
    CHECK_MESSAGE(
        tried.find(method->word) != std::string_view::npos,
        "give " << method->word << " a case above, with a value that you worked out, and add it to these words");
  }
}

TEST_CASE("a feature may stand where a datum is asked for") {
  const Ran ran(
      parts() +
      "DATDEF/FA(TOP),DAT(A)\nT(P)=TOL/PARLEL,0.1,DAT(A)\nT(Q)=TOL/PARLEL,0.1,FA(TOP)\nOUTPUT/FA(SLOPE),TA(P),TA(Q)\n");
  CHECK(ran["P"] > 1);
  CHECK(ran["P"] == ran["Q"]);
}
