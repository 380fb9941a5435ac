#include "engine/diagnose/explanations/same_phase.hpp"

#include <doctest/doctest.h>
#include <numeric>

using namespace abbe;
using namespace abbe::diagnose;

namespace {

/// Faces along x that are touched from either side in turn, 20 mm from one to the next.
RecordedTouches faces(int count) {
  RecordedTouches t;
  for (int k = 0; k < count; ++k) {
    RecordedTouch touch;
    touch.scene.point = {20.0 * k, 0, 0};
    touch.scene.normal = {k % 2 ? 1.0 : -1.0, 0, 0};
    t.touches.push_back(touch);
  }
  return t;
}

std::vector<int> all(const RecordedTouches& t) {
  std::vector<int> rows(t.touches.size());
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

}  // namespace

TEST_CASE("a function of the normal is alike wherever touches have the same direction, another is not") {
  const RecordedTouches t = faces(20);
  const SameDirection direction(t, all(t));
  Matrix by_normal(20, 2), by_place(20, 1);
  for (int k = 0; k < 20; ++k) {
    const double x = t.touches[static_cast<std::size_t>(k)].scene.normal.x;
    by_normal.row(k) << x, 0.5 + x;
    by_place(k, 0) = k % 4 < 2 ? 1 : -1;
  }
  CHECK(direction.is_alike(by_normal));
  CHECK_FALSE(direction.is_alike(by_place));
}

TEST_CASE("few places, or one that is touched again and again, say nothing of it") {
  RecordedTouches few = faces(6), one = faces(20);
  for (RecordedTouch& touch : one.touches) touch.scene.point.x = touch.scene.normal.x;
  CHECK_FALSE(SameDirection(few, all(few)).is_alike(Matrix::Ones(6, 1)));
  CHECK_FALSE(SameDirection(one, all(one)).is_alike(Matrix::Ones(20, 1)));
}
