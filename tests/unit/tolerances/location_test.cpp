// Concentricity, symmetry, run-out and profile against values worked out by hand.
#include "tests/unit/tolerances/evaluation.hpp"

#include "engine/tolerances/material.hpp"

using namespace abbe;
using namespace abbe::test;
using doctest::Approx;

namespace {

const Element kBore = sized(spanning(at({10, 20, 0}), -15, 15), 6);
const Element kFace = spanning(at({0, 0, 5}), -30, 30);

/// Touches of a circle about (x, y) with the radii of four quarters, at height z.
void quarters(Evaluation& e, double x, double y, double z, const std::vector<double>& radii, double meant) {
  const Vec3 out[] = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  for (std::size_t k = 0; k < radii.size(); ++k) {
    const Vec3 centre{x, y, z}, axis{10, 20, z};
    e.touches.push_back({centre + radii[k] * out[k % 4], axis + meant * out[k % 4], out[k % 4]});
  }
}

}  // namespace

TEST_CASE("Concentricity is twice the distance from the datum axis") {
  Evaluation circle("CONCEN");
  circle.number("zone", 0.1).feature(Shape::circle, sized(at({10.03, 20.04, 7}), 10)).datum(Shape::cylinder, kBore);
  CHECK(circle.value() == Approx(0.10));
  CHECK(circle.limits().upper == 0.1);
  // An axis is looked at at both ends: 0.01 at its point, 0.01 + 20e-3 at z = 20.
  Evaluation shaft("CONCEN");
  const Element tilted = spanning(at({10.01, 20, 0}, {1e-3, 0, 1}), -5, 20);
  shaft.number("zone", 0.1).feature(Shape::cylinder, tilted).datum(Shape::cylinder, kBore);
  CHECK(shaft.value() == Approx(0.06).epsilon(1e-5));
  shaft.actual[0] = spanning(at({10.01, 20, 0}, {-1e-3, 0, 1}), -25, 5);  // 0.01 + 25e-3 at z = -25
  CHECK(shaft.value() == Approx(0.07).epsilon(1e-5));
}

TEST_CASE("Concentricity with a face, and about a centre") {
  Evaluation faced("CONCEN");
  const Element leaning = spanning(at({10, 20, 0}, {0, 0.01, 1}), -15, 15);
  faced.number("zone", 0)
      .feature(Shape::circle, at({10.03, 20.04, 7}))
      .datum(Shape::plane, kFace)
      .datum(Shape::cylinder, leaning);
  CHECK(faced.value() == Approx(0.10));  // the axis stands on the face whatever the bore's tilt
  CHECK_FALSE(faced.limits().upper.has_value());
  Evaluation balls("CONCEN");
  balls.feature(Shape::sphere, at({1, 2, 3.5})).datum(Shape::sphere, at({1, 2, 3}));
  CHECK(balls.value() == Approx(1.0));
  Evaluation ring("CONCEN");
  ring.feature(Shape::circle, at({1.3, 2.4, 9})).datum(Shape::sphere, at({1, 2, 3}));
  CHECK(ring.value() == Approx(1.0));
  // An axis where it passes the centre, wherever along itself it was touched; a torus has a centre of its own.
  for (const Shape shape : {Shape::cylinder, Shape::cone, Shape::line}) {
    Evaluation rod("CONCEN");
    rod.feature(shape, spanning(at({1.3, 2.4, 50}), -5, 5)).datum(Shape::sphere, at({1, 2, 3}));
    CHECK(rod.value() == Approx(1.0));
  }
  Evaluation bead("CONCEN");
  bead.feature(Shape::torus, at({1, 2, 3.5})).datum(Shape::sphere, at({1, 2, 3}));
  CHECK(bead.value() == Approx(1.0));
  Evaluation face_alone("CONCEN");
  face_alone.feature(Shape::circle, at({1, 2, 9})).datum(Shape::plane, kFace);
  CHECK(face_alone.failure() == "a concentricity needs a datum with an axis or a centre");
  Evaluation plane("CONCEN");
  plane.feature(Shape::plane, kFace);
  CHECK(plane.refusal() == "concentricity is for features with a centre or an axis");
}

