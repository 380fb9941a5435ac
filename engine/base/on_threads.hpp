// Independent pieces of work on several threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace abbe {

/// f(0) .. f(count - 1), each on some thread. f writes to its own slot, so the order does not matter. The
/// first exception ends the work and is thrown again here.
template <class F>
void on_threads(int count, int threads, const F& f) {
  std::atomic<int> next = 0;
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&] {
    for (int k = next++; k < count; k = next++) {
      try {
        f(k);
      } catch (...) {
        const std::lock_guard lock(failure_mutex);
        if (!failure) failure = std::current_exception();
        next = count;
      }
    }
  };
  {
    std::vector<std::jthread> helpers;
    try {
      for (int t = 1; t < std::min(threads, count); ++t) helpers.emplace_back(work);
    } catch (const std::system_error&) {
      // The computer has no more threads to give: fewer do the same work.
    }
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace abbe
