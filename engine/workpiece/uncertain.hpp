// A quantity of a workpiece: a best estimate and what is not known of it.
//
// In a file every quantity is written in one of four ways (docs/workpiece.md):
//   838                                                  known exactly
//   {"value": 838, "u": 32, "dof": 16}                   normal; with "dof" Student's t
//   {"value": 0, "half_width": 1, "distribution": "rectangular"}
//   {"value": 838, "components": [{"u": 25, "dof": 18}, {"u": 6, "dof": 24}]}
// Components are independent and add; so a budget of GUM type can be written down as it stands.
//
// Random numbers: each component of each quantity has its own address, the hash of
// "workpiece.<name of the quantity>", its number and the virtual machine. Another quantity, or a
// component more, changes no other number.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/base/json_reader.hpp"
#include "engine/lanes/distribution.hpp"

namespace abbe {

struct Uncertain {
  double value = 0;
  std::vector<Deviation> components;

  bool exact() const { return components.empty(); }
  bool is_zero() const { return value == 0 && exact(); }
  /// Standard deviation of what is not known.
  double u() const;
};

/// The quantity in another unit, or with the other sign.
Uncertain operator*(double factor, const Uncertain&);

/// For whom a number is drawn.
struct DrawFor {
  std::uint64_t seed = 1;
  std::uint32_t machine = 0;
};

/// What machine `for_whom` has beyond the best estimate. `name`: "material.cte_ppm_per_K".
double deviation(const Uncertain&, std::string_view name, DrawFor for_whom);
/// The pair of uniform numbers of a quantity that is not an Uncertain, such as an unknown phase.
UniformPair uniform_pair_for(std::string_view name, DrawFor for_whom);

/// The quantity under `key`, in the unit of the key; `otherwise` when the file does not have it.
/// Reports contradictions (E0421) and values outside `range`, which holds for the best estimate.
Uncertain read_uncertain(JsonObject&, std::string_view key, double otherwise = 0,
                         const NumberRange& range = kAnyNumber);

}  // namespace abbe
