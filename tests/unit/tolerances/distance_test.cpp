#include "tests/unit/tolerances/evaluation.hpp"

using namespace abbe;
using namespace abbe::test;
using doctest::Approx;

namespace {

Evaluation nominal_distance(const char* word, const char* axis, double nominal, double lower,
                            double upper) {
  Evaluation e(word);
  e.number("nominal", nominal).number("lower", lower).number("upper", upper).word("axis", axis);
  return e;
}

}  // namespace

TEST_CASE("DISTB along an axis and straight, unsigned") {
  const Element a = at({10, 20, 30}), b = at({7, 24, 42});
  for (const auto& [axis, distance] :
       {std::pair{"XAXIS", 3.0}, {"YAXIS", 4.0}, {"ZAXIS", 12.0}, {"PT2PT", 13.0}}) {
    CHECK(nominal_distance("DISTB", axis, distance, -0.1, 0.1)
              .feature(Shape::point, a)
              .feature(Shape::point, b)
              .value() == Approx(distance));
    CHECK(nominal_distance("DISTB", axis, distance, -0.1, 0.1)
              .feature(Shape::point, b)
              .feature(Shape::point, a)
              .value() == Approx(distance));
  }
  Evaluation e = nominal_distance("DISTB", "XAXIS", 3, -0.1, 0.2);
  e.feature(Shape::point, a).feature(Shape::point, b);
  CHECK(e.nominal_value() == 3);
  CHECK(*e.limits().lower == Approx(2.9));
  CHECK(*e.limits().upper == Approx(3.2));
  CHECK(e.refusal().empty());
}

TEST_CASE("DISTB with LIMIT takes its nominal from the nominal features") {
  Evaluation e("DISTB");
  e.number("lower", 2.8)
      .number("upper", 3.1)
      .word("axis", "XAXIS")
      .feature(Shape::point, at({10, 0, 0}))
      .feature(Shape::point, at({7.1, 0, 0}), at({7, 0, 0}));
  CHECK(e.value() == Approx(2.9));
  CHECK(e.nominal_value() == Approx(3));
  CHECK(*e.limits().lower == 2.8);
  CHECK(*e.limits().upper == 3.1);
}

TEST_CASE("A distance is signed where its limits allow negative values") {
  const Element a = at({10, 0, 0}), b = at({9.98, 0, 0});
  CHECK(nominal_distance("DISTB", "XAXIS", 0, -0.1, 0.1)
            .feature(Shape::point, a)
            .feature(Shape::point, b)
            .value() == Approx(-0.02));
  CHECK(nominal_distance("DISTB", "XAXIS", 0, -0.1, 0.1)
            .feature(Shape::point, b)
            .feature(Shape::point, a)
            .value() == Approx(0.02));
  CHECK(nominal_distance("DISTB", "XAXIS", 0, 0, 0.1)
            .feature(Shape::point, a)
            .feature(Shape::point, b)
            .value() == Approx(0.02));
  CHECK(nominal_distance("DISTB", "PT2PT", 0, -0.1, 0.1)
            .feature(Shape::point, a)
            .feature(Shape::point, b)
            .value() == Approx(0.02));
  CHECK(nominal_distance("DISTB", "PT2PT", 0, -0.1, 0.1)
            .feature(Shape::point, a)
            .feature(Shape::point, a)
            .value() == 0);
}

TEST_CASE("MAX and MIN reach to the far and near ends") {
  auto value = [](const char* use, Shape s, const Element& a, Shape t, const Element& b) {
    return nominal_distance("DISTB", "XAXIS", 30, -1, 1)
        .word("use", use)
        .feature(s, a)
        .feature(t, b)
        .value();
  };
  const Element s = sized(at({0, 0, 0}), 5), t = sized(at({30, 9, 0}), 3);
  CHECK(value("MAX", Shape::sphere, s, Shape::sphere, t) == Approx(38));
  CHECK(value("MIN", Shape::sphere, s, Shape::sphere, t) == Approx(22));
  CHECK(value("MIN", Shape::sphere, t, Shape::sphere, s) == Approx(22));
  CHECK(value("AVG", Shape::sphere, s, Shape::sphere, t) == Approx(30));
  CHECK(value("MIN", Shape::sphere, s, Shape::sphere, sized(at({6, 0, 0}), 5)) == 0);
  // A circle square to x has no extent along it; one at 60 degrees reaches r sin 60.
  CHECK(value("MAX", Shape::circle, sized(at({}, {1, 0, 0}), 5), Shape::point, t) == Approx(30));
  CHECK(value("MAX", Shape::circle, sized(at({}, {0.5, std::sqrt(0.75), 0}), 5), Shape::point, t) ==
        Approx(30 + 5 * std::sqrt(0.75)));
  CHECK(value("MAX", Shape::line, spanning(at({}, {-0.6, 0.8, 0}), -10, 20), Shape::point, t) ==
        Approx(42));
  CHECK(value("MIN", Shape::line, spanning(at({}, {-0.6, 0.8, 0}), -10, 20), Shape::point, t) ==
        Approx(24));
  CHECK(value("MAX", Shape::plane, spread(at({}, {1, 0, 0}), -0.1, 0.2), Shape::torus, t) ==
        Approx(30.1));
  CHECK(value("MIN", Shape::plane, spread(at({}, {1, 0, 0}), -0.1, 0.2), Shape::torus, t) ==
        Approx(29.8));
}

TEST_CASE("DISTWRT measures from its reference") {
  Evaluation e = nominal_distance("DISTWRT", "ZAXIS", 25, -0.1, 0.1);
  e.feature(Shape::sphere, at({1, 2, 3}))
      .feature(Shape::plane, at({0, 0, 28.01}), at({0, 0, 28}));  // the reference comes last
  CHECK(e.value() == Approx(25.01));
  CHECK(e.nominal_value() == 25);
  Evaluation about_zero = nominal_distance("DISTWRT", "YAXIS", 0, -0.1, 0.1);
  about_zero.feature(Shape::sphere, at({1, 2.03, 3})).feature(Shape::plane, at({0, 2, 0}));
  CHECK(about_zero.value() == Approx(0.03));
  Evaluation limit("DISTWRT");
  limit.number("lower", -6)
      .number("upper", -4)
      .word("axis", "YAXIS")
      .feature(Shape::point, at({0, 2, 0}))
      .feature(Shape::point, at({0, 7, 0}));
  CHECK(limit.value() == Approx(-5));
  CHECK(limit.nominal_value() == Approx(-5));
}
