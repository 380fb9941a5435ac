#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "engine/features/alignment.hpp"
#include "engine/features/displacement.hpp"
#include "tests/unit/features/operands.hpp"

using namespace abbe;

namespace {

const Rigid kPose{rotation(unit({1, 2, 3}), 0.7), {100, -50, 30}};

void check_near(const Rigid& a, const Rigid& b, double tolerance = 1e-12) {
  check_near(a.R.cx, b.R.cx, tolerance);
  check_near(a.R.cy, b.R.cy, tolerance);
  check_near(a.R.cz, b.R.cz, tolerance);
  check_near(a.p, b.p, tolerance * 1000);
}

Element at(Vec3 point, Vec3 direction) { return {.point = point, .direction = unit(direction)}; }

DatumUse use(Shape shape, const Element& e, Axis axis, int sign, const char* origins) {
  DatumUse u{shape, e, true, {axis, sign}, {}};
  for (const char* c = origins; *c; ++c) u.origin[*c - 'X'] = true;
  return u;
}

DatumUse locating(Shape shape, const Element& e, const char* origins) {
  DatumUse u = use(shape, e, Axis::x, 1, origins);
  u.gives_direction = false;
  return u;
}

/// The plane through three points, normal toward +z.
Element plane_through(const Vec3& a, const Vec3& b, const Vec3& c) { return at((a + b + c) / 3, cross(b - a, c - a)); }

}  // namespace

TEST_CASE("A 3-2-1 alignment recovers the pose of the part exactly") {
  const DatumUse datums[] = {use(Shape::plane, kPose * at({40, 30, 0}, {0, 0, 1}), Axis::z, 1, "Z"),
                             use(Shape::line, kPose * at({25, 0, -5}, {1, 0, 0}), Axis::x, 1, "Y"),
                             locating(Shape::point, kPose * at({0, 10, -5}, {-1, 0, 0}), "X")};
  check_near(datum_frame({}, datums).value, kPose);

  SUBCASE("with three planes whose normals point against the axes") {
    const DatumUse planes[] = {use(Shape::plane, kPose * at({40, 30, 0}, {0, 0, -1}), Axis::z, -1, "Z"),
                               use(Shape::plane, kPose * at({25, 0, -5}, {0, -1, 0}), Axis::y, -1, "Y"),
                               locating(Shape::plane, kPose * at({0, 10, -5}, {-1, 0, 0}), "X")};
    check_near(datum_frame({}, planes).value, kPose);
  }
}

TEST_CASE("Errors of the primary touches tilt the frame as geometry says") {
  const double L = 200, e1 = 2e-3, e2 = -1e-3, e3 = 4e-3;
  const DatumUse datums[] = {use(Shape::plane, plane_through({0, 0, e1}, {L, 0, e2}, {0, L, e3}), Axis::z, 1, "Z"),
                             use(Shape::line, at({L / 2, 0, -10}, {1, 0, 0}), Axis::x, 1, "Y"),
                             locating(Shape::point, at({0, 20, -10}, {-1, 0, 0}), "X")};
  const Rigid X = datum_frame({}, datums).value;
  const double slope_x = (e2 - e1) / L, slope_y = (e3 - e1) / L;
  check_near(X.R.cz, {-slope_x, -slope_y, 1}, 1e-9);  // second order: slope^2 = 4e-10
  check_near(X.R.cx, {1, 0, slope_x}, 1e-9);
  // Line and point lie 10 mm below the primary: its tilt about their level moves the origin across.
  check_near(X.p, {-10 * slope_x, -10 * slope_y, e1}, 1e-7);
  CHECK(std::fabs((inverse(X) * Vec3{L / 2, 0, -10}).y) < 1e-12);
  CHECK(std::fabs((inverse(X) * Vec3{0, 20, -10}).x) < 1e-12);
}

TEST_CASE("Bores locate, and the second one stops the rotation") {
  const DatumUse datums[] = {use(Shape::plane, kPose * at({40, 30, 0}, {0, 0, 1}), Axis::z, 1, "Z"),
                             locating(Shape::circle, kPose * at({0, 0, -3}, {0, 0, 1}), "XY"),
                             use(Shape::cylinder, kPose * at({0, -80, -9}, {1e-4, 0, 1}), Axis::y, -1, "")};
  check_near(datum_frame({}, datums).value, kPose);
}

