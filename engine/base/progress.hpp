// What long work is at, for somebody who waits for it.
#pragma once

#include <functional>
#include <string_view>

namespace abbe {

/// Called between the steps of long work with what begins now; may be empty. Never from two threads.
using Progress = std::function<void(std::string_view step)>;

inline void begins(const Progress& progress, std::string_view step) {
  if (progress) progress(step);
}

}  // namespace abbe
