#include "engine/base/numbers.hpp"

#include <doctest/doctest.h>

using namespace abbe;

TEST_CASE("numbers are finite, with a decimal point and nothing beside them") {
  CHECK(finite_number("12.5") == 12.5);
  CHECK(finite_number("+3") == 3);
  CHECK(finite_number("-2e-4") == -2e-4);
  for (const char* text : {"", "+", "+-3", "++3", " 3", "3 ", "3,5", "3mm", "1e999", "nan", "NaN", "inf", "-inf",
                           "infinity", "nan(1)", "0x1p3"})
    CHECK_MESSAGE(!finite_number(text), text);
}

TEST_CASE("the last digit of a number counts what its place says") {
  CHECK(last_digit("12") == 1);
  CHECK(last_digit("2.150") == doctest::Approx(0.001).scale(0));
  CHECK(last_digit("-0.00000") == doctest::Approx(1e-5).scale(0));
  CHECK(last_digit("1.5e-3") == doctest::Approx(1e-4).scale(0));
  CHECK(last_digit("2E2") == doctest::Approx(100));
}
