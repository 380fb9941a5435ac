#include "engine/diagnose/explanations/refine.hpp"

#include <doctest/doctest.h>

#include "tests/unit/diagnose/scattered.hpp"

using namespace abbe;
using namespace abbe::diagnose;

TEST_CASE("finer variants are along the axis of the coarse one") {
  Planted at(1);
  at.plant("thermal.drift", {3, 0, 400, 0, 4e4});  // um along x, with 400 s
  Explanations all = named_explanations(at.c.touches, at.c.rows, {"thermal.drift"});
  EvidenceSearch search(at.c.model, at.c.hyper, all);
  const std::size_t coarse = all.variants.size();
  refine(at.c, all, search);
  REQUIRE(all.variants.size() > coarse);
  int along_x = 0;
  for (std::size_t k = coarse; k < all.variants.size(); ++k) {
    const Variant& fine = all.variants[k];
    along_x += fine.axis == 0 ? 1 : 0;
    CHECK(fine.signature.cols() == (fine.axis < 0 ? 3 : 1));
  }
  CHECK(along_x > 0);
}