TEST_CASE("A point as secondary datum is seen from the current origin or the primary axis") {
  const Rigid start{{}, {5, 5, 0}};
  const DatumUse from_origin[] = {use(Shape::plane, at({0, 0, 2}, {0, 0, 1}), Axis::z, 1, "Z"),
                                  use(Shape::point, at({5, 25, 9}, {0, 1, 0}), Axis::x, 1, "")};
  const Rigid A = datum_frame(start, from_origin).value;
  check_near(A.R.cx, {0, 1, 0});
  check_near(A.p, {5, 5, 2});
  const DatumUse from_axis[] = {use(Shape::cylinder, at({1, 2, 0}, {0, 0, 1}), Axis::z, 1, "XY"),
                                use(Shape::sphere, at({11, 2, 7}, {0, 0, 1}), Axis::x, -1, "Z")};
  const Rigid B = datum_frame(start, from_axis).value;
  check_near(B.R.cx, {-1, 0, 0});
  check_near(B.R.cy, {0, -1, 0});
  check_near(B.p, {1, 2, 7});
}

TEST_CASE("A bore as secondary datum is seen from what else is located across the primary axis") {
  // The bore itself sets the origin too: it is seen from where the origin was. A face that sets one is no place.
  const Rigid start{{}, {5, 5, 0}};
  const DatumUse face = use(Shape::plane, at({40, 30, 0}, {0, 0, 1}), Axis::z, 1, "Z");
  const DatumUse alone[] = {face, use(Shape::circle, at({8, 9, -3}, {0, 0, 1}), Axis::x, 1, "XY")};
  check_near(datum_frame(start, alone).value.R.cx, {0.6, 0.8, 0});
  const DatumUse walled[] = {face, use(Shape::circle, at({8, 9, -3}, {0, 0, 1}), Axis::x, 1, ""),
                             locating(Shape::plane, at({-7, 60, -5}, {1, 0, 0}), "X")};
  check_near(datum_frame(start, walled).value.R.cx, {0.6, 0.8, 0});
}

TEST_CASE("What no datum names stays as it was") {
  const DatumUse tilted[] = {use(Shape::plane, at({0, 0, 0}, {1e-3, 0, 1}), Axis::z, 1, "")};
  const Rigid X = datum_frame({{}, {7, 8, 9}}, tilted).value;
  check_near(X.p, {7, 8, 9});
  CHECK(X.R.cx.y == 0);
  // Reversed and slightly tilted normals keep the azimuth of x, whichever way the tilt goes.
  for (const Vec3 tilt : {Vec3{1e-6, 0, 0}, Vec3{0, 1e-6, 0}, Vec3{-1e-6, 1e-6, 0}}) {
    const DatumUse reversed[] = {use(Shape::plane, at({}, Vec3{0, 0, -1} + tilt), Axis::z, 1, "")};
    check_near(datum_frame({}, reversed).value.R.cx, {1, 0, 0}, 1e-5);
  }
  const DatumUse origin_only[] = {locating(Shape::sphere, at({1, 2, 3}, {0, 0, 1}), "XZ")};
  check_near(datum_frame(kPose, origin_only).value.R.cy, kPose.R.cy);
  CHECK(std::fabs((inverse(kPose) * datum_frame(kPose, origin_only).value.p).y) < 1e-12);
}

TEST_CASE("Datums that cannot make a frame are refused with a reason") {
  const Element up = at({0, 0, 0}, {0, 0, 1});
  auto reason = [](std::vector<DatumUse> datums) { return std::string(datum_frame({}, datums).failure); };
  CHECK(reason({use(Shape::plane, up, Axis::z, 1, ""), use(Shape::plane, up, Axis::x, 1, "")}) ==
        "the direction of the secondary datum is parallel to the primary");
  CHECK(reason({use(Shape::plane, up, Axis::z, 1, ""), use(Shape::line, at({}, {1, 0, 0}), Axis::z, 1, "")}) ==
        "primary and secondary datum define the same axis");
  CHECK(reason({use(Shape::sphere, up, Axis::z, 1, "")}) == "a point or a sphere gives no direction as primary datum");
  CHECK(
      reason({use(Shape::cylinder, up, Axis::z, 1, ""), use(Shape::point, at({0, 0, 9}, {1, 0, 0}), Axis::x, 1, "")}) ==
      "the secondary datum lies on the primary axis and gives no direction");
}

TEST_CASE("ROTATE turns about the frame's own axis toward a feature") {
  const Element line = kPose * at({9, 9, 9}, {1, 1, 0.5});
  const Rigid X = rotated_to(kPose, Axis::z, Shape::line, line, {Axis::x, 1}).value;
  check_near(X.p, kPose.p);
  check_near(X.R.cz, kPose.R.cz);
  check_near(transpose(kPose.R) * X.R.cx, unit({1, 1, 0}));
  const Rigid Y = rotated_to(kPose, Axis::z, Shape::line, line, {Axis::y, -1}).value;
  check_near(transpose(kPose.R) * Y.R.cy, unit({-1, -1, 0}));
  check_near(cross(Y.R.cx, Y.R.cy), Y.R.cz);
  CHECK(std::string(rotated_to({}, Axis::z, Shape::line, at({}, {0, 0, 1}), {Axis::x, 1}).failure) ==
        "the direction of the feature is parallel to the axis of rotation");
  CHECK(std::string(rotated_to({}, Axis::z, Shape::line, line, {Axis::z, 1}).failure) ==
        "an axis cannot be turned toward a feature about itself");
}

