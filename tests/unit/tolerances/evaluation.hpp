// One evaluation written out: features with their nominals, datums with their nominal ones, arguments.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "engine/tolerances/tolerance.hpp"

namespace abbe::test {

struct Evaluation {
  const ToleranceKind* kind;
  Arguments arguments;
  std::vector<Shape> shapes, datum_shapes;
  std::vector<Element> actual, nominal, datums, nominal_datums;
  std::vector<TouchedPoint> touches, second_touches;
  std::vector<Vec3> faces;

  explicit Evaluation(const char* word) : kind(find_tolerance_kind(word)) { REQUIRE(kind); }

  Evaluation& number(const char* name, double value) { return arguments.add_number(name, value), *this; }
  Evaluation& word(const char* name, const char* value) { return arguments.add_text(name, value), *this; }
  Evaluation& feature(Shape shape, const Element& as_measured, const Element& as_nominal) {
    shapes.push_back(shape), actual.push_back(as_measured), nominal.push_back(as_nominal);
    return *this;
  }
  Evaluation& feature(Shape shape, const Element& both) { return feature(shape, both, both); }
  Evaluation& datum(Shape shape, const Element& as_measured, const Element& as_nominal) {
    arguments.add_feature("datum", static_cast<int>(datums.size()));
    datum_shapes.push_back(shape), datums.push_back(as_measured), nominal_datums.push_back(as_nominal);
    return *this;
  }
  Evaluation& datum(Shape shape, const Element& both) { return datum(shape, both, both); }

  Outcome<double> outcome() const {
    return kind->evaluate(
        arguments, {shapes, actual, nominal, datum_shapes, datums, nominal_datums, touches, second_touches, faces});
  }
  double value() const {
    const Outcome<double> made = outcome();
    INFO(std::string(made.failure ? made.failure : ""));
    REQUIRE(made);
    return made.value;
  }
  std::string failure() const {
    const Outcome<double> made = outcome();
    return made ? "" : made.failure;
  }
  double nominal_value() const { return kind->nominal(arguments, shapes, nominal); }
  ToleranceLimits limits() const { return kind->limits(arguments, nominal); }
  std::string refusal() const {
    const char* reason = kind->applies(arguments, shapes);
    return reason ? reason : "";
  }
};

inline Element at(Vec3 point, Vec3 direction = {0, 0, 1}) { return {.point = point, .direction = unit(direction)}; }
inline Element sized(Element e, double size) { return e.size = size, e; }
inline Element spanning(Element e, double begin, double end) { return e.begin = begin, e.end = end, e; }
inline Element spread(Element e, double low, double high) { return e.low = low, e.high = high, e; }

}  // namespace abbe::test
