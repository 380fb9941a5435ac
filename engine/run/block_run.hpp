// The handlers of the plan's operations: one overload per action, each working on the active lanes of a block.
#pragma once

#include <functional>
#include <optional>

#include "engine/plan/expression.hpp"
#include "engine/run/executor.hpp"

namespace abbe {

/// One run of one block. The handlers see the lanes that stand at the same operation, in `active`, ascending:
/// virtual machines first, then twins.
class BlockRun {
 public:
  BlockRun(const Executor& run_by, Block& lanes, Executor::Observed* observer = nullptr)
      : executor(run_by), block(lanes), observed(observer) {}

  /// Runs every lane to the end of the program or to its trap.
  void run();

  void operator()(const plan::DefineFeature&);
  void operator()(const plan::SelectSensor&);
  void operator()(const plan::SetCompensation&);
  void operator()(const plan::SetTemperatureCompensation&);
  void operator()(const plan::SetMotion&);
  void operator()(const plan::Move&);
  void operator()(const plan::SetHome&);
  void operator()(const plan::GoHome&);
  void operator()(const plan::BeginMeasure&);
  void operator()(const plan::Touch&);
  void operator()(const plan::EndMeasure&);
  void operator()(const plan::Construct&);
  void operator()(const plan::TakeNominal&);
  void operator()(const plan::SetMachineFrame&);
  void operator()(const plan::SetMatrixFrame&);
  void operator()(const plan::SetDatumFrame&);
  void operator()(const plan::TranslateFrame&);
  void operator()(const plan::RotateFrame&);
  void operator()(const plan::RecallFrame&);
  void operator()(const plan::Evaluate&);
  void operator()(const plan::Output&);
  void operator()(const plan::OutputFrame&);
  void operator()(const plan::Obtain&);
  void operator()(const plan::ObtainDisplacement&);
  void operator()(const plan::ObtainEvaluation&);
  void operator()(const plan::Assign&);
  void operator()(const plan::Jump&);
  void operator()(const plan::JumpUnless&);

 private:
  using Outcomes = std::vector<char>;

  void gather_lowest();
  void trap(int lane, std::string reason);
  Lane& twin_of(const Lane& lane) { return block.lanes[lane.twin]; }
  Lane& nominal_lane_of(const Lane& lane) { return block.lanes[twin_of(lane).nominal]; }
  double value(const Lane&, const plan::Operand&) const;
  Vec3 value(const Lane&, const plan::Point&) const;
  Outcome<double> evaluate(const Lane&, const plan::Expression&) const;
  /// The arguments with what stands in columns filled in.
  Arguments filled(const Lane&, const Arguments&, const std::vector<plan::VaryingNumber>&) const;
  /// What the lane knows of a feature that the operation names. Writing another feature's state does not move it.
  FeatureState& state(Lane&, plan::FeatureId);
  /// As FEAT defined it, in the lane's D; where the lanes share the nominal, as it lies in the D of the nominal part.
  Element nominal_of(Lane&, plan::FeatureId);
  /// As FEAT defined it in what was the lane's D then; W.
  Element programmed(Lane&, plan::FeatureId);
  /// How often the lane has executed this operation before; counts it.
  int visit(Lane&);
  /// The measured or constructed element, or nullptr after trapping the lane.
  const Element* actual(int lane, plan::FeatureId);
  void set_frame(Lane&, plan::FrameId, const Rigid& X_WD);
  /// Runs `f(lane index)` for every active lane and traps those for which it returns a reason.
  void for_active(const std::function<std::string(int)>& f);

  const Executor& executor;
  Block& block;
  Executor::Observed* observed;
  std::vector<int> active;
  int operation = 0;
  TouchBatch touch_batch;
  std::vector<Mat3> R_WR;             // by slot of touch_batch
  std::vector<PlaceOnPart> places;    // by slot of touch_batch, when a workpiece is given
  std::vector<Target> targets;        // by slot of touch_batch: where the program put the surface, W
  std::vector<double> points_buffer;  // columns handed to the fits

  /// Where a lane takes the surface of a touch to be, and where its twin has it; W.
  struct Aim {
    Target own, meant;
  };
  Outcome<Aim> aim(Lane&, Lane& twin, const plan::Touch&);
  /// The tip of the lane's machine goes to a point in W; `lane` is a twin.
  void go_to(int lane, const Vec3& point);
  /// Enters the touch of a lane into the batch; false after trapping it.
  bool prepare_touch(int slot, int lane, const plan::Touch&);
  void add_errors(int machines);
  void move_twins(int machines);
  TouchScene scene_of(const plan::Touch&, int slot) const;
  void add_effects(const plan::Touch&, int machines);
  void set_temperatures(const Temperatures& estimate, EffectSet::Group&) const;
  void put_on_part(const plan::Touch&, Lane& twin, int slot);
  void add_part(int machines);
  void observe_touch(const plan::Touch&, int slot);
  void observe_measurement(plan::FeatureId);
  RecordingRow recording_row(const plan::Touch&, int slot) const;
  /// Where a touch of a pattern lies as this lane sees it: in the system in which it defined the feature; W.
  Outcome<Target> pattern_target(Lane&, const plan::Touch&);
  void keep_touches(plan::FeatureId);
  std::vector<TouchedPoint> touches_of(Lane&, plan::FeatureId);
  /// Touches of the faces that a median plane lies between, in the lane's D; none of other features.
  std::vector<Vec3> faces_of(Lane&, plan::FeatureId);
  /// The limits as the actual sizes on this lane widen them; nothing after trapping it.
  std::optional<ToleranceLimits> widened(int lane, const plan::CharacteristicDef&, ToleranceLimits);
  void fit_twins(plan::FeatureId, FitCriterion);
  void fit_machines(plan::FeatureId, FitCriterion, std::size_t points);
  /// Gives every group of machines that leaves its twin's path at a condition a twin of its own; `condition`
  /// by lane grows.
  void part_twins(Outcomes& condition);
  /// Another lane like that twin, and its nominal lane behind it. Returns the twin's.
  int clone_twin(int twin);
};

}  // namespace abbe
