// How a diagnosis is put into words: the same in its sentences and in every report.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/diagnose/diagnosis.hpp"

namespace abbe {

/// With two significant digits and no exponent: "0.21", "4.5", "240".
std::string two_digits(double);
/// "delay 1.20 ± 0.08 ms": with two standard uncertainties, which have two significant digits (GUM 7.2.6); where the 95 %
/// interval lies to one side, "tau 2866 s (1401 to 11215)".
std::string with_uncertainty(const DiagnosedParameter&);
/// "delay 1.20 ms (1.12 to 1.28)": with the 95 % interval; "implausible" where the catalogue says so.
std::string with_interval(const DiagnosedParameter&);

/// What makes the mismatch, or what is new in a run: one title, or several that `data` ("this recording")
/// cannot tell apart; `parameters` are those of the first. `doubted`: it may be something else. `beside`: something else
/// was told before.
std::string explanation_sentence(const std::vector<std::string_view>& titles,
                                 const std::vector<DiagnosedParameter>& parameters, std::string_view data,
                                 RunChange change = {}, bool doubted = false, bool beside = false);
/// Its sizes in a table, and what they come to: "amplitude 0.0400 um (0.0324 to 0.0485); at most 1.4 um at a touch".
std::string sizes_in_words(const std::vector<DiagnosedParameter>&, std::optional<double> largest_um);
/// How large a pattern is: "2.3 um rms (2.1 to 2.5); at most 5.4 um at a touch".
std::string amplitude_in_words(const Unexplained&);
/// The names of an effect in a table: "machine.squareness, new in run 2"
std::vector<std::string> in_words(const DiagnosedEffect&);

/// The name of what could be detected: "probe.tip_radius, if new in a run"
std::string in_words(const Detectable&);
/// In which form it could be: "axis z, tau 26 s"
std::string form_in_words(const Detectable&);
/// Why an effect cannot be judged: "missing: load_kg"; `touches`: from those, not from values.
std::string why_not_judged(const CannotJudge&, bool touches);
/// The p of a value: "0.034"; "<0.001" where no virtual machine is as far out.
std::string p_in_words(const JudgedValue&);
/// What it would be taken for.
std::string looks_like(const Detectable&);

/// The same with a capital at its beginning.
std::string capitalised(std::string);

/// What is said of a diagnosis first: the first of these that holds.
enum class Headline {
  plan,                  ///< no value was looked at
  nothing_judged,        ///< the unknowns take up all that was touched, or there is nothing but targets
  beyond_specification,  ///< nothing was found, but lengths are beyond the machine's specification
  another_machine,       ///< not the machine that its file knows
  verdict,
};
Headline headline(const Diagnosis&);

/// Whether the names leave more than chance does, and no pattern says what.
bool doubtful(const Diagnosis&);

/// "located in time; strongest at time_s 10 to 60 s"; of a pattern without a name also which other factors do nearly as
/// well, as place and time where every feature was touched once. Empty where nothing was located.
std::string located_in_words(const Diagnosis&);

}  // namespace abbe
