#include "engine/diagnose/findings/displacements.hpp"

#include <doctest/doctest.h>

#include "tests/unit/diagnose/scattered.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

/// Two effects of these sizes, of which the second does what the first does but for a tenth of it.
std::vector<Vector> displacements_of(double first, double second) {
  Planted p(6);
  const auto column = [&](auto of) {
    Matrix m(p.count(), 1);
    for (int i = 0; i < p.count(); ++i) m(i, 0) = of(p.scene(i));
    return m;
  };
  const Matrix one = column([](const TouchScene& s) { return s.normal.z * s.point.x / 500; });
  const Matrix other = one + 0.1 * column([](const TouchScene& s) { return s.normal.y * s.point.z / 300; });
  p.c.model.y += first * one.col(0) + second * other.col(0);
  return displacements(p.c, {&one, &other});
}

}  // namespace

TEST_CASE("two names that nearly undo each other are told apart from two that do not") {
  for (const double other : {-100.0, 100.0}) {
    const std::vector<Vector> each = displacements_of(100, other);
    CHECK(nearly_cancelled(each, 0) == (other < 0));
    CHECK(nearly_cancelled(each, 1) == (other < 0));
  }
}

TEST_CASE("a name by itself undoes nothing") {
  Planted p(1);
  p.plant("probe.tip_radius", {1.2, 0});
  p.find({"probe.tip_radius"});
  CHECK_FALSE(nearly_cancelled(displacements(p.c, signatures_of(p.c, p.result)), 0));
}
