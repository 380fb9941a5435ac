#include "tests/fuzz/faults.hpp"

#include <cstdio>
#include <limits>

namespace abbe::fuzz {

int commit_fault(std::string_view name) {
  // volatile: the compiler may neither see the fault coming nor leave it out.
  volatile int size = 4;
  if (name == "overrun") {
    volatile int* array = new int[static_cast<std::size_t>(size)];
    array[size] = 1;
    delete[] array;
  } else if (name == "overflow") {
    volatile int sum = std::numeric_limits<int>::max();
    sum = sum + size;
  } else if (name == "leak") {
    int* volatile lost = new int[static_cast<std::size_t>(size)];
    lost[0] = 1;
    lost = nullptr;
  } else {
    std::fprintf(stderr, "no fault has the name %.*s\n", static_cast<int>(name.size()), name.data());
    return 2;
  }
  std::fprintf(stderr, "nothing found the fault\n");
  return 0;
}

}  // namespace abbe::fuzz
