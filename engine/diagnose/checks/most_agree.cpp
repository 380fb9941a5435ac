#include "engine/diagnose/checks/most_agree.hpp"

#include <algorithm>

#include "engine/diagnose/quantile.hpp"
#include "engine/math/rigid_fit.hpp"

namespace abbe::diagnose {

std::optional<Rigid> placement_of_most(std::vector<Vec3> here, std::vector<Vec3> there) {
  constexpr double kAstray = 5, kGross_mm = 1;
  for (;;) {
    const std::optional<Rigid> X = rigid_fit(here, there);
    if (!X) return std::nullopt;
    std::vector<double> off;
    for (std::size_t i = 0; i < here.size(); ++i) off.push_back(norm(*X * here[i] - there[i]));
    const double most = std::max(kGross_mm, kAstray * median(off));
    std::vector<Vec3> kept_here, kept_there;
    for (std::size_t i = 0; i < here.size(); ++i)
      if (off[i] <= most) kept_here.push_back(here[i]), kept_there.push_back(there[i]);
    if (kept_here.size() == here.size()) return X;
    here = std::move(kept_here), there = std::move(kept_there);
  }
}

}  // namespace abbe::diagnose
