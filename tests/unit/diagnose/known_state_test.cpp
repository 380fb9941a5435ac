#include "engine/diagnose/baseline/known_state.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

using namespace abbe;
using namespace abbe::diagnose;

TEST_CASE("a known state says the same when it is read again") {
  KnownGeometry known{Vector{{0.1, -2.0 / 3, 1e-17}}, Matrix::Zero(3, 3)};
  known.factor.col(0) << 1.0 / 3, 0, -0.25;
  known.factor.col(2) << 0, 7e-9, 1;
  Hyperparameters hyper;
  hyper.scale = 1.25;
  const auto written = nlohmann::json::parse(write_known_state(known, hyper));
  CHECK(written["schema"] == KnownState::kSchema);
  CHECK(written["geometry_scale"] == 1.25);
  CHECK(written["factor"].size() == 2);  // without the column of which nothing is open
  const KnownGeometry read = known_geometry({written["mean"], written["factor"]});
  CHECK(read.mean == known.mean);
  CHECK(read.factor * read.factor.transpose() == known.factor * known.factor.transpose());
}

TEST_CASE("a machine of which nothing is open has a covariance of zero") {
  const KnownGeometry read = known_geometry({{1, 2}, {}});
  CHECK(read.factor.rows() == 2);
  CHECK(read.factor.cols() == 1);
  CHECK(read.factor.norm() == 0);
}
