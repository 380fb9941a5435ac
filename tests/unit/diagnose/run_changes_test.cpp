#include "engine/diagnose/explanations/run_changes.hpp"

#include <doctest/doctest.h>

#include <array>
#include <set>
#include <utility>

#include "tests/unit/diagnose/scattered.hpp"

using namespace abbe;
using namespace abbe::diagnose;

TEST_CASE("stretches of runs hold every run once, and few runs stand for themselves") {
  std::vector<LaterRun> single;
  for (int k = 0; k < 20; ++k) single.push_back({10 + k, {double(k), double(k + 1)}, 100.0 * k});
  const std::vector<LaterRun> stretches = in_stretches(single, 8);
  REQUIRE(stretches.size() == 8);
  CHECK(stretches.front().runs.low == 0);
  CHECK(stretches.back().runs.high == 20);
  for (std::size_t k = 0; k < stretches.size(); ++k) {
    if (k > 0) CHECK(stretches[k].runs.low == stretches[k - 1].runs.high);
    CHECK(stretches[k].from_run >= 10 + stretches[k].runs.low);
    CHECK(stretches[k].from_run < 10 + stretches[k].runs.high);
  }
  const std::vector<LaterRun> few = in_stretches({single.begin(), single.begin() + 3}, 8);
  REQUIRE(few.size() == 3);
  for (std::size_t k = 0; k < 3; ++k)
    CHECK((few[k].from_run == single[k].from_run && few[k].runs.high == few[k].runs.low + 1));
}

TEST_CASE("what settles begins once, in each file, or in one of several that have runs of their own") {
  Planted at(1);
  const auto changes = [&](int files, int runs) {
    for (int i = 0; i < at.count(); ++i)
      at.c.touches.touches[i].file = i * files / at.count(), at.scene(i).run = 1 + i * runs / at.count();
    std::set<std::array<int, 3>> out;
    for (const Variant& v : named_explanations(at.c.touches, at.c.rows, {"thermal.drift"}).variants)
      out.insert({v.change.from, v.change.until, v.change.in_each_file ? 1 : 0});
    return out;
  };
  using Changes = std::set<std::array<int, 3>>;
  CHECK(changes(1, 3) == Changes{{0, 0, 0}});
  CHECK(changes(3, 1) == Changes{{0, 0, 0}, {0, 0, 1}});
  CHECK(changes(3, 3) == Changes{{0, 0, 0}, {0, 0, 1}, {0, 2, 1}, {2, 3, 1}, {3, 0, 1}});
  CHECK(changes(2, 4) == Changes{{0, 0, 0}, {0, 0, 1}, {0, 3, 1}, {3, 0, 1}});
}

TEST_CASE("of the runs of a week each may be the only one in which something was") {
  Planted at(1);
  for (const int runs : {3, 6}) {
    for (int i = 0; i < at.count(); ++i) at.scene(i).run = 1 + i * runs / at.count();
    std::set<std::array<int, 2>> found;
    for (const Variant& v : named_explanations(at.c.touches, at.c.rows, {"probe.tip_radius"}).variants)
      found.insert({v.change.from, v.change.until});
    for (int run = 2; run < runs; ++run) CHECK(found.contains({run, run + 1}));
    CHECK(found.contains({runs, 0}));
  }
}

TEST_CASE("a delay that shows at another speed than that of the qualification is new in no run") {
  Planted at(1);
  std::set<std::pair<double, bool>> found;
  for (int i = 0; i < at.count(); ++i)
    at.scene(i).run = 1 + i * 2 / at.count(), at.scene(i).speed_mm_s = i % 2 == 0 ? 3 : 8;
  for (const Variant& v : named_explanations(at.c.touches, at.c.rows, {"probe.trigger_delay"}).variants)
    found.emplace(v.theta[1], v.change.any());
  CHECK(found == std::set<std::pair<double, bool>>{{0, false}, {0, true}, {3, false}, {8, false}});
}