TEST_CASE("ROTATE toward what has no direction across the axis looks at its place") {
  const auto turned_x = [](Shape shape, const Element& e) {
    return transpose(kPose.R) * rotated_to(kPose, Axis::z, shape, kPose * e, {Axis::x, 1}).value.R.cx;
  };
  const Vec3 place{30, 30, -4}, diagonal = unit({1, 1, 0});
  check_near(turned_x(Shape::point, at(place, {0, 1, 0})), diagonal);  // its direction is the normal of a surface
  check_near(turned_x(Shape::sphere, at(place, {1, 0, 0})), diagonal);
  check_near(turned_x(Shape::circle, at(place, {0, 0, 1})), diagonal);
  check_near(turned_x(Shape::cylinder, at(place, {1e-3, 0, -1})), diagonal);
  check_near(turned_x(Shape::cylinder, at(place, {0, 1, 0})), {0, 1, 0});
  CHECK(std::string(rotated_to({}, Axis::z, Shape::point, at({0, 0.05, 9}, {1, 0, 0}), {Axis::x, 1}).failure) ==
        "the feature lies on the axis of rotation and gives no direction");
}

TEST_CASE("An outline in the primary plane gives the direction along it") {
  const Vec3 along = unit({3, 1, 0}), across{-along.y, along.x, 0};
  const Element outline =
      kPose * Element{.point = {30, 5, -4}, .direction = {0, 0, -1}, .size = 15, .minor_size = 5, .second = along};
  const Element top = kPose * at({40, 30, 0}, {0, 0, 1}), bore = kPose * at({0, 0, -7}, {0, 0, 1});
  const Mat3 turned{along, across, {0, 0, 1}};
  for (const Shape shape : {Shape::slot, Shape::rectangle, Shape::ellipse}) {
    CAPTURE(static_cast<int>(shape));
    const Rigid rotated = rotated_to(kPose, Axis::z, shape, outline, {Axis::y, -1}).value;
    check_near(transpose(kPose.R) * rotated.R.cy, -along);
    const DatumUse datums[] = {use(Shape::plane, top, Axis::z, 1, "Z"), use(shape, outline, Axis::x, 1, "XY")};
    check_near(datum_frame({}, datums).value, kPose * Rigid{turned, {30, 5, 0}});
    const Shape shapes[] = {Shape::plane, shape, Shape::cylinder};
    const Element slot_before[] = {top, outline, bore}, slot_after[] = {top, bore, outline};
    check_near(datum_reference_frame(shapes, slot_before).value, kPose * Rigid{turned, {30, 5, 0}});
    const Shape reordered[] = {Shape::plane, Shape::cylinder, shape};
    const Vec3 to_slot = unit({30, 5, 0});  // an arm of 30 mm turns more surely than the slot of 30 mm by itself
    check_near(datum_reference_frame(reordered, slot_after).value,
               kPose * Rigid{Mat3{to_slot, {-to_slot.y, to_slot.x, 0}, {0, 0, 1}}, {}});
    const Element near_bore = kPose * at({33, -4, -7}, {0, 0, 1}), slot_near[] = {top, near_bore, outline};
    check_near(datum_reference_frame(reordered, slot_near).value, kPose * Rigid{turned, {33, -4, 0}});
    // In a side face it is the normal, as of any feature there.
    Element aside = outline;
    aside.direction = kPose.R * Vec3{1, 0, 0}, aside.second = kPose.R * Vec3{0, 0.6, 0.8};
    check_near(rotated_to(kPose, Axis::z, shape, aside, {Axis::x, 1}).value, kPose);
  }
}

TEST_CASE("A cone locates by its apex, wherever it was touched") {
  const Vec3 apex_at{10, 20, -40}, axis = unit({0.1, 0, 1});
  for (const double touched_mm : {5.0, 25.0}) {
    const Element cone = kPose *
        Element{
            .point = apex_at + touched_mm * axis, .direction = axis, .size = touched_mm * std::tan(0.3), .angle = 0.3};
    const DatumUse datums[] = {locating(Shape::cone, cone, "XYZ")};
    check_near(datum_frame(kPose, datums).value, {kPose.R, kPose * apex_at});
    const Rigid seen = rotated_to(kPose, Axis::z, Shape::cone, cone, {Axis::x, 1}).value;
    check_near(transpose(kPose.R) * seen.R.cx, unit({10, 20, 0}));
  }
}

