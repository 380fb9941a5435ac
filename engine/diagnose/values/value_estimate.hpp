// Effects on recorded values beside the errors that every machine has. A form or a distance in space is no sum of what
// the effect and the machine's errors make of it alone: so the programs run with both.
#pragma once

#include <map>

#include "engine/diagnose/findings/finding.hpp"
#include "engine/diagnose/values/value_case.hpp"

namespace abbe::diagnose {

/// Mean and covariance of the sizes of the columns of a variant, in units of the columns.
struct Sizes {
  Vector mean;
  Matrix covariance;
  bool adds = false;  ///< what the effect does to values is the same on every machine
};

/// Under a prior so wide that it does not pull.
Sizes sizes_of(const ValueSearch&, int variant, const Vector& deviation);

/// Makes the likeliest variants of the catalogue linear near the sizes that fit best (Gauss-Newton steps weighted by the
/// covariance, with the mean of simulated machines as the model), so that their evidence is that beside errors. Means are
/// taken as differences on the same machines, of which few tell them; a covariance takes many, and is asked for once, or not
/// at all where what the effect adds is the same on all machines.
/// Returns the sizes by variant, with the spread of the simulated machines under the effect as the uncertainty; a variant
/// that hardly any machine reaches all values with is left as it was.
std::map<int, Sizes> linearise_likeliest(ValueSearch&, const ValueCase&);

/// The search of a case once more, beside the errors that a machine has.
struct Closer {
  ValueSearch search;
  std::map<int, Sizes> sizes;  ///< by variant, of the likeliest

  explicit Closer(const ValueCase& c) : search(*c.search), sizes(linearise_likeliest(search, c)) {}
  const Variant& variant(const Finding& f) const { return search.explanations().variants[f.variant]; }
  const Explanation& explanation(const Finding& f) const { return search.explanations().list[f.explanation]; }
};

/// By how much the size of column `k` is moved, in units of the column, to see what it changes: to where it may be.
double move_within_range(const Effect&, const Variant&, const Vector& sizes, Eigen::Index k);

/// The machine with an effect of these sizes, in units of the columns of the variant, or the nearest possible ones.
Machine with_effect(const Machine&, const Effect&, const Variant&, const Vector& sizes);

}  // namespace abbe::diagnose
