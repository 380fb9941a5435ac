// Reading a result file (DMIS, ISO 22093), of this program or of a real machine: the actual features, the
// evaluated tolerances and the coordinate systems that it states.
//
// FA statements are matched against the signatures of FEAT, so a file is understood in the same units
// and forms as a program. Uncertainties stand in comments `$$! u TA(name) ...` (engine/report/dmis_result.hpp);
// files without them have none. Everything else in the file, the program's own statements included, is
// passed over.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/features/feature.hpp"
#include "engine/tolerances/tolerance.hpp"

namespace abbe::lang {

/// FA: mm, in the coordinate system that was current when it was put out.
struct ResultFeature {
  std::string label;
  const FeatureKind* kind = nullptr;
  Element actual;
  bool inner = false;
  int line = 0;
};

/// What a `$$! u` comment says: mm or degrees, as written.
struct ResultUncertainty {
  double u = 0, lcl = 0, ucl = 0;
  std::optional<double> conformance;
};

/// TA: one evaluated tolerance.
struct ResultValue {
  std::string label;
  const ToleranceKind* kind = nullptr;
  std::string qualifier;      ///< the axis of CORTOL, DISTB and DISTWRT, 2D or 3D of POS; else empty
  double value = 0;           ///< mm or rad
  double last_digit = 0;      ///< what the last digit of the value counts, mm or rad
  bool in_tolerance = false;  ///< INTOL
  std::optional<ResultUncertainty> uncertainty;
  int line = 0;
};

/// DA: a coordinate system.
struct ResultFrame {
  std::string label;
  Rigid X_MD;  ///< its pose in the machine coordinate system, mm
  int line = 0;
};

struct DmisResult {
  std::vector<ResultFeature> features;
  std::vector<ResultValue> values;
  std::vector<ResultFrame> frames;
};

/// Mistakes go to the sink; what can be read is read.
DmisResult read_dmis_result(const SourceFile&, Sink&);

}  // namespace abbe::lang
