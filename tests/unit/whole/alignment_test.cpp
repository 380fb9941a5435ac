// The uncertainty that alignments pass on to what is measured in them, through the language, against closed
// forms. Only the probe has errors: sd is that of one touch, the same for all touches and independent, so
// variances add up with squared weights.
#include <cmath>

#include "tests/unit/whole/programs.hpp"

using namespace abbe;
using namespace abbe::test;

namespace {

constexpr double L = 100, X = 250, Y = 180;  // distance of the touches of datums; where the points in question lie
constexpr int kMachines = 4000;

RunOptions only_probe() {
  RunOptions options;
  options.contributors.geometry = options.contributors.head = false;
  return options;
}

/// Three touches on the face z = 0, two on the edge y = 0, one on the stop x = 0, four in a bore about the origin;
/// a point and a bore L further along x.
std::string datums() {
  return measured("FACE", "PLANE,CART,0,0,0,0,0,1", {"0,0,0,0,0,1", "100,0,0,0,0,1", "0,100,0,0,0,1"}) +
      measured("EDGE", "LINE,UNBND,CART,0,0,0,1,0,0,0,-1,0", {"0,0,0,0,-1,0", "100,0,0,0,-1,0"}) +
      measured("STOP", "POINT,CART,0,0,0,-1,0,0", {"0,0,0,-1,0,0"}) +
      measured("BORE", "CIRCLE,INNER,CART,0,0,0,0,0,1,20",
               {"10,0,0,-1,0,0", "0,10,0,0,-1,0", "-10,0,0,1,0,0", "0,-10,0,0,1,0"}) +
      measured("SIDE", "POINT,CART,100,0,0,0,-1,0", {"100,0,0,0,-1,0"}) +
      measured("SECOND", "CIRCLE,INNER,CART,100,0,0,0,0,1,20",
               {"110,0,0,-1,0,0", "100,10,0,0,-1,0", "90,0,0,1,0,0", "100,-10,0,0,1,0"}) +
      "DATDEF/FA(FACE),DAT(A)\nDATDEF/FA(EDGE),DAT(B)\nDATDEF/FA(STOP),DAT(C)\n";
}

/// A point measured in the system that the statements make of the part's, and the variance of one of its coordinates.
struct Case {
  const char* system;
  Vec3 at;
  char axis;
  double variance;  ///< in units of the square of sd
};

double square(double v) { return v * v; }

const double kEdge = 1 + square(1 - X / L) + square(X / L);

const Case kCases[] = {
    // One datum: a plane through three touches, read at (X, Y).
    {"DATSET/DAT(A),ZDIR,ZORIG", {X, Y, 0}, 'Z', 1 + square(1 - X / L - Y / L) + square(X / L) + square(Y / L)},
    // It leaves x and y where they were.
    {"DATSET/DAT(A),ZDIR,ZORIG", {X, Y, 0}, 'X', 1},
    // Two datums: the line through two touches, read at X.
    {"DATSET/DAT(A),ZDIR,ZORIG,DAT(B),XDIR,YORIG", {X, 0, 0}, 'Y', kEdge},
    // The same the other way round: y runs along the edge that was x, so the system is turned and the part
    // lies along -x.
    {"DATSET/DAT(A),ZDIR,ZORIG,DAT(B),YDIR,XORIG", {0, X, 0}, 'X', kEdge},
    // Three datums: the stop, and the rotation by the edge times the lever.
    {"DATSET/DAT(A),ZDIR,ZORIG,DAT(B),XDIR,YORIG,DAT(C),XORIG", {0, Y, 0}, 'X', 2 + 2 * square(Y / L)},
    // The origin moved to a point: its error and the own one; to the centre of a bore: half of each of two
    // opposite touches.
    {"TRANS/XORIG,FA(STOP)", {X, Y, 0}, 'X', 2},
    {"TRANS/XORIG,FA(BORE),YORIG,FA(BORE)", {X, Y, 0}, 'X', 1.5},
    {"TRANS/XORIG,FA(BORE),YORIG,FA(BORE)", {X, Y, 0}, 'Y', 1.5},
    // Turned about the origin to the edge: the difference of its two touches over L, times the lever.
    {"ROTATE/ZAXIS,FA(EDGE),XDIR", {X, 0, 0}, 'Y', 1 + 2 * square(X / L)},
    {"ROTATE/ZAXIS,FA(EDGE),XDIR", {0, Y, 0}, 'X', 1 + 2 * square(Y / L)},
    // The same to the point of a stop or the centre of a bore at that distance.
    {"ROTATE/ZAXIS,FA(SIDE),XDIR", {X, 0, 0}, 'Y', 1 + square(X / L)},
    {"ROTATE/ZAXIS,FA(SECOND),XDIR", {X, 0, 0}, 'Y', 1 + square(X / L) / 2},
    // A translation by a number and a rotation by an angle are exact.
    {"TRANS/XORIG,10,YORIG,-5", {X, Y, 0}, 'X', 1},
    {"ROTATE/ZAXIS,90", {X, Y, 0}, 'Y', 1},
};

std::string program() {
  std::string out = datums() + "SAVE/D(PART)\n";
  int number = 0;
  for (const Case& c : kCases) {
    const Vec3 n = c.axis == 'X' ? Vec3{-1, 0, 0} : c.axis == 'Y' ? Vec3{0, -1, 0} : Vec3{0, 0, 1};
    const std::string at = fmt::format("{},{},{},{},{},{}", c.at.x, c.at.y, c.at.z, n.x, n.y, n.z),
                      label = fmt::format("P{}", number);
    out += fmt::format("RECALL/D(PART)\nD(NEW)={}\nT(T{})=TOL/CORTOL,{}AXIS,-1,1\n", c.system, number, c.axis) +
        measured(label, "POINT,CART," + at, {at}) + fmt::format("OUTPUT/FA({}),TA(T{})\n", label, number);
    ++number;
  }
  return out;
}

double variance(const std::vector<double>& values) {
  double mean = 0, sum = 0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  for (const double v : values) sum += square(v - mean);
  return sum / static_cast<double>(values.size() - 1);
}

}  // namespace

