// Runs a plan on one block of lanes. Every lane has its own program counter; the lanes at the lowest one go
// first, together, so lanes that part at a condition meet again by themselves (re-convergence at thread
// frontiers, Diamos et al., MICRO 2011). Lanes never see each other, so any order of work gives the same
// result.
#pragma once

#include <map>
#include <set>
#include <vector>

#include "engine/lanes/random.hpp"
#include "engine/plan/lifetimes.hpp"
#include "engine/recording/recording.hpp"
#include "engine/run/block.hpp"
#include "engine/run/curved_features.hpp"
#include "engine/run/part_frame.hpp"
#include "engine/run/run.hpp"
#include "engine/run/touch.hpp"

namespace abbe {

/// What an operation counts, against one assignment. A touch and its share of the fit take some fifty times as long, but
/// loops of 100 000 touches have to run; with 8 they do, and a lane caught in a loop stops after about a second.
inline constexpr std::uint64_t kTouchCost = 8, kCostOfGeometry = 2;
std::uint64_t cost(const plan::Action&);

/// How much a lane may execute, besides every operation once, before it counts as caught in an endless loop.
inline constexpr std::uint64_t kFuel = 2'000'000;
static_assert(kFuel / kCostOfGeometry < kMostVisits, "visits of touches and evaluations have addresses of their own");

class Executor {
 public:
  Executor(const plan::Plan&, const Machine&, const RunOptions&, const SourceFile&);

  /// Memory of one lane that has run the plan; loops add what they evaluate more than once.
  std::size_t lane_bytes() const;
  /// A block of the given machines (and the reference), ready to run. `first`..: positions in `machines`.
  Block make_block(const VirtualMachines& machines, int first, int count) const;
  /// Runs every lane to the end of the program or to its trap.
  void run(Block&) const;

  /// What a machine did, for those who want more than results.
  struct Stop {
    Vec3 reading_mm;  ///< nominal scale readings
    int operation = 0;
    bool touch = false;  ///< else the target of a move
    Vec3 surface_mm;     ///< of a touch: its point in the coordinate system of the program there
  };
  /// The fit of an error-free machine at one EndMeasure operation.
  struct KnownFit {
    int operation = 0;
    std::vector<Vec3> points;
    Element element;
  };
  /// A feature that was measured, on the nominal part of the reference; W.
  struct Measured {
    int operation = 0;
    plan::FeatureId feature;
    Element nominal, actual;
    std::vector<Target> targets;  ///< where the program put its surface
    double radius_mm = 0;         ///< of the ball of the last touch
  };
  struct Observed {
    std::vector<KnownFit> fits;         ///< of the twins
    std::vector<OutputRecord> outputs;  ///< of lane 0, which is the reference when there are no machines
    std::vector<Stop> stops;            ///< of the reference: where the program asks the machine to go
    std::vector<Measured> measured;     ///< by the reference
    std::vector<Value> nominal_values;  ///< what the reference would evaluate of the nominal part
    FrameCount frames;                  ///< of the reference: in which it touches
    CurvedFeatures curved;              ///< by what the reference touches
    std::vector<RecordingRow> rows;     ///< of lane 0: what it reported; coordinates of the program's machine system
    std::vector<TouchAim> aims;         ///< by row
    std::set<double> approaches_mm, retracts_mm;  ///< of these touches: what SNSET said
    std::set<bool> compensations;                 ///< of these touches: whether temperatures were compensated
  };
  /// Makes the fits of the reference known, so that not every block has to make them again. Changes no result.
  void know(std::vector<KnownFit> fits);
  /// The coordinate system of the machine, as programs see it: X_WM.
  Rigid machine_frame() const { return {Mat3{}, options_.placement_mm}; }
  /// The part's own coordinates (part_frame.hpp), which the effects see: before any block with machines runs.
  void place_part(const Rigid& X_WP) { X_PW_ = inverse(X_WP); }
  /// Which features are curved, for the effects: before any block with machines runs. What the reference does not touch
  /// is so by its kind.
  void find_curved(const CurvedFeatures&);
  /// Runs a block as run() does and keeps what is observed.
  Observed observe(Block&) const;

 private:
  friend class BlockRun;
  /// The surface point moved along its normal to where the recording has it; nothing when it has no such
  /// touch. `touch`: 0, 1, ...
  std::optional<Vec3> recorded_surface(plan::FeatureId, std::size_t touch, const Vec3& surface, const Vec3& normal,
                                       double radius_mm) const;
  void find_recorded_points();
  const Element* known_fit(int operation, const std::vector<Vec3>& points) const;
  /// Whether touches of this feature have errors in this run.
  bool errors_act_on(plan::FeatureId) const;
  GeometryBlock acting_geometry(const VirtualMachines& machines, int first, int count) const;

  const plan::Plan& plan_;
  const Machine& machine_;
  const RunOptions& options_;
  std::multimap<int, KnownFit> known_fits_;  ///< by operation
  std::vector<Sensor> sensors_;              ///< by SensorId
  EffectSet effects_;
  Part part_;
  Rigid X_PW_;
  std::vector<char> curved_;                              ///< by FeatureId
  std::map<std::pair<int, std::size_t>, Vec3> recorded_;  ///< by feature and touch, W; of options_.recorded
  std::vector<char> aligns_;                              ///< alignment_features
  std::vector<char> keeps_touches_;  ///< by FeatureId: a tolerance is evaluated of the touches themselves
  plan::FeatureSlots slots_;
  plan::VisitCounters visits_;
  std::vector<std::uint64_t> cost_;  ///< by operation
  std::uint64_t fuel_ = kFuel;       ///< of a lane: what is straight is never too long
  std::vector<int> measured_;        ///< by FeatureId: its ordinal in the order of the first touches; -1: never touched
  std::vector<std::uint32_t> site_;  ///< by operation: ordinal of a touch among the touches of the plan
};

}  // namespace abbe
