// What a recording logged of the covariates that effects depend on.
#pragma once

#include <string>
#include <vector>

#include "engine/recording/recording.hpp"
#include "engine/run/recorded/styli.hpp"
#include "engine/run/sensor.hpp"

namespace abbe {

struct Logged {
  unsigned known = 0;    ///< Covariates that every row gives
  unsigned varying = 0;  ///< of these, those that are not the same throughout
};

/// `sensors`: by row, as `styli` gave them.
Logged logged_covariates(const Recording&, const std::vector<const Sensor*>& sensors, const RecordedStyli& styli);

/// The columns of a recording that hold these covariates, for messages: {"temp_part_C"}.
std::vector<std::string> columns_of(unsigned covariates);

}  // namespace abbe