TEST_CASE("F is where the program has a feature, FA where it was measured") {
  // The bore lies at (41, 30), the program has it at (40, 30).
  const std::string bore = measured("H", "CIRCLE,INNER,CART,40,30,0,0,0,1,20",
                                    {"51,30,0,-1,0,0", "41,40,0,0,-1,0", "31,30,0,1,0,0", "41,20,0,0,1,0"});
  for (const auto& [origin, found] : {std::pair{"F", 1.0}, {"FA", 0.0}}) {
    CAPTURE(origin);
    const Ran ran(bore + fmt::format("D(X)=TRANS/XORIG,{0}(H),YORIG,{0}(H)\n", origin) + "OUTPUT/FA(H)\n");
    CHECK(ran.output("H").point.x == doctest::Approx(found));
    CHECK(ran.output("H").point.y == doctest::Approx(0));
  }
  // It is exact: all that varies in this distance is the one bore.
  const Ran ran(
      bore + "T(N)=TOL/DISTWRT,NOMINL,1,-1,1,F(H),XAXIS,AVG\nT(C)=TOL/CORTOL,XAXIS,-1,1\nOUTPUT/FA(H),TA(N),TA(C)\n",
      20);
  CHECK(ran["N"] == doctest::Approx(1));
  const Samples &distance = ran.samples("N"), &place = ran.samples("C");
  for (std::size_t k = 0; k < distance.value.size(); ++k)
    CHECK(distance.value[k] == doctest::Approx(place.value[k]).epsilon(1e-9));
}

TEST_CASE("alignments pass on the uncertainty of their touches as the closed forms say") {
  const Ran ran(program(), kMachines, only_probe());
  const Vec3 sd = read_machine("coord3-mc16").probe.sd_mm;
  REQUIRE(sd.x == sd.y);
  REQUIRE(sd.x == sd.z);
  int number = 0;
  for (const Case& c : kCases) {
    CAPTURE(c.system);
    CAPTURE(c.axis);
    const Samples& samples = ran.samples(fmt::format("T{}", number++));
    CHECK(std::fabs(samples.reference.value()) < 1e-9);
    // 3.9 standard deviations of the variance of so many normal numbers.
    CHECK(std::fabs(variance(samples.value) / (square(sd.x) * c.variance) - 1) <
          3.9 * std::sqrt(2.0 / (kMachines - 1)));
  }
}

TEST_CASE("a chain of systems is what its links make together") {
  // (10, 20) in a system moved by (100, 0) and turned by a quarter lies at (80, 10) of the part.
  const Ran ran("SAVE/D(PART)\nD(A)=TRANS/XORIG,100\nD(B)=ROTATE/ZAXIS,90\nSAVE/D(B)\n" +
                measured("P", "POINT,CART,10,20,0,0,0,1", {"10,20,0,0,0,1"}) +
                "RECALL/D(PART)\nOUTPUT/FA(P)\nRECALL/DA(B)\n" +
                measured("Q", "POINT,CART,0,0,0,0,0,1", {"0,0,0,0,0,1"}) + "RECALL/D(A)\nOUTPUT/FA(Q)\nOUTPUT/DA(B)\n");
  check_near(ran.output("P").point, {80, 10, 0});
  check_near(ran.output("Q").point, {0, 0, 0});
  const OutputRecord& frame = ran.result.reference_outputs.back();
  REQUIRE(frame.frame.has_value());
  check_near(frame.frame->p, {800, 400, -500});
  check_near(frame.frame->R * Vec3{1, 0, 0}, {0, 1, 0});
}
