#include "engine/features/nominal.hpp"

namespace abbe {

Outcome<Element> located(const Arguments& arguments) {
  const Outcome<Vec3> along = direction(arguments);
  if (!along) return Outcome<Element>::failed(along.failure);
  return {{.point = location(arguments), .direction = along.value}};
}

FeatArguments written_location(const Element& e) { return {"CART", e.point, e.direction}; }

Vec3 location(const Arguments& arguments) {
  if (!arguments.has("r")) return {arguments.number("x"), arguments.number("y"), arguments.number("z")};
  const double r = arguments.number("r"), a = arguments.number("a");
  return {r * std::cos(a), r * std::sin(a), arguments.number("h")};
}

Outcome<Vec3> direction(const Arguments& arguments) {
  const Vec3 v{arguments.number("i"), arguments.number("j"), arguments.number("k")};
  const double length = norm(v);
  if (!(length > 0)) return Outcome<Vec3>::failed("the direction vector has no length");
  if (!std::isfinite(length)) return Outcome<Vec3>::failed("the direction vector is not finite");
  return {v / length};
}

Outcome<double> radius(const Arguments& arguments, const char* name) {
  const double diameter = arguments.number(name);
  if (!(diameter > 0)) return Outcome<double>::failed("the diameter must be positive");
  return {diameter / 2};
}

}  // namespace abbe
