// Running a plan on virtual machines: what goes in and what comes out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/lanes/random.hpp"
#include "engine/machine/screening.hpp"
#include "engine/plan/plan.hpp"
#include "engine/recording/recording.hpp"
#include "engine/run/effect_activity.hpp"
#include "engine/run/effect_use.hpp"
#include "engine/workpiece/workpiece.hpp"

namespace abbe {

/// Which touches have errors: those of features that coordinate systems are built from
/// (alignment_features.hpp), or the others.
enum class ErroneousTouches { all, alignment, feature };

/// Which sources of error act in a run. Switching one off changes no random number of the others.
struct Contributors {
  bool geometry = true, head = true, probe = true;
  std::optional<Component> only_component;  ///< of the geometry, that error function alone
  bool part = true;                         ///< what is uncertain of the workpiece, and its temperatures
  bool effects = true;
  std::optional<int> only_effect;  ///< of the effects, that one alone: index into the machine's list
  ErroneousTouches touches = ErroneousTouches::all;

  /// An error-free machine and a part as nominal.
  static Contributors none() {
    Contributors c;
    c.geometry = c.head = c.probe = c.part = c.effects = false;
    return c;
  }
};

struct RunOptions {
  std::uint64_t seed = 1;
  int threads = 1;
  int block_lanes = 128;  ///< results do not depend on it
  Contributors contributors;
  EffectUse effect_use = EffectUse::left_in;
  /// Which repeat of the measurement: the same machines and the same part, but other noise of probe, head and
  /// touch-wise effects.
  int repeat = 0;
  int setup = 1;  ///< placement of the part that a recording names; it has other noise, too
  /// Two odd steps of the whole range: every repeat in every setup has a seed of its own.
  std::uint64_t noise_seed() const {
    return seed_of(seed, static_cast<std::uint64_t>(repeat)) +
        0xBF58476D1CE4E5B9u * static_cast<std::uint64_t>(setup - 1);
  }
  Vec3 placement_mm;  ///< where the program's machine coordinate system lies in W (directive `place`)
  const Workpiece* workpiece = nullptr;  ///< the true part; none: exactly nominal, at 20 degrees C
  /// The second recipe of simulation: errors are added to the points of this recording, in the program's
  /// machine coordinates, instead of to nominal points. The reference is then what an error-free machine
  /// would make of the recorded points.
  const Recording* recorded = nullptr;
};

/// The values of one characteristic, at its `occurrence`-th evaluation, on every machine. Values are mm or rad.
///
/// A condition on a measured value may send the error-free machine past a characteristic that virtual
/// machines evaluate. It then has no reference; nominal and limits are those of the twin of the first machine
/// that evaluated it.
struct Samples {
  plan::CharacteristicId characteristic;
  int occurrence = 1;
  std::optional<double> reference;  ///< on the error-free machine; none where it takes another path
  double nominal = 0;
  ToleranceLimits limits;              ///< on the error-free machine
  std::vector<double> value;           ///< one per machine that reached it, in machine order
  std::vector<std::uint32_t> machine;  ///< position of that machine among those run: 0, 1, 2, ...
  /// one per value where every machine has limits of its own (material conditions, limits that are computed from
  /// what it measured), else none
  std::vector<ToleranceLimits> own_limits;
};

/// A virtual machine on which the program could not go on.
struct Trap {
  std::uint32_t machine = 0;  ///< position among those run
  int operation = 0;          ///< index into the plan
  int line = 0;
  std::string reason;
};

/// What one OUTPUT statement reports of one machine: elements in the coordinate system current there, mm, and
/// values, mm or rad.
struct OutputRecord {
  int operation = 0;  ///< index into the plan
  std::vector<Element> features;
  struct Evaluated {
    plan::CharacteristicId characteristic;
    double value = 0;
    ToleranceLimits limits;
  };
  std::vector<Evaluated> values;
  std::optional<Rigid> frame;  ///< of an OUTPUT of a coordinate system: its pose in the program's machine system
};

struct RunResult {
  /// In the order in which the error-free machine evaluated them, then those without a reference as the
  /// machines came to them.
  std::vector<Samples> samples;
  std::vector<Trap> traps;  ///< by machine
  int machines = 0;
  std::vector<OutputRecord> reference_outputs;  ///< of the error-free machine
  std::vector<Diagnostic> warnings;             ///< of what it does (program_warnings.hpp)
  std::uint64_t touches = 0;                    ///< executed on virtual machines
  EffectActivities activities;                  ///< on virtual machines
  double cycle_time_s = 0;                      ///< of the program on the error-free machine (motion.hpp)
};

/// Runs the plan on an error-free machine and on every machine of `machines`. The same result for any thread
/// count and block size. Throws UserError, with places in `source`, when the error-free machine cannot finish
/// (touch outside the travel, unknown sensor, degenerate fit): then no machine can.
RunResult run_plan(const plan::Plan&, const Machine&, const VirtualMachines& machines, const RunOptions&,
                   const SourceFile& source);

/// What another run of the same plan has of the evaluation that is entry `index` in `samples`; nullptr when
/// no machine made it there.
const Samples* counterpart(const std::vector<Samples>& samples, std::size_t index, const RunResult& other);

/// What the program had in force at a touch.
struct TouchAim {
  Rigid X_MD;            ///< its coordinate system, in its machine system
  double radius_mm = 0;  ///< of the tip
};

/// What one machine reports: at every touch, and at every OUTPUT statement.
struct MachineRecord {
  Recording recording;  ///< tip centres in the program's machine coordinates, targets, normals, motion, raw readings
  std::vector<TouchAim> aims;  ///< by row of the recording
  std::vector<OutputRecord> outputs;
  EffectActivities activities;
  std::vector<Diagnostic> warnings;  ///< RunResult::warnings
};

/// Runs the plan on the one machine of `one` and returns what it reports. Throws UserError as run_plan does,
/// and when that machine is trapped.
MachineRecord record_plan(const plan::Plan&, const Machine&, const VirtualMachines& one, const RunOptions&,
                          const SourceFile& source);

}  // namespace abbe
