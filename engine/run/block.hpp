// The state of a block of lanes while a plan runs on it.
//
// Lanes 0..machines-1 are virtual machines. The lanes after them are *twins*: error-free machines. Lane
// `machines` is the reference, the error-free machine that runs the program by itself. The true part lies
// where an error-free machine would find it (docs/architecture.md, "Running a plan"), so every virtual machine needs to know
// what an error-free machine that took the same path through the program would have seen: its twin. All
// machines start with the reference as their twin; where machines of one twin part at a condition on measured
// values, the twin is cloned and follows each group.
//
// A workpiece or a recording says that the true part is not the nominal one. Then every twin has a *nominal*
// lane beside it: an error-free machine that measures the nominal part on the twin's path. It says where the
// program meant features, datums and touches to be: coordinate systems built on measured features move with
// the true part, what is nominal does not.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/machine/geometry.hpp"
#include "engine/plan/plan.hpp"
#include "engine/run/effect_set.hpp"
#include "engine/run/motion.hpp"
#include "engine/run/part.hpp"
#include "engine/run/run.hpp"
#include "engine/run/sensor.hpp"

namespace abbe {

struct LaneTrap {
  int operation = 0;
  std::string reason;
};

/// One evaluation of a characteristic on one lane.
struct Value {
  plan::CharacteristicId characteristic;
  int visit = 0;  ///< how often this lane evaluated it before
  double value = 0;
  double nominal = 0;
  ToleranceLimits limits;
};

/// Where the program put the surface that a touch was for: true position and normal, in W.
struct Target {
  Vec3 point, normal;
};

/// What a lane knows of a feature. W.
struct FeatureState {
  plan::FeatureId feature;     ///< whose state this is
  plan::FeatureId definition;  ///< the FEAT statement in force
  bool has_actual = false;
  bool own_nominal = false;   ///< the nominal varies with the machines
  Element actual;             ///< valid where has_actual
  Element nominal;            ///< twins, and machines where it varies with them
  Rigid defined_in;           ///< X_WD at the definition
  std::vector<Vec3> touched;  ///< points of the last measurement, of features whose touches are evaluated
  std::vector<Vec3> faces;    ///< the same of the faces that a median plane was constructed between
  std::vector<Target> meant;  ///< the same for targets; nominal lanes only
};

struct Lane {
  int pc = 0;
  bool running = true;
  int twin = 0;     ///< lane of the error-free machine that shares this lane's path; a twin's own
  int nominal = 0;  ///< twins only: the nominal lane beside it; a nominal lane's own, and where the part is nominal
  std::uint32_t machine_index = 0;  ///< keys the random numbers; unused on twins
  Rigid X_WD;                       ///< current coordinate system
  plan::SensorId sensor;
  bool head_indexed = false;  ///< the head has been sent to an orientation
  double head_a_rad = 0, head_b_rad = 0;
  std::uint32_t indexings = 0;  ///< how often the head was indexed so far
  double head_error_a_rad = 0, head_error_b_rad = 0;
  bool compensation = true;
  bool temperature_compensation = false;
  std::uint64_t fuel_used = 0;
  std::vector<Vec3> points;     ///< of the measurement it is in: surface points, or tip centres without compensation; W
  std::vector<Target> targets;  ///< of the same measurement; twins only
  std::vector<FeatureState> features;        ///< by slot (engine/plan/lifetimes.hpp): those that are alive
  std::optional<Motion> motion;              ///< twins only: their machines move with them
  TouchMotion last_touch;                    ///< twins only
  std::optional<Vec3> home;                  ///< twins only: FROM, W
  std::optional<Vec3> fixed_point;           ///< twins only: the first point touched, from which the part expands; W
  TouchedSpots spots;                        ///< twins only: on surfaces with a random form
  TouchedSpots::Numbers random_form;         ///< twins only: of the touch it makes
  std::vector<std::optional<Rigid>> frames;  ///< X_WD by FrameId; nothing before it is set
  std::vector<double> columns;               ///< by ColumnId; NaN before the first assignment
  /// by plan::VisitCounters: how often this lane has executed that touch or evaluation
  std::vector<std::uint32_t> visits;
  std::vector<Value> values;
  LaneTrap trap;
};

struct Block {
  std::vector<Lane> lanes;
  int machines = 0;
  GeometryBlock geometry;
  EffectSet::LaneParameters effects;
  EffectActivities activities;
  std::vector<Part::Draw> parts;  ///< by machine
  std::uint64_t touches = 0;

  int reference() const { return machines; }
  bool is_twin(int lane) const { return lane >= machines; }  ///< nominal lanes are twins too: of the nominal part
  bool is_nominal(int lane) const { return is_twin(lane) && lanes[lane].nominal == lane; }
  bool part_is_nominal() const { return lanes[reference()].nominal == reference(); }
};

}  // namespace abbe
