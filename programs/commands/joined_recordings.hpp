// Several recordings of one machine as one: which touches are repeats, which are copies, and what the files must agree in.
#pragma once

#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/recording/recording.hpp"

namespace abbe {

/// The recordings of these files as one. `messages`: what is to be said of them. Throws UserError as read_recording does,
/// where files cannot belong together (E0707), and where one is a copy of another (E0713).
Recording joined(const std::vector<SourceFile>& files, Positions, std::vector<Diagnostic>& messages);

}  // namespace abbe
