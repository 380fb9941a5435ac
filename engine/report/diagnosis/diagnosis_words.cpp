#include <array>

#include "engine/report/report_words.hpp"

namespace abbe {

std::span<const ReportWord> diagnosis_words() {
  static constexpr std::array table = {
      ReportWord{"", "verdict", "no_mismatch, named, one_of, unexplained or cannot_judge"},
      ReportWord{"", "no_mismatch", "verdict: nothing was found that a machine in order does not do"},
      ReportWord{
          "", "named",
          "verdict: one effect explains the mismatch, with the probability told. As a column: how large an effect must "
          "be to get its name from such a recording"},
      ReportWord{"", "one_of", "verdict: several effects explain the mismatch equally well"},
      ReportWord{"", "unexplained",
                 "a mismatch is located, but no effect of the catalogue explains it: a pattern stands for it"},
      ReportWord{"", "cannot_judge",
                 "verdict, or effects of which nothing can be said: what would tell was not logged or did not change"},
      ReportWord{"", "p_value",
                 "how often chance alone shows as much to the whole search, of a machine in order; below 0.01 there "
                 "is a mismatch"},
      ReportWord{"", "adequacy_p_value", "how often chance leaves as much as the named effects do not explain"},
      ReportWord{"", "touches", "how many were judged"},
      ReportWord{"", "values", "of a recording of values: each with its deviation from the reference"},
      ReportWord{"deviation", "", "of a value from its reference"},
      ReportWord{"", "effects",
                 "what was named, each with its probability and its sizes; several members cannot be told apart"},
      ReportWord{"prob.", "probability",
                 "that the truth is among the names, given all explanations that were tried; 0.5 at most where the "
                 "text doubts them"},
      ReportWord{"explanation", "members", "the names that explain the mismatch; several cannot be told apart"},
      ReportWord{"size", "parameters",
                 "how large the effect is, with the interval that holds the truth in 95 of 100 cases"},
      ReportWord{"", "plausible", "whether a size is one that the catalogue holds possible"},
      ReportWord{"pattern", "shape", "what an unexplained mismatch looks like over the factor in which it is located"},
      ReportWord{"", "location",
                 "the factors in which the mismatch shows: time, position, direction, head, ...; the likeliest first"},
      ReportWord{"", "improvement", "how much better touches that were left out are predicted with what was found"},
      ReportWord{"gain", "log_score_gain",
                 "logarithm of how many times likelier the touches left out are with what was found, in nats: 3 are "
                 "twenty times; se is its standard error"},
      ReportWord{"", "residuals", "of every touch what is left of it, without and with what was found"},
      ReportWord{"", "runner_up", "the likeliest name outside the set that was found"},
      ReportWord{"detected", "smallest_detectable",
                 "from what size on such a recording shows an effect in 80 of 100 cases, for half of its forms"},
      ReportWord{"as", "form", "of which form of the effect a size is: its axis, its time constant, its stylus"},
      ReportWord{"looks like", "confounded_with", "what an effect of twice the detected size would be taken for"},
      ReportWord{"", "next_measurement", "what to change in a second recording, by what it tells for each minute"},
      ReportWord{"", "otherwise", "what else to do next: what to log, or what tells the explanations apart"},
      ReportWord{"", "baseline", "what a machine in order may do to these touches, as it was fitted"},
      ReportWord{"", "geometry_scale", "how large the machine's geometric errors are, in those of its specification"},
      ReportWord{"", "times_known_uncertainty",
                 "how many times what the machine file leaves uncertain of the machine the recording asks for"},
      ReportWord{"", "worst_length", "the third worst length between touches, beside the MPE of such lengths"},
      ReportWord{"", "length_beyond_mpe", "that length, where no machine of this specification measures it so wrong"},
      ReportWord{"", "rivals", "what simpler methods say of the same recording"},
      ReportWord{"", "machine", "that the recording was compared with"},
      ReportWord{"", "messages", "what was said of recording and machine, with its code"},
  };
  return table;
}

}  // namespace abbe
