// The effects that act in a run: the settings of the machine file resolved against the registry, their
// parameters drawn for every virtual machine, and their displacements added to touches.
//
// Cost: the scene of a touch is the same for all machines on one path. So an effect that is linear in what
// differs between machines (its uncertain parameters, its draws) is evaluated once per touch for each of
// these, not once per machine:
//   d = D(certain) + sum over the uncertain parameters p of theta_p D(unit p),   D(.) = sum over the draws j of z_j D(., unit j)
// leaves a sum of vectors with weights by machine (lanes/weighted_sum.hpp). Other effects are sampled machine
// by machine, and so are those for which not even the scene is the same for all: those that need the
// temperature of part or scales where every machine has its own, and those that need the raw reading, which
// is where the axes of each machine stand after all other errors. What is corrected is what the best
// estimates of parameters and temperatures together give.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/effects/effect.hpp"
#include "engine/machine/machine.hpp"
#include "engine/run/effect_activity.hpp"
#include "engine/run/effect_use.hpp"
#include "engine/run/recorded/touch.hpp"
#include "engine/run/touch.hpp"

namespace abbe {

class EffectSet {
 public:
  EffectSet() = default;
  /// Throws UserError for a setting that cannot be, as resolve does.
  EffectSet(const std::vector<EffectSetting>&, EffectUse, const std::string& machine);

  bool empty() const { return active_.empty(); }
  int size() const { return static_cast<int>(active_.size()); }
  const Effect& effect(int k) const { return *active_[k].effect; }
  /// Does any effect depend on the temperature of part or scales?
  bool sees_temperatures() const;

  /// What differs between the lanes of a block: parameters by effect, then [parameter][lane], and what
  /// follows from them.
  struct LaneParameters {
    std::vector<std::vector<double>> theta;
    std::vector<std::vector<double>> machine_draws;  ///< by effect, [draw][lane], for DrawsPer::machine
    /// By effect; of linear ones [component][lane], for DrawsPer::machine [component][draw][lane].
    std::vector<std::vector<double>> weights;
    int lanes = 0;
  };
  LaneParameters draw(std::uint64_t seed, const std::vector<std::uint32_t>& machines) const;

  /// Where and for whom one touch happens: the slots of the batch that share a scene.
  struct Group {
    const TouchScene* scene = nullptr;
    std::uint64_t seed = 0;                  ///< of what is drawn for this touch
    std::uint32_t site = 0;                  ///< the ordinal of the touch, which addresses it
    std::vector<int> slots;                  ///< of the batch, machines only
    std::vector<std::uint32_t> indexings;    ///< by slot of the group: which indexing event the head is in
    std::vector<Temperatures> temperatures;  ///< by slot of the group; empty: all have those of the scene
  };
  EffectActivities none_active() const { return EffectActivities(active_.size()); }
  /// Adds the effects, or one alone, to the errors of a group, which hold all errors but those of the effects, and
  /// notes what they did.
  void add(std::optional<int> only, const Group&, const LaneParameters&, TouchBatch&, EffectActivities&) const;

  /// For recordings: what the set does to a touch at its best estimates, mm in W; and one standard deviation
  /// of each of its unknowns.
  Vec3 estimate(const RecordedTouch&) const;
  struct Uncertainty {
    int effect = 0;
    int parameter = -1, draw = -1;     ///< an uncertain parameter, or a number drawn at random
    DrawsPer per = DrawsPer::machine;  ///< how often it is drawn anew
  };
  std::vector<Uncertainty> uncertainties() const;
  Vec3 one_sd(const Uncertainty&, const RecordedTouch&) const;

 private:
  /// One term of a linear effect: its displacement at these parameters times a weight by machine.
  struct Component {
    std::vector<double> theta;
    int parameter = -1;  ///< uncertain, 1 in theta, its value is the weight; -1: the certain ones together, weight 1
  };
  struct Active {
    const Effect* effect = nullptr;
    std::uint32_t stream = 0;
    std::vector<double> value, u;
    bool linear = false;                ///< in all that differs between machines
    bool corrected = false;             ///< the estimate is taken out
    std::vector<Component> components;  ///< of a linear effect; none when nothing remains of it
  };
  struct Sum;  ///< of the effects on one group
  static bool is_linear(const Active&);
  static bool sees_temperatures(const Active&);
  void add_alike(const std::vector<int>& which, const Group&, const LaneParameters&, TouchBatch&,
                 EffectActivities&) const;
  static std::vector<Component> components_of(const Active&);
  static std::vector<double> weights(const Active&, const std::vector<double>& theta,
                                     const std::vector<double>& machine_draws, int lanes);
  static void add_linear(const Active&, const std::vector<double>& weights, const std::vector<double>& draws, Sum&,
                         bool& moved);
  static void add_sampled(const Active&, const std::vector<double>& theta, const std::vector<double>& draws,
                          const TouchBatch&, Sum&, bool& moved);

  std::vector<Active> active_;
};

}  // namespace abbe
