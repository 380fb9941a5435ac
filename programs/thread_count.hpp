// How many threads a command works with: what --threads asks for, else as many as the computer has.
#pragma once

namespace abbe {

/// The stacks of so many take 2 GB of addresses; more are slower.
inline constexpr int kMostThreads = 256;

/// `asked`: 0 without the option. Throws UserError (E0603) beyond 1 to kMostThreads.
int thread_count(int asked);

}  // namespace abbe
