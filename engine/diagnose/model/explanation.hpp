// What may explain a mismatch: every effect of the registry, and OTHER, a flexible pattern in each factor for
// physics that the catalogue does not have. An explanation is a list of variants (which axis,
// which period, which moment); a variant is a set of columns, um per prior standard deviation, whose
// coefficients are drawn together.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/diagnose/diagnosis.hpp"
#include "engine/diagnose/model/linear.hpp"
#include "engine/effects/effect.hpp"

namespace abbe::diagnose {

/// In what a mismatch lies: `location` of docs/results.md, "Diagnoses".
enum class Factor { time, position, direction, head, sensor, setup, feature, run, temperature, speed };
std::string_view name(Factor);

/// One column of a variant before its columns are joined: which linear parameter (or draw) it belongs to.
struct Column {
  int parameter = -1;    ///< index into the effect's parameters; -1: a coefficient without a name (OTHER, draws)
  int part = 0;          ///< along which direction (0, 1, 2) or phase (0, 1) it is taken; both: direction + 3 phase
  double unit = 1;       ///< parameter value of one prior standard deviation
  bool assumed = false;  ///< does anything only by a value of the scene that nobody logged
};

/// The values of a parameter that one value stands for.
struct Cell {
  double low = 0, high = 0;
};

/// Whether two cells overlap or touch.
bool adjoin(const Cell&, const Cell&);

/// How large the coefficients of a variant are, in standard deviations of their prior, and how much that is
/// believed before the data.
struct Size {
  double factor = 1;
  double log_prior = 0;
};
/// What shows less than the noise even at so many times what is typical of an effect is the last digits of readings, which
/// hold the touch's own error: it tells nothing of the effect.
inline constexpr double kWidest = 30;

struct Variant {
  int explanation = 0;
  std::vector<double> theta;  ///< the effect's parameters; those of `columns` are placeholders
  /// by parameter: what its value stands for; nothing (low = high) where no value between the tried ones is
  /// possible
  std::vector<Cell> cells;
  std::string_view group;  ///< of the effect's parameters, which acts without the others; "": all act
  int axis = -1;           ///< of an effect that has a direction: along which axis it acts; -1: any, which three span
  RunChange change;        ///< what changed between runs
  Cell runs;  ///< of a change: the stretch of later runs that its first one stands for, as places in their order
  double weight = 1;    ///< belief before the data in this variant, among those of its explanation
  bool finest = false;  ///< no touch tells the values within its cells apart
  std::vector<Column> columns;
  Matrix signature;  ///< rows x columns, um per prior standard deviation
  /// at which it is judged; none: where the recording that judges it has signal-to-noise ratios that can tell
  /// anything
  std::vector<Size> sizes;
  bool joined = false;  ///< columns are combinations of the original ones: no parameter can be read from them
  std::string told;  ///< of a pattern: what sets this variant apart from the others of its shape; "": nothing to tell
};

/// Whether two variants of one effect are one fault: they differ at most in values that have others between them. A size
/// in all runs and a change from one run to the next are two, and so are those of two styli or two axes.
bool alike(const Variant&, const Variant&);

/// Whether it is an effect that is there in one placement of the part alone.
bool in_one_placement(const Effect&, const Variant&);

inline constexpr double kSameColumns_um = 1e-9;
/// Whether both have the same columns, so that no touch tells one from the other: none differs by this much anywhere, um.
bool same_columns(const Matrix&, const Matrix&, double less_than_um = kSameColumns_um);

/// Finds the same columns among many without comparing all of them: where columns are the same, so is a sum over them.
class ColumnsSeen {
 public:
  void add(const Matrix& columns, int number);
  /// The least number of those with the same columns, of which `variants` has the columns by number; -1: none.
  int find(const Matrix& columns, const std::vector<Variant>& variants) const;

 private:
  std::multimap<double, int> number_by_sum_;
};

struct Explanation {
  std::string name;                ///< of the effect, or "OTHER time"
  const Effect* effect = nullptr;  ///< none: OTHER
  Factor factor = Factor::position;
  std::string shape;     ///< of OTHER: "smooth", "quick", ...
  double share = 1;      ///< of the belief in all effects, or in all patterns: so many times that of most
  double prior = 0;      ///< probability among all explanations
  unsigned missing = 0;  ///< covariates that are absent or constant: it cannot be judged
  std::vector<int> variants;
};

struct Explanations {
  std::vector<Explanation> list;
  std::vector<Variant> variants;
  struct Unjudged {
    const Effect* effect;
    unsigned missing;
    unsigned constant;     ///< of the missing, those that were logged and are the same throughout
    unsigned too_few = 0;  ///< and those that differ, but hold too few visits
  };
  std::vector<Unjudged> unjudged;  ///< effects that this recording cannot judge
};

/// The shares of belief before the data: that a mismatch is in the catalogue, and that it is not.
inline constexpr double kPriorCatalogue = 0.8, kPriorOther = 0.2;
/// Belief before the data that what is found is new in a later run, of what may be in all.
inline constexpr double kPriorChange = 0.1;
/// The same of what belongs to the part: its form.
inline constexpr double kPriorChangeOfLasting = 0.005;

/// Belief in each variant of an explanation: the same for each group of parameters, and within a group for each
/// variant, but for those that change between runs, which hold a tenth together. Of a direction, half is for any, and half
/// for the axes: what carriages, scales and clamps do lies along one more often than chance would have it. What is gone counts half of what is
/// new: where only differences between runs are seen, the two are the same.
void share_belief(const Explanation&, std::vector<Variant>&);

/// The explanations of one kind only; `kept` by index into the list.
Explanations only(const Explanations&, const std::vector<int>& kept);
/// Rows of every signature.
Explanations rows_of(const Explanations&, const std::vector<Eigen::Index>& rows);

/// The same space with as few orthogonal columns as its rank needs.
Matrix compressed(const Matrix&);

}  // namespace abbe::diagnose
