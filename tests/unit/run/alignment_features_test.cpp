#include "engine/run/alignment_features.hpp"

#include <doctest/doctest.h>

#include "tests/unit/run/plan_builder.hpp"

using namespace abbe;
using namespace abbe::test;

namespace {

/// Four points; 4 is constructed from 0 and 1, 5 from 4 and 2.
PlanBuilder constructed() {
  PlanBuilder b;
  for (int i = 0; i < 4; ++i) b.point({100.0 * i, 0, 0}, {0, 0, 1});
  const auto first = b.feature(Shape::line, {}), second = b.feature(Shape::plane, {});
  b.append(plan::Construct{first, nullptr, {{0}, {1}}, {}});
  b.append(plan::Construct{second, nullptr, {first, {2}}, {}});
  return b;
}

}  // namespace

TEST_CASE("without a coordinate system from features no feature aligns") {
  PlanBuilder b = constructed();
  b.append(plan::TranslateFrame{{0}, {plan::OriginShift{Axis::x, {}, plan::Operand{5, {}}}}});
  CHECK(alignment_features(b.plan) == std::vector<char>(6, 0));
}

TEST_CASE("operands of DATSET, TRANS and ROTATE align") {
  PlanBuilder b = constructed();
  plan::DatumRef datum;
  datum.feature = {0};
  b.append(plan::SetDatumFrame{{0}, {datum}});
  b.append(plan::TranslateFrame{{0}, {plan::OriginShift{Axis::x, {1}, {}}}});
  b.append(plan::RotateFrame{{0}, Axis::z, {3}, {}, {}});
  CHECK(alignment_features(b.plan) == std::vector<char>{1, 1, 0, 1, 0, 0});
}

TEST_CASE("what a constructed operand was constructed from aligns, at any number of removes") {
  PlanBuilder b = constructed();
  b.append(plan::RotateFrame{{0}, Axis::z, {5}, {}, {}});
  CHECK(alignment_features(b.plan) == std::vector<char>{1, 1, 1, 0, 1, 1});
}