TEST_CASE("A plane is displaced along its nominal normal, an axis across its nominal direction") {
  const double t = 0.2;
  const Vec3 leaning{std::sin(t), 0, std::cos(t)};
  const Element nominal = at({}, {0, 0, 1});
  check_near(displacement(Shape::plane, at({10, 3, 1}, leaning), nominal), {0, 0, 1 + 10 * std::tan(t)});
  check_near(displacement(Shape::cylinder, at({1, 2, 10}, leaning), nominal), {1 - 10 * std::tan(t), 2, 0});
  check_near(displacement(Shape::sphere, at({1, 2, 10}, leaning), nominal), {1, 2, 10});
}

TEST_CASE("Datum reference frames of ISO 5459") {
  auto frame = [](std::initializer_list<Shape> shapes, std::vector<Element> datums) {
    return datum_reference_frame({shapes.begin(), shapes.size()}, datums).value;
  };
  const Rigid& X = kPose;
  const Element top = X * at({40, 30, 0}, {0, 0, 1}), side = X * at({0, 10, -5}, {1, 0, 0}),
                front = X * at({25, 0, -5}, {0, 1, 0});
  const Element bore = X * at({0, 0, -7}, {0, 0, 1}), other_bore = X * at({60, 0, -7}, {0, 0, 1});

  check_near(frame({Shape::plane, Shape::plane, Shape::plane}, {top, side, front}), X);
  check_near(frame({Shape::plane, Shape::cylinder, Shape::plane}, {top, bore, side}), X);
  check_near(frame({Shape::plane, Shape::cylinder, Shape::cylinder}, {top, bore, other_bore}), X);
  check_near(frame({Shape::cylinder, Shape::plane, Shape::plane}, {bore, top, side}), X);
  check_near(frame({Shape::plane, Shape::line, Shape::point},
                   {top, X * at({25, 0, -5}, {1, 0, 0}), X * at({0, 10, -5}, {1, 0, 0})}),
             X);
  check_near(frame({Shape::sphere, Shape::sphere, Shape::point},
                   {X * at({0, 0, 0}, {0, 0, 1}), X * at({0, 0, 50}, {0, 0, 1}), X * at({30, 0, 8}, {0, 0, 1})}),
             X);
  const double half = 0.3;
  const Element cone{.point = X * Vec3{0, 0, 20}, .direction = X.R.cz, .size = 20 * std::tan(half), .angle = half};
  check_near(frame({Shape::cone, Shape::plane}, {cone, side}), X);

  SUBCASE("a later datum changes nothing that an earlier one fixed") {
    const Element tilted_side = X * at({0, 10, -5}, {1, 0, 1e-3});
    const Rigid tilted = frame({Shape::plane, Shape::plane, Shape::plane}, {top, tilted_side, front});
    check_near(tilted,
               X);  // the secondary passes through its centroid at a right angle to the primary
    check_near(frame({Shape::plane, Shape::plane, Shape::cylinder}, {top, side, bore}), X);
    check_near(frame({Shape::plane, Shape::plane, Shape::plane}, {top, top, side}).R.cx, X.R.cx);
  }
  SUBCASE("a slanted tertiary plane passes through the origin") {
    const Element slanted = at({-20, 20, 3}, {1, 1, 0});
    check_near(frame({Shape::plane, Shape::plane, Shape::plane},
                     {at({5, 5, 0}, {0, 0, 1}), at({0, 5, 5}, {1, 0, 0}), slanted}),
               {});
  }
  SUBCASE("what no datum fixes is as in the identity") {
    check_near(frame({}, {}), {});
    const Rigid plane_only = frame({Shape::plane}, {at({9, 9, 4}, {0, 0, 1})});
    check_near(plane_only, {{}, {0, 0, 4}});
    const Rigid axis_only = frame({Shape::cylinder}, {at({9, 8, 4}, {0, 0, 1})});
    check_near(axis_only, {{}, {9, 8, 0}});
    check_near(frame({Shape::sphere}, {at({9, 8, 4}, {0, 0, 1})}), {{}, {9, 8, 4}});
    check_near(frame({Shape::torus}, {at({9, 8, 4}, {0, 0, 1})}), {{}, {9, 8, 4}});
  }
  const std::vector<Element> four(4);
  const Shape planes[] = {Shape::plane, Shape::plane, Shape::plane, Shape::plane};
  CHECK(std::string(datum_reference_frame(planes, four).failure) == "a datum reference frame has at most three datums");
}
