// The effects that act in a run: the settings of the machine file resolved against the registry, their parameters drawn for every
// virtual machine, and their displacements added to touches.
//
// Cost: the scene of a touch is the same for all machines on one path, so an effect that is linear in its uncertain parameters is
// evaluated once per parameter and touch, not once per machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/effects/effect.hpp"
#include "engine/machine/machine.hpp"
#include "engine/run/effect_use.hpp"
#include "engine/run/touch.hpp"

namespace abbe {

class EffectSet {
 public:
  EffectSet() = default;
  /// Throws UserError: unknown effect or parameter (with the nearest known name), value outside its plausible range. `machine` names
  /// the machine in messages.
  EffectSet(const std::vector<EffectSetting>&, EffectUse, const std::string& machine);

  bool empty() const { return active_.empty(); }
  int size() const { return static_cast<int>(active_.size()); }
  const Effect& effect(int k) const { return *active_[k].effect; }

  /// Parameters of every lane of a block: by effect, then [parameter][lane].
  struct LaneParameters {
    std::vector<std::vector<double>> theta;
    std::vector<std::vector<double>> machine_draws;  ///< by effect, [draw][lane], for DrawsPer::machine
    int lanes = 0;
  };
  LaneParameters draw(std::uint64_t seed, const std::vector<std::uint32_t>& machines) const;

  /// Where and for whom one touch happens: the slots [first, last) of the batch share the scene.
  struct Group {
    const TouchScene* scene = nullptr;
    std::vector<int> slots;                  ///< of the batch, machines only
    std::vector<std::uint32_t> indexings;    ///< by slot of the group: which indexing event the head is in
  };
  /// Adds effect `k` (every effect when k < 0) to the errors of a group. `site`: the ordinal of the touch.
  void add(int k, const Group&, const LaneParameters&, std::uint64_t seed, std::uint32_t site, TouchBatch&) const;

 private:
  struct Active {
    const Effect* effect = nullptr;
    std::uint32_t stream = 0;
    std::vector<double> value, u;
    bool linear = false;     ///< no draws of its own, and only linear parameters are uncertain
  };
  void add_linear(const Active&, const Group&, const std::vector<double>& theta, int lanes, TouchBatch&) const;
  void add_sampled(int k, const Group&, const LaneParameters&, std::uint64_t seed, std::uint32_t site, TouchBatch&) const;

  std::vector<Active> active_;
  EffectUse use_ = EffectUse::left_in;
};

}  // namespace abbe
