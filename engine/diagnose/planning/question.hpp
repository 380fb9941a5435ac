// What a measurement is to decide: which of several explanations it is.
#pragma once

#include "engine/diagnose/findings/search.hpp"

namespace abbe::diagnose {

struct Question {
  std::vector<int> rivals;      ///< explanations; fewer than two: nothing is open
  std::vector<Finding> beside;  ///< effects that are there whichever of them it is
};

/// Those of the first finding that could not be told apart.
Question question_of(const SearchResult&);

/// What a plan leaves open: effects that look alike, each with those that it looks like. First those of which
/// most is to be expected, counted as the effects of typical size that would be seen; each effect is asked of
/// once. No more than `most`.
std::vector<Question> questions_of(const Case&, const std::vector<Detectable>&, std::size_t most);

}  // namespace abbe::diagnose
