// One kind of feature (ISO 22093: FEAT/...): all that the program knows of it but the mathematics of constructions and
// tolerances. A kind is one .cpp file in this folder, its Shape in element.hpp and one line in all.cpp.
#pragma once

#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/base/arguments.hpp"
#include "engine/features/element.hpp"

namespace abbe {

enum class FitCriterion;
struct Cloud;
struct FitProblem;
struct FitSolution;

/// Points of many lanes (virtual machines), structure of arrays: coordinate k (0..2) of touch i on lane l stands at
/// data[(3 * i + k) * stride + l]. mm, frame W.
struct PointColumns {
  const double* data = nullptr;
  int points = 0;
  int lanes = 0;
  int stride = 0;
  Vec3 at(int touch, int lane) const {
    const double* p = data + static_cast<std::size_t>(3 * touch) * stride + lane;
    return {p[0], p[stride], p[2 * static_cast<std::size_t>(stride)]};
  }
};

/// Arguments of a FEAT statement in their order: words, numbers, and places and directions as three numbers.
using FeatArguments = std::vector<std::variant<std::string_view, double, Vec3>>;

/// A touch on a nominal surface, in the frame of the nominal, mm.
struct PatternTouch {
  Vec3 point, normal;  ///< of the surface; a unit vector, out of the material
};

/// Where a machine touches features of a kind when the program gives no points (pattern.hpp).
struct Pattern {
  std::string_view help;  ///< one line for people: where the touches lie
  /// Touch `index` (from 0) of `count`; its normal is that of an outer feature. Fails with a reason where the nominal
  /// does not say enough. nullptr: the nominal never says where its surface begins and ends.
  Outcome<PatternTouch> (*touch)(const Element& nominal, bool inner, int index, int count) = nullptr;
  int minimum = 0;  ///< fewest touches that determine the feature, where they are more than the fit needs
};

/// What `abbe fit` calls the element and the values of its fit (docs/recording.md); empty: not reported.
struct FitNames {
  std::string_view element{}, point{}, direction{}, size{}, minor_size{};
  std::string_view half_angle{}, apex{};  ///< of a cone
};

/// Members without a default have to be given.
struct FeatureKind {
  Shape shape;
  /// The shape that it is treated as where only its point, direction and radius matter: in constructions, alignments
  /// and tolerances of location. Pairs of planes are their median plane there.
  Shape acts_as = shape;
  /// Made of faces. All others are curved, or points of a surface of which no more is known.
  bool flat = false;
  std::string_view word;       ///< DMIS minor word: "CYLNDR"
  std::string_view signature;  ///< arguments after the word, notation of base/arguments.hpp
  std::string_view help;       ///< one line for people
  std::string_view example;    ///< a complete FEAT statement
  std::string_view source;     ///< standard and clause, or the reference of the fit

  // The nominal.

  /// Builds the nominal element from matched arguments, in the frame current at the statement. Fails with a reason for
  /// impossible values (zero vector, negative diameter).
  Outcome<Element> (*nominal)(const Arguments&);
  /// The other way round: the arguments of the statement that defines an element, in its frame, mm and degrees. The
  /// side, with which the signatures of those that have one begin, is left out.
  FeatArguments (*written)(const Element&);
  /// The unit normal of the nominal surface where it is nearest to `point`, out of an outer feature; same frame, mm.
  /// Fails with a reason where the nominal leaves it open.
  Outcome<Vec3> (*normal)(const Element& nominal, const Vec3& point);
  Pattern pattern{};

  // The element that was measured.

  int minimum_points;  ///< touches that the least-squares fit needs
  /// Orthogonal least squares over lanes, Gauss-Newton from `start[lane]`, which must be within about 1 % of
  /// the size of the feature. Each lane's result depends on its own points only. `failure[lane]` is nullptr
  /// or the reason.
  void (*fit_lanes)(const PointColumns&, const Element* start, Element* result, const char** failure);
  /// Replaces the least-squares element of the points by that of another criterion (criterion.hpp), same frame, mm; may
  /// leave the sense of its direction, and `second`, to the caller. nullptr: there is only least squares.
  void (*refit)(FitCriterion, std::span<const Vec3> points, Element&) = nullptr;
  /// The least-squares element of points alone or, with a start, the minimum next to that; fit.hpp has found the points
  /// to be enough, and spread as follows. nullptr: they do not settle all of its values.
  FitSolution (*fit_points)(const FitProblem&, Cloud, const Element* start) = nullptr;
  /// Along how many of their principal directions the points must be spread for that: 0 of a point, 1 of a line, 2 of
  /// what lies in a plane, 3 of all others.
  int spread = 3;
  FitNames fit_names{};  ///< of an element that `abbe fit` offers
};

/// Every kind of feature, in the order of the language reference.
std::span<const FeatureKind* const> feature_kinds();
const FeatureKind& feature_kind(Shape);
/// nullptr when there is no such DMIS word. Upper case.
const FeatureKind* find_feature_kind(std::string_view word);

}  // namespace abbe
