// COG: the mean of the points of features, each with the same weight. TR: the same element under a
// new label.
#include "engine/features/constructions/tools.hpp"

namespace abbe {
namespace {

const char* centre_applies(Shape result, Shapes) { return result == Shape::point ? nullptr : "COG makes a point"; }

Outcome<Element> centre(Shape, Shapes shapes, Elements from, const Element& nominal, const Arguments&) {
  Vec3 sum;
  for (std::size_t k = 0; k < from.size(); ++k) sum += location_of(shapes[k], from[k]);
  return {{.point = sum / static_cast<double>(from.size()), .direction = nominal.direction}};
}

const char* transfer_applies(Shape result, Shapes shapes) {
  return result == shapes[0] ? nullptr : "TR takes over a feature of the same kind";
}

Outcome<Element> transfer(Shape, Shapes, Elements from, const Element&, const Arguments&) { return {from[0]}; }

}  // namespace

extern const Construction centre_of_gravity_method{
    .word = "COG",
    .signature = "from:feature,{ from:feature }",
    .help = "the mean of the points or centres of features",
    .example = "CONST/POINT,F(P),COG,FA(A),FA(B),FA(C)",
    .source = "ISO 22093:2011, CONST COG",
    .applies = centre_applies,
    .construct = centre,
};

extern const Construction transferred_method{
    .word = "TR",
    .signature = "from:feature",
    .help = "the same element under another label",
    .example = "CONST/PLANE,F(P2),TR,FA(P1)",
    .source = "ISO 22093:2011, CONST TR",
    .applies = transfer_applies,
    .construct = transfer,
};

}  // namespace abbe
