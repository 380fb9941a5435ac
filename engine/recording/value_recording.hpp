// A recording of values: what one machine reported of the characteristics of programs, not touch by touch
// (docs/recording.md, "Value recordings"). One row is one value, with what it should have been and how well
// that is known. All rows come from the same machine.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/base/source.hpp"
#include "engine/recording/recording.hpp"

namespace abbe {

struct ValueRow {
  std::string characteristic;       ///< as written: "LEN", "END1 END2 LEN" or "FA(END1),FA(END2),TA(LEN)"
  double value = 0;                 ///< mm or degrees, as reports say
  double last_digit = 0;            ///< what the last digit of the value counts; 0: not known
  std::optional<double> reference;  ///< the true value; none: what the program measures on an error-free machine
  double expanded_uncertainty = 0;  ///< U of the reference, k = 2
  int run = 1, occurrence = 1;      ///< repeat of the whole; which evaluation within the program
  int ordinal = 0;       ///< of a result file: which evaluation of this tolerance, of any features, 1, 2, ...; else 0
  std::string artefact;  ///< what was measured: rows of one artefact share the error of its calibration
  std::string program;   ///< path as seen from the recording; empty: the program that the command line names
  Span span;             ///< of the characteristic, in the file
};

struct ValueRecording {
  SourceFile source{"", ""};
  Metadata metadata;
  std::vector<ValueRow> rows;
  std::vector<Diagnostic> messages;  ///< of reading it: what is doubtful and no error
};

/// Throws UserError with the place of every mistake: lines that contradict each other, unknown or missing column, a value
/// that is no number, U below 0.
ValueRecording read_value_recording(const SourceFile&);

/// The labels that a characteristic names, in upper case, the tolerance last.
std::vector<std::string> labels_of(const std::string& characteristic);

}  // namespace abbe
