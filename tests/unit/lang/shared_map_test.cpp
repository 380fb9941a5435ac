#include "lang/shared_map.hpp"

#include <doctest/doctest.h>

#include <map>
#include <random>
#include <string>
#include <vector>

using namespace abbe::lang;

namespace {

/// A key that counts how often keys are compared: what an operation costs.
struct CountedKey {
  int value = 0;
  static inline int comparisons = 0;
  bool operator==(const CountedKey& other) const { return ++comparisons, value == other.value; }
  bool operator<(const CountedKey& other) const { return ++comparisons, value < other.value; }
};

using Plain = std::map<int, std::string>;

Plain plain(const SharedMap<int, std::string>& map) {
  Plain out;
  int last = -1;
  map.each([&](int key, const std::string& value) {
    CHECK(key > last);
    last = key;
    out.emplace(key, value);
  });
  return out;
}

}  // namespace

template <>
struct std::hash<CountedKey> {
  std::size_t operator()(const CountedKey& key) const { return static_cast<std::size_t>(key.value); }
};

TEST_CASE("a shared map does what a map does, and its copies stay as they were") {
  std::mt19937 random(1);
  SharedMap<int, std::string> map, copy;
  Plain expected, expected_copy;
  for (int step = 0; step < 5000; ++step) {
    const int key = static_cast<int>(random() % 200);
    if (random() % 3 == 0) {
      map.erase(key);
      expected.erase(key);
    } else {
      map.set(key, std::to_string(step));
      expected[key] = std::to_string(step);
    }
    REQUIRE(map.has(key) == (expected.count(key) == 1));
    if (step % 97 == 0) {
      REQUIRE(plain(copy) == expected_copy);
      copy = map;
      expected_copy = expected;
    }
  }
  CHECK(plain(map) == expected);
  CHECK(map.find(-1) == nullptr);
}

TEST_CASE("differences are the entries of the other map that are not the same here") {
  SharedMap<int, std::string> before;
  for (int k = 0; k < 100; ++k) before.set(k, "before");
  SharedMap<int, std::string> one = before, other = before;
  one.set(7, "one"), one.set(200, "one"), one.erase(9);
  other.set(7, "other"), other.set(50, "other"), other.set(300, "other"), other.erase(8);
  std::vector<std::string> found;
  one.differences(other, [&](int key, const std::string* here, const std::string& there) {
    found.push_back(std::to_string(key) + " " + (here ? *here : "none") + " " + there);
  });
  CHECK(found == std::vector<std::string>{"7 one other", "9 none before", "50 before other", "300 none other"});
}

TEST_CASE("copies and their differences cost what was changed, not what is there") {
  SharedMap<CountedKey, int> before;
  for (int k = 0; k < 20000; ++k) before.set({k}, k);
  CountedKey::comparisons = 0;
  SharedMap<CountedKey, int> one = before, other = before;
  one.set({20001}, 1);
  other.set({12345}, 2);
  int found = 0;
  one.differences(other, [&](const CountedKey&, const int*, int) { ++found; });
  CHECK(found == 1);
  CHECK(CountedKey::comparisons < 5000);
}
