// One kind of tolerance (ISO 22093: TOL/...). A kind is one .cpp file in this folder and one line in all.cpp.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/arguments.hpp"
#include "engine/features/element.hpp"

namespace abbe {

enum class Unit { mm, rad };

/// One touch of a measured feature, and where the program meant it to be.
struct TouchedPoint {
  Vec3 actual;   ///< as this machine measured it, in its own D
  Vec3 nominal;  ///< where the program put the surface, in the nominal D
  Vec3 normal;   ///< out of the material there, in the nominal D
};

/// What one evaluation on one lane sees. D is the coordinate system current at the OUTPUT or EVAL statement;
/// the nominal D is the one that an error-free machine has there on the nominal part, whatever the true part
/// is like.
struct EvaluationInput {
  std::span<const Shape> shapes;    ///< of the features, in the order in which OUTPUT names them, then of the reference
  std::span<const Element> actual;  ///< as this machine measured them, in its own D
  std::span<const Element> nominal;     ///< as FEAT defined them, in the nominal D
  std::span<const Shape> datum_shapes;  ///< of the datums, in the order in which the tolerance names them
  std::span<const Element> datums;      ///< as this machine measured them, in its own D
  /// as an error-free machine measures them on the nominal part, in the nominal D
  std::span<const Element> nominal_datums;
  /// of the first feature, for kinds that ask for them; none of a constructed feature
  std::span<const TouchedPoint> touches = {};
  std::span<const TouchedPoint> second_touches = {};  ///< of the second feature, or of the reference
  /// touches of the faces that the first feature, a median plane, lies between, in its own D
  std::span<const Vec3> faces = {};
};

struct ToleranceLimits {
  std::optional<double> lower, upper;  ///< of the value that evaluate() returns, same unit
};

struct ToleranceKind {
  std::string_view word;  ///< DMIS minor word: "CYLCTY"
  /// arguments after the word; datum operands under the name `datum`, what DISTWRT and ANGLWRT refer to under `reference`
  std::string_view signature;
  std::string_view help;
  std::string_view example;  ///< a complete TOL statement
  std::string_view source;   ///< standard and clause
  Unit unit;                 ///< of the value; unit_of() knows the exceptions
  int features;              ///< how many features OUTPUT must name before it: 1 or 2
  /// nullptr when these shapes, of the features and then of the reference, can carry the tolerance, else why not.
  const char* (*applies)(const Arguments&, std::span<const Shape>);
  /// The nominal value (0 for form, position, orientation zones; the nominal diameter for DIAM; ...).
  double (*nominal)(const Arguments&, std::span<const Shape>, std::span<const Element> nominal_features);
  ToleranceLimits (*limits)(const Arguments&, std::span<const Element> nominal_features);
  Outcome<double> (*evaluate)(const Arguments&, const EvaluationInput&);
  Unit (*unit_for)(const Arguments&) = nullptr;  ///< where the arguments decide: CORTOL of a coordinate or of an angle
  bool (*wants_touches)(const Arguments&) = nullptr;  ///< whether evaluate() looks at touches; nullptr: never
  /// of a tolerance of size: the size across the feature is the value times this; 0 for others
  double size_factor = 0;
};

inline Unit unit_of(const ToleranceKind& kind, const Arguments& arguments) {
  return kind.unit_for ? kind.unit_for(arguments) : kind.unit;
}

inline bool needs_touches(const ToleranceKind& kind, const Arguments& arguments) {
  return kind.wants_touches && kind.wants_touches(arguments);
}

std::span<const ToleranceKind* const> tolerance_kinds();
const ToleranceKind* find_tolerance_kind(std::string_view word);

}  // namespace abbe
