#include "programs/thread_count.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "engine/base/diagnostic.hpp"

namespace abbe {

int thread_count(int asked) {
  if (asked < 0 || asked > kMostThreads)
    throw UserError(diagnostic(Code::E0603,
                               fmt::format("{} threads were asked for; expected 1 to {}", asked, kMostThreads),
                               "leave --threads out to use the whole computer"));
  return asked > 0 ? asked : std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, kMostThreads);
}

}  // namespace abbe