TEST_CASE("Symmetry about a median plane and about an axis") {
  const Element middle = at({0, 0, 0}, {1, 0, 0});
  Evaluation slot("SYM");
  slot.number("zone", 0.1)
      .feature(Shape::plane, spanning(at({0.02, 5, 5}, {1, 2e-3, 0}), -10, 10))
      .datum(Shape::plane, middle);
  CHECK(slot.value() == Approx(2 * (0.02 + 10 * 2e-3)).epsilon(1e-5));
  Evaluation hole("SYM");
  hole.feature(Shape::circle, at({-0.03, 5, 5})).datum(Shape::plane, middle);
  CHECK(hole.value() == Approx(0.06));
  Evaluation bore("SYM");
  bore.feature(Shape::cylinder, spanning(at({0.01, 5, 0}, {1e-3, 0, 1}), -5, 30)).datum(Shape::plane, middle);
  CHECK(bore.value() == Approx(2 * (0.01 + 0.03)).epsilon(1e-5));
  Evaluation key("SYM");
  key.feature(Shape::plane, spanning(at({10.05, 8, 3}, {1, 0, 0}), -10, 10)).datum(Shape::cylinder, kBore);
  CHECK(key.value() == Approx(0.10));
  // One that leans along the axis: the zone lies along the axis, and 3 mm above its origin no further away.
  Evaluation leaning("SYM");
  leaning.feature(Shape::plane, spanning(at({10.05, 8, 3}, {0.8, 0, 0.6}), -1e-9, 1e-9)).datum(Shape::cylinder, kBore);
  CHECK(leaning.value() == Approx(0.10));
  // Faces at x = +-5 that lean by 1e-3 and stand 0.002 beside the middle, touched from y = -4 to 10: at the
  // far end the median plane is 0.002 + 10 x 1e-3 from it.
  Evaluation faces("SYM");
  faces.feature(Shape::plane, spanning(at({0.002, 0, 0}, {1, -1e-3, 0}), -10, 10)).datum(Shape::plane, middle);
  for (const double side : {5.0, -5.0})
    for (const double y : {-4.0, 10.0})
      faces.faces.push_back(Vec3{0.002 + 1e-3 * y, y, 0} + side * unit({1, -1e-3, 0}));
  CHECK(faces.value() == Approx(2 * (0.002 + 10 * 1e-3)).epsilon(1e-5));
  Evaluation anywhere("SYM");
  anywhere.feature(Shape::plane, at({0.01, 0, 0}, {1, 0, 0})).datum(Shape::plane, middle);
  CHECK(anywhere.failure() == "the extent of the feature is not known, so that it has no zone");
  Evaluation wrong("SYM");
  wrong.feature(Shape::circle, at({})).datum(Shape::cylinder, kBore);
  CHECK(wrong.failure().starts_with("about an axis only a median plane"));
  Evaluation spot("SYM");
  spot.feature(Shape::circle, at({})).datum(Shape::sphere, at({}));
  CHECK(spot.failure() == "the datum of a symmetry is a median plane or an axis");
}

TEST_CASE("Circular run-out looks at one section, total run-out at all") {
  // Two sections of radius 30, the upper one 0.02 larger; each 0.05 out of centre in x.
  for (const auto& [word, expected] : {std::pair{"CRNOUT", 0.10}, std::pair{"TRNOUT", 0.12}}) {
    Evaluation e(word);
    e.number("zone", 0.1).feature(Shape::cylinder, kBore).datum(Shape::cylinder, kBore);
    quarters(e, 10.05, 20, 0, {30, 30, 30, 30}, 30);
    quarters(e, 10.05, 20, 12, {30.02, 30.02, 30.02, 30.02}, 30);
    CHECK(e.value() == Approx(expected).epsilon(1e-6));
  }
  // Axial: a face tilted by 1e-3 about y, touched at radius 10 and 20.
  for (const auto& [word, expected] : {std::pair{"CRNOUT", 0.04}, std::pair{"TRNOUT", 0.04}}) {
    Evaluation e(word);
    e.feature(Shape::plane, kFace).datum(Shape::cylinder, kBore);
    for (const double x : {-20.0, -10.0, 10.0, 20.0})
      e.touches.push_back({{10 + x, 20, 5 + 1e-3 * x}, {10 + x, 20, 5}, {0, 0, 1}});
    CHECK(e.value() == Approx(expected));
  }
  // A hollow face, 0.05 deeper at radius 20 than at 10: no circle on it runs out.
  for (const auto& [word, expected] : {std::pair{"CRNOUT", 0.0}, std::pair{"TRNOUT", 0.05}}) {
    Evaluation e(word);
    e.feature(Shape::plane, kFace).datum(Shape::cylinder, kBore);
    for (const double x : {-20.0, -10.0, 10.0, 20.0})
      e.touches.push_back({{10 + x, 20, std::fabs(x) > 15 ? 4.95 : 5}, {10 + x, 20, 5}, {0, 0, 1}});
    CHECK(e.value() == Approx(expected));
  }
}

