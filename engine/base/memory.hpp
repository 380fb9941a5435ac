// How much a command may keep in memory. The system promises more than it has and ends whoever takes it at its
// word, so large demands are compared with this before the work.
#pragma once

namespace abbe {

/// What this computer has, or what the shell lets a program have (`ulimit -v`), whichever is less.
double memory_bytes();

}  // namespace abbe
