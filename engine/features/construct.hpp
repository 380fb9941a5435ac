// Features constructed from features (ISO 22093: CONST/...). A method is one file in
// engine/features/constructions and one line in its all.cpp.
#pragma once

#include <span>
#include <string_view>

#include "engine/base/arguments.hpp"
#include "engine/features/element.hpp"

namespace abbe {

struct Construction {
  std::string_view word;       ///< DMIS method word: "INTOF"
  std::string_view signature;  ///< arguments after the word; feature operands under the name `from`
  std::string_view help;
  std::string_view example;
  std::string_view source;
  /// nullptr when an element of shape `result` can be made of features of these shapes, else why not. Shapes
  /// as FeatureKind::acts_as has them.
  const char* (*applies)(Shape result, std::span<const Shape> shapes);
  /// Builds an element of shape `result` from the operands, all in the coordinate system current at the
  /// statement (MOVEPT moves along its axes); `nominal` settles what geometry leaves open (the sense of a
  /// direction). Fails with a reason (parallel planes). Precondition: applies().
  Outcome<Element> (*construct)(Shape result, std::span<const Shape> shapes, std::span<const Element> from,
                                const Element& nominal, const Arguments&);
  /// A line or the axis of a cylinder stands for a point: that nearest to the nominal point of its feature. Its
  /// element comes with that as `point`.
  bool axes_are_points = false;
  /// The result lies midway between two faces and reaches as far as their touches do.
  bool lies_between = false;
};

std::span<const Construction* const> constructions();
const Construction* find_construction(std::string_view word);

}  // namespace abbe
