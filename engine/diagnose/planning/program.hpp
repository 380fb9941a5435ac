// The new touches of a proposed measurement as a DMIS program that is ready to run. Labels and touch numbers are those of the
// recording, so that what it records can be matched with a workpiece file and with the recording; how touches
// were made (speeds, approach, compensation) is repeated as far as the recording tells it, and what it does
// not tell is said in a comment.
#pragma once

#include <string>

#include "engine/diagnose/planning/second_recording.hpp"

namespace abbe::diagnose {

/// How the recording of the new touches is told from those before: "Give its recording run 2 and setup 2: ..."; where the part
/// is taken to stay as it stands, that it must.
std::string recording_sentence(const Longer&);
/// The new touches as a DMIS program.
std::string dmis_program(const Case&, const Longer&, const Change&);

}  // namespace abbe::diagnose