TEST_CASE("Touches half a millimetre apart along the axis are of two sections") {
  Evaluation e("CRNOUT");
  e.feature(Shape::cylinder, kBore).datum(Shape::cylinder, kBore);
  quarters(e, 10, 20, 0, {30, 30, 30, 30}, 30);
  quarters(e, 10, 20, 0.5, {30.02, 30.02, 30.02, 30.02}, 30);
  quarters(e, 10, 20, 0.55, {30.03}, 30);  // as good as at 0.5
  CHECK(e.value() == Approx(0.01));
}

TEST_CASE("The run-out of cones and spheres is along the normal of the surface") {
  // A touch of four lies 0.03 out along a normal at 45 degrees to the axis; the other sections are true.
  const Rigid moved{rotation(unit({1, -2, 0.5}), 0.02), {0.4, -0.3, 0.2}};
  for (const Shape shape : {Shape::cone, Shape::sphere}) {
    for (const double side : {1.0, -1.0}) {  // outer, inner
      Evaluation e("CRNOUT");
      e.feature(shape, at({10, 20, 0})).datum(Shape::cylinder, moved * kBore, kBore);
      for (const double z : {0.0, 5.0})
        for (const Vec3 out : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{-1, 0, 0}, Vec3{0, -1, 0}}) {
          const Vec3 normal = side * unit(out - Vec3{0, 0, 1}), meant = Vec3{10, 20, z} + (30 + z) * out;
          const double off = z == 5 && out.x == 1 ? 0.03 : 0;
          e.touches.push_back({moved * (meant + off * normal), meant, normal});
        }
      CHECK(e.value() == Approx(0.03));
    }
  }
}

TEST_CASE("Run-out and profile go along the vectors of the touches, however the datums stand in the part") {
  // The program's coordinate system has the axis of a cone, or the face, along x: a touch is 0.03 out along its vector.
  const Vec3 normal = unit({-1, 0, 1});
  Evaluation cone("CRNOUT");
  const Element lying = sized(spanning(at({0, 10, 20}, {1, 0, 0}), -15, 15), 6);
  cone.feature(Shape::cone, lying).datum(Shape::cylinder, lying);
  for (const double side : {1.0, -1.0}) {
    const Vec3 meant{5, 10, 20 + side * 30}, out{normal.x, 0, side * normal.z};
    cone.touches.push_back({meant + (side > 0 ? 0.03 : 0.0) * out, meant, out});
  }
  CHECK(cone.value() == Approx(0.03));
  Evaluation wall("PROFS");
  wall.number("lower", -0.1).number("upper", 0.1).feature(Shape::plane, lying);
  wall.datum(Shape::plane, at({5, 0, 0}, {1, 0, 0}));
  wall.touches = {{{5.03, 1, 2}, {5, 1, 2}, {1, 0, 0}}};
  CHECK(wall.value() == Approx(0.06));
}

TEST_CASE("Run-outs say what they lack") {
  Evaluation made("TRNOUT");
  made.feature(Shape::circle, at({})).datum(Shape::cylinder, kBore);
  CHECK(made.failure().starts_with("a run-out is evaluated of the touches"));
  Evaluation no_axis("CRNOUT");
  no_axis.feature(Shape::circle, at({})).datum(Shape::plane, kFace);
  quarters(no_axis, 10, 20, 0, {3}, 3);
  CHECK(no_axis.failure() == "a run-out needs a datum with an axis");
  // Touches on a spiral: no two of them at one height.
  Evaluation spiral("CRNOUT");
  spiral.feature(Shape::cylinder, kBore).datum(Shape::cylinder, kBore);
  for (int k = 0; k < 4; ++k) quarters(spiral, 10, 20, 3 * k, {30}, 30);
  CHECK(spiral.failure() == "no section was touched twice: it shows no circular run-out");
  Evaluation cone("TRNOUT");
  cone.feature(Shape::cone, at({}));
  CHECK(cone.refusal() == "a total run-out is for cylinders, circles and planes");
  Evaluation line("CRNOUT");
  line.feature(Shape::line, at({}));
  CHECK(line.refusal() == "a run-out is for round features and planes");
}

