// SPDX-License-Identifier: Apache-2.0
// Decimal texts at and beyond the ends of a double's range.
#include <catch2/catch.hpp>
#include <cchip/internal/geometry/decimal.hpp>
#include <cmath>
#include <string>
#include <vector>

using cchip::has_decimal_comma;
using cchip::read_decimal;

TEST_CASE("decimal: in range", "[lib][decimal]") {
  CHECK(read_decimal("3") == 3);
  CHECK(read_decimal("+3.5") == 3.5);
  CHECK(read_decimal("-.25e1") == -2.5);
  CHECK(read_decimal("1.7976931348623157e308") == 0x1.fffffffffffffp1023);
  CHECK(read_decimal("2.2250738585072014e-308") == 0x1p-1022);
  CHECK(read_decimal("4.9406564584124654e-324") == 0x1p-1074);
  CHECK(read_decimal("2.4703282292062328e-324") == 0x1p-1074);  // a little more than half of it
  CHECK(read_decimal("1" + std::string(400, '0') + "e-400") == 1);
  CHECK(read_decimal("0." + std::string(400, '0') + "1e401") == 1);
  CHECK(std::isinf(read_decimal("-inf").value()));
  CHECK(std::isnan(read_decimal("nan").value()));
}

TEST_CASE("decimal: too large is infinite, too small is zero", "[lib][decimal]") {
  const std::string zeros(400, '0');
  for (const std::string sign : {"", "-"}) {
    for (const std::string& text :
         std::vector<std::string>{std::string("1e400"), std::string("1.5E+400"), "1" + zeros, "1" + zeros + ".5",
                                  "0.0001e400", ".5e310", "0." + zeros + "1e800", "00012e999999999999999999999999"}) {
      CAPTURE(text);
      REQUIRE(read_decimal(sign + text).has_value());
      CHECK(*read_decimal(sign + text) == (sign.empty() ? INFINITY : -INFINITY));
    }
    for (const std::string& text :
         std::vector<std::string>{std::string("1.5e-400"), std::string("2.4703282292062327e-324"), "0." + zeros + "1",
                                  "1" + zeros + "e-800", std::string("1234.5E-999"),
                                  std::string("9e-99999999999999999999999"), std::string("0e999999999999999999")}) {
      CAPTURE(text);
      REQUIRE(read_decimal(sign + text).has_value());
      CHECK(*read_decimal(sign + text) == 0);
      CHECK(std::signbit(*read_decimal(sign + text)) == !sign.empty());
    }
  }
}

TEST_CASE("decimal: what is no number", "[lib][decimal]") {
  for (const char* const text :
       {"", "+", "-", "+-1", "++1", "1e", "1e+", "0x10", "1 ", " 1", "1,5", "e5", ".", "1e400x"}) {
    CAPTURE(text);
    CHECK_FALSE(read_decimal(text).has_value());
  }
  CHECK(has_decimal_comma("1,5"));
  CHECK(has_decimal_comma("-0,25e3"));
  for (const char* const text : {"1.5", "1,5,2", "1.5,2", "a,b", ","}) {
    CAPTURE(text);
    CHECK_FALSE(has_decimal_comma(text));
  }
}
