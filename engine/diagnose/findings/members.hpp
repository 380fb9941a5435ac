// The names that a finding may have: which of them can be judged, which would have a possible size, and what each
// would be by itself.
#pragma once

#include "engine/diagnose/findings/search.hpp"

namespace abbe::diagnose {

/// Whether what was named could be judged from this recording.
bool judged(const Case&, const Finding&);

/// Whether a machine can have what was found of the first member, with what its file has of it.
bool possible_first(const Case&, const SearchResult&, std::size_t finding);

/// Of a set that can be judged those that can be stand first: a size in the unit of what was not logged tells nobody
/// anything.
void put_judged_members_first(const Case&, SearchResult&);

/// A member that would need a size which no such effect has, with what the machine file has of it, explains nothing
/// where another of its set does with a possible one. What was believed of it is believed of no other; the set is
/// filled up with the effects next in likelihood.
void drop_impossible_members(const Case&, SearchResult&);

/// The runner-up joins the set of the only finding where, with its best size, it fits the recording as well and predicts
/// touches left out as well: what sets the two apart is the size that was expected of each. `first`: of the whole recording.
void take_in_runner_up(const Case&, const EvidenceSearch& first, const Diagnosis&, SearchResult&);

/// The share of one member in what is believed of its set.
double share_of(const Explanations&, const Finding&, int member);
/// How far the first member of a set is believed by itself.
double belief_in_first(const Explanations&, const Finding&);

/// So many members of a set are told with a size.
inline constexpr std::size_t kSized = 5;

/// The members of the set of a finding, the first as it was told. The changes told become those of what has the sizes.
std::vector<DiagnosedMember> members_of(const Case&, const SearchResult&, std::size_t finding, DiagnosedEffect& told);

}  // namespace abbe::diagnose