TEST_CASE("A profile is the zone about the middle of its limits that holds all touches") {
  Evaluation e("PROFS");
  e.number("lower", -0.02).number("upper", 0.06).feature(Shape::plane, kFace);
  e.touches = {{{1, 0, 5.03}, {1, 0, 5}, {0, 0, 1}}, {{2, 0, 4.99}, {2, 0, 5}, {0, 0, 1}}};
  CHECK(e.value() == Approx(0.06));  // 0.03 below the middle at 0.02
  CHECK(*e.limits().upper == Approx(0.08));
  CHECK_FALSE(e.limits().lower.has_value());
  for (const char* word : {"PROFS", "PROFL"}) {
    CHECK(*Evaluation(word).number("lower", 0.05).number("upper", -0.05).limits().upper ==
          Approx(-0.1));  // none conforms
    CHECK_FALSE(Evaluation(word).number("lower", 0.05).number("upper", 0.05).limits().upper.has_value());
  }
  e.touches[1].actual.z = 4.97;  // 0.03 below nominal: outside -0.02
  CHECK(e.value() == Approx(0.10));
  Evaluation none("PROFL");
  none.feature(Shape::line, at({}));
  CHECK(none.failure().starts_with("a profile is evaluated of the touches"));
}

TEST_CASE("The profile of a point keeps its sign") {
  Evaluation e("PROFP");
  e.number("lower", -0.02).number("upper", 0.06).feature(Shape::point, at({1, 0, 5}));
  e.touches = {{{1.2, 0, 4.97}, {1, 0, 5}, {0, 0, 1}}};
  CHECK(e.value() == Approx(-0.03));  // what lies across the vector does not count
  CHECK(*e.limits().lower == -0.02);
  CHECK(*e.limits().upper == 0.06);
  e.touches.push_back({{1, 0, 5.01}, {1, 0, 5}, {0, 0, 1}});
  CHECK(e.value() == Approx(-0.01));
  e.datum(Shape::plane, at({0, 0, 0.5}), kFace);
  CHECK(e.refusal().empty());
  Evaluation of_plane("PROFP");
  of_plane.feature(Shape::plane, kFace);
  CHECK(of_plane.refusal() == "it is for points; a surface has PROFS, a line PROFL");
}

TEST_CASE("Datums carry the frame of a profile") {
  const Rigid moved{rotation(unit({1, -2, 0.5}), 0.02), {0.4, -0.3, 0.2}};
  Evaluation e("PROFS");
  const Element side = at({0, 10, -5}, {-1, 0, 0}), front = at({25, 0, -5}, {0, -1, 0});
  e.number("lower", -0.1).number("upper", 0.1).feature(Shape::plane, kFace);
  e.datum(Shape::plane, moved * kFace, kFace)
      .datum(Shape::plane, moved * side, side)
      .datum(Shape::plane, moved * front, front);
  e.touches = {{moved * Vec3{30, 20, 12.01}, {30, 20, 12}, {0, 0, 1}},
               {moved * Vec3{60, 20, 12}, {60, 20, 12}, {0, 0, 1}}};
  CHECK(e.value() == Approx(0.02));
}

TEST_CASE("The size departs from its size at the material condition") {
  const ToleranceKind &diam = *find_tolerance_kind("DIAM"), &rad = *find_tolerance_kind("RAD");
  const ToleranceLimits limits{9.9, 10.2};
  const auto most = Condition::maximum_material, least = Condition::least_material;
  CHECK(departure_mm(diam, 10.05, limits, true, most) == Approx(0.15));  // a hole: smallest is MMC
  CHECK(departure_mm(diam, 10.05, limits, true, least) == Approx(0.15));
  CHECK(departure_mm(diam, 10.1, limits, true, least) == Approx(0.1));
  CHECK(departure_mm(diam, 10.1, limits, false, most) == Approx(0.1));  // a shaft: largest is MMC
  CHECK(departure_mm(diam, 10.1, limits, false, least) == Approx(0.2));
  CHECK(departure_mm(diam, 9.8, limits, true, most) == 0);
  CHECK(departure_mm(diam, 10.5, limits, true, most) == Approx(0.3));      // never more than the tolerance
  CHECK(departure_mm(rad, 5.05, {4.95, 5.1}, true, most) == Approx(0.2));  // across the feature
}
