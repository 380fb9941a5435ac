#include "engine/plan/expression.hpp"

#include <doctest/doctest.h>

using namespace abbe;
using namespace abbe::plan;

namespace {

Outcome<double> value_of(const Expression& e, double column = 0) {
  return evaluate(e, [&](ColumnId) { return column; });
}

}  // namespace

TEST_CASE("expressions are evaluated in postfix order") {
  // (7 - 4) * column
  const Expression e{PushConstant{7}, PushConstant{4}, Op2::subtract, PushColumn{{0}}, Op2::multiply};
  CHECK(value_of(e, 5).value == 15);
}

TEST_CASE("comparisons and logic give 0 and 1") {
  CHECK(value_of({PushConstant{1}, PushConstant{2}, Op2::less}).value == 1);
  CHECK(value_of({PushConstant{1}, PushConstant{2}, Op2::greater_equal}).value == 0);
  CHECK(value_of({PushConstant{3}, PushConstant{0}, Op2::logical_and}).value == 0);
  CHECK(value_of({PushConstant{3}, PushConstant{0}, Op2::logical_or, Op1::logical_not}).value == 0);
}

TEST_CASE("the Fortran-like functions of DMIS keep their sign rules") {
  CHECK(value_of({PushConstant{-3}, PushConstant{2}, Op2::sign}).value == 3);
  CHECK(value_of({PushConstant{3}, PushConstant{-2}, Op2::sign}).value == -3);
  CHECK(value_of({PushConstant{-7}, PushConstant{3}, Op2::modulo}).value == -1);
  CHECK(value_of({PushConstant{-2.7}, Op1::truncate}).value == -2);
  CHECK(value_of({PushConstant{-2.5}, Op1::round}).value == -3);
}

TEST_CASE("arithmetic without a result is a failure, never NaN or infinity") {
  CHECK_FALSE(value_of({PushConstant{1}, PushConstant{0}, Op2::divide}));
  CHECK_FALSE(value_of({PushConstant{-1}, Op1::sqrt}));
  CHECK_FALSE(value_of({PushConstant{0}, Op1::ln}));
  CHECK_FALSE(value_of({PushConstant{2}, Op1::asin}));
}

TEST_CASE("the reason of a failure completes \"this is ...\"") {
  CHECK(value_of({PushConstant{1000}, Op1::exp}).failure == std::string("a result that is too large"));
  CHECK(value_of({PushConstant{1e300}, PushConstant{1e300}, Op2::multiply}).failure ==
        std::string("a result that is too large"));
}
