#include "engine/diagnose/model/explanation.hpp"

#include <doctest/doctest.h>

using namespace abbe;
using namespace abbe::diagnose;

TEST_CASE("groups of parameters share belief alike, and what is new in a later run has a tenth") {
  std::vector<Variant> variants(8);
  // Variants 0 to 3 belong to something else.
  variants[4].group = "gain";
  variants[5].group = "offset";
  variants[6].group = "offset";
  variants[7].group = "offset", variants[7].change.from = 2;
  Explanation e;
  e.variants = {4, 5, 6};
  share_belief(e, variants);
  CHECK(variants[4].weight == doctest::Approx(0.5));
  CHECK(variants[5].weight == doctest::Approx(0.25));
  CHECK(variants[6].weight == doctest::Approx(0.25));
  CHECK(variants[0].weight == 1);

  e.variants = {4, 5, 7};
  share_belief(e, variants);
  CHECK(variants[4].weight == doctest::Approx(0.9 * 2 / 3));
  CHECK(variants[5].weight == doctest::Approx(0.9 / 3));
  CHECK(variants[7].weight == doctest::Approx(0.1));
}

TEST_CASE("of a direction half is for any, and half for the axes") {
  std::vector<Variant> variants(4);
  for (int k = 1; k < 4; ++k) variants[k].axis = k - 1;
  Explanation e;
  e.variants = {0, 1, 2, 3};
  share_belief(e, variants);
  CHECK(variants[0].weight == doctest::Approx(0.5));
  for (int k = 1; k < 4; ++k) CHECK(variants[k].weight == doctest::Approx(0.5 / 3));
  CHECK_FALSE(alike(variants[0], variants[1]));
}

TEST_CASE("what is gone counts half of what is new") {
  std::vector<Variant> variants(3);
  variants[0].change.from = 2;
  variants[1].change.until = 2;
  Explanation e;
  e.variants = {0, 1};
  share_belief(e, variants);  // nothing that is in all runs: both hold all
  CHECK(variants[0].weight == doctest::Approx(2.0 / 3));
  CHECK(variants[1].weight == doctest::Approx(1.0 / 3));
  e.variants = {0, 1, 2};
  share_belief(e, variants);
  CHECK(variants[0].weight == doctest::Approx(0.1 * 2 / 3));
  CHECK(variants[1].weight == doctest::Approx(0.1 / 3));
  CHECK(variants[2].weight == doctest::Approx(0.9));
}

TEST_CASE("what began at any moment within a run and was mended counts as much as what is new in a run") {
  std::vector<Variant> variants(6);
  variants[1].change.from = 2;
  for (int k = 2; k < 6; ++k) variants[k].change.until = 3;
  const Effect& step = *find_effect("probe.step");
  Explanation e;
  e.variants = {0, 1, 2, 3, 4, 5};
  share_belief(e, variants);  // of an effect without a moment it is gone in all of the runs before
  CHECK(variants[1].weight == doctest::Approx(0.1 / 3));
  e.effect = &step;
  share_belief(e, variants);
  CHECK(variants[0].weight == doctest::Approx(0.9));
  CHECK(variants[1].weight == doctest::Approx(0.05));
  for (int k = 2; k < 6; ++k) CHECK(variants[k].weight == doctest::Approx(0.05 / 4));
}

TEST_CASE("columns are the same where none differs anywhere") {
  Matrix a(3, 2);
  a << 1, 2, 3, 4, 5, 6;
  Matrix b = a;
  CHECK(same_columns(a, b));
  b(2, 1) += 1e-8;
  CHECK_FALSE(same_columns(a, b));
  CHECK(same_columns(a, b, 1e-6));
  CHECK_FALSE(same_columns(a, a.leftCols(1), 1e-6));
}

TEST_CASE("columns seen before are found, the first of them, and others with the same sum are not") {
  std::vector<Variant> variants(5);
  variants[1].signature = Matrix::Constant(40, 2, 1e3 / 3);
  variants[2].signature = Matrix::Zero(40, 2);
  variants[2].signature(39, 1) = variants[1].signature.sum();
  variants[3].signature = variants[1].signature;
  variants[3].signature.array() += 0.9e-9;  // the same, as far as any touch tells
  variants[4].signature = -variants[1].signature;
  ColumnsSeen seen;
  for (const int k : {3, 2, 1}) seen.add(variants[k].signature, k);
  CHECK(seen.find(variants[1].signature, variants) == 1);
  CHECK(seen.find(variants[3].signature, variants) == 1);
  CHECK(seen.find(variants[2].signature, variants) == 2);
  CHECK(seen.find(variants[4].signature, variants) == -1);
  variants[4].signature = variants[1].signature;
  variants[4].signature(0, 0) += 1.1e-9;
  CHECK(seen.find(variants[4].signature, variants) == 3);  // 0.2e-9 from it there, and 0.9e-9 elsewhere
}
