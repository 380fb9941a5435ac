// The true part in a run: a workpiece resolved against the features of a plan.
//
// Two layers. What is known of the part (best estimates of sizes, forms of known phase) moves the
// true surface itself, so the error-free machine sees it and the reference is the true value. What
// is not known, and what temperature does, reaches virtual machines only, as errors d with measured
// = true + d (engine/workpiece/workpiece.hpp).
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "engine/plan/plan.hpp"
#include "engine/workpiece/workpiece.hpp"

namespace abbe {

/// Where a touch lies on the part, for one error-free machine. W.
struct PlaceOnPart {
  plan::FeatureId feature;
  Vec3 point, normal;   ///< of the nominal surface
  Element nominal;      ///< of the feature
  Vec3 x_axis, y_axis;  ///< of the coordinate system in force
};

/// Which random numbers the random form of a part has where an error-free machine touched it: those of the touch that was
/// there first. Whatever touches within 1 um of it finds the same surface, in whichever measurement or turn of a loop.
class TouchedSpots {
 public:
  struct Numbers {
    std::uint32_t site = 0;   ///< ordinal of a touch in the plan
    std::uint32_t visit = 0;  ///< which of the spots that this touch was the first at
  };
  Numbers at(const Vec3& point, const Vec3& normal, std::uint32_t site);

 private:
  struct Spot {
    Vec3 point, normal;
    Numbers numbers;
  };
  using Cell = std::array<long, 3>;  ///< a millimetre each way, so that only spots nearby are looked at
  static Cell cell_of(const Vec3&);

  std::vector<Spot> spots_;
  std::map<Cell, std::vector<std::size_t>> cells_;  ///< indices of spots
  std::map<std::uint32_t, std::uint32_t> visits_;   ///< by touch of the plan: the spots that it was the first at
};

class Part {
 public:
  /// The part of the nominal geometry, at 20 degrees C, exactly known.
  Part() = default;
  /// Throws UserError: a surface that the plan never touches (E0423), a size or form that its kind
  /// cannot have (E0424).
  Part(const Workpiece&, const plan::Plan&);

  bool given() const { return workpiece_ != nullptr; }
  const Workpiece& workpiece() const { return *workpiece_; }

  /// How far the true surface lies beyond the nominal one, along its outward normal, as far as it
  /// is known. mm.
  double known_offset_mm(const PlaceOnPart&) const;

  /// Everything that one virtual machine has of the part.
  struct Draw {
    DrawFor who;
    ThermalDraw thermal;
    struct Surface {
      double deviation_mm = 0;  ///< of what the file gives, offset or diameter, beyond the best estimate
      double random_sd_mm = 0;
      struct Harmonic {
        int undulations = 0;
        double cos_mm = 0, sin_mm = 0;
      };
      std::vector<Harmonic> form;  ///< beyond what is known
    };
    std::vector<Surface> surfaces;  ///< in the order of the workpiece
  };
  Draw draw(DrawFor) const;

  bool has_random_form(plan::FeatureId) const;
  /// d of a touch on a virtual machine, mm in W. `from_fixed`: the true surface point seen from the
  /// first one touched.
  Vec3 error(const Draw&, const PlaceOnPart&, const Vec3& from_fixed, const Temperatures& estimate, bool compensated,
             TouchedSpots::Numbers random_form) const;

 private:
  /// What the file says of the surface of one feature. A label that is defined again is another feature on the same one.
  struct OnSurface {
    int index = -1;            ///< in the order of the workpiece; -1: nothing
    double per_deviation = 1;  ///< offset for what the file gives: half of a diameter, minus half of a bore's
  };
  /// Best estimate along the outward normal. The nominal radius is that of the touch: a FEAT may take it from a variable.
  double offset_mm(const OnSurface&, double nominal_radius_mm) const;
  /// Adds what is wrong with it, if anything.
  OnSurface resolve(int index, const plan::FeatureDef&, std::vector<Diagnostic>&) const;

  const Workpiece* workpiece_ = nullptr;
  std::vector<OnSurface> on_surface_;  ///< by feature
};

}  // namespace abbe
