// What every text must survive: reading, formatting, and, as far as it is a program, a short run.
#pragma once

#include <string>

namespace abbe::fuzz {

struct Outcome {
  bool compiled = false;  ///< without errors
  bool ran = false;       ///< to its end on the error-free machine
};

/// Aborts when something that must hold of every text does not: each message has its place inside
/// the text; a formatted text formats to itself and means the same. Whatever cannot be run is
/// refused with a message.
Outcome exercise(const std::string& text);

}  // namespace abbe::fuzz
