// Raw readings as they would be without the noise of the touch. A reading holds its own touch's noise, and so
// does the residual: where targets lie on a grid, any short period of the scale would seem to explain the one
// by the other. What the recording plainly holds beside noise must stay in the reading, or the phase within a
// short period is lost: it is fitted first, as far as readings are not needed for it.
//
// Touches that aim at one place of a scale stop beside it by what is wrong with each. A steep period there would
// explain any mismatch of a face by the mismatch itself: they get the place that they have in common.
#include "engine/diagnose/baseline/own_noise.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "engine/diagnose/baseline/length_errors.hpp"
#include "engine/diagnose/model/prediction.hpp"
#include "engine/diagnose/model/restricted_likelihood.hpp"

namespace abbe::diagnose {

namespace {

/// Touches of one setup that aim at one reading of a scale get the mean of theirs, but for how the part was placed:
/// that is known without the single touch.
void share_places(Case& c) {
  constexpr double kPlacesPerMm = 1000;
  const Vector placed_mm = (c.model.y - without_placement(c.model)) / kUmPerMm;
  for (int axis = 0; axis < 3; ++axis) {
    struct Place {
      std::vector<std::size_t> rows;
      double beyond_mm = 0;
    };
    std::map<std::pair<int, long>, Place> places;
    const auto placed = [&](std::size_t k) { return placed_mm(static_cast<Eigen::Index>(k)); };
    const auto touch = [&](std::size_t k) -> RecordedTouch& { return c.touches.touches[c.rows[k]]; };
    for (std::size_t k = 0; k < c.rows.size(); ++k) {
      const RecordedTouch& t = touch(k);
      Place& place = places[{t.scene.setup, std::lround(kPlacesPerMm * t.scene.reading[axis])}];
      place.rows.push_back(k);
      place.beyond_mm += t.beyond_target_mm[axis] - placed(k) * t.scene.normal[axis];
    }
    for (const auto& [key, place] : places)
      for (const std::size_t k : place.rows)
        touch(k).beyond_target_mm[axis] =
            placed(k) * touch(k).scene.normal[axis] + place.beyond_mm / double(place.rows.size());
  }
}

}  // namespace

void free_readings_of_noise(Case& c, const EvidenceSearch& first) {
  constexpr int kMost = 3;
  constexpr double kPlain = 10;  // nats
  if ((c.touches.known & static_cast<unsigned>(Covariate::raw_reading)) == 0) return;
  LinearModel model = c.model;
  Hyperparameters hyper = c.hyper;
  Evidence evidence = first.evidence();
  for (int round = 1; evidence.statistic >= kPlain; ++round) {
    const auto& bayes = evidence.variant_log_bayes;
    const auto best = static_cast<std::size_t>(std::max_element(bayes.begin(), bayes.end()) - bayes.begin());
    model = with_free(model, {&c.explanations.variants[best].signature});
    hyper = estimate(model);
    if (round == kMost) break;
    evidence = EvidenceSearch(model, hyper, c.explanations).evidence();
  }
  // Its expectation given the recording, no more: what is taken out beyond it comes back with the other sign,
  // and where one place was touched again and again, nothing else would be left in the readings.
  const Vector noise_um = expected_noise(model, hyper);
  for (std::size_t k = 0; k < c.rows.size(); ++k) {
    RecordedTouch& t = c.touches.touches[c.rows[k]];
    t.beyond_target_mm -= noise_um(static_cast<Eigen::Index>(k)) / kUmPerMm * t.scene.normal;
  }
  share_places(c);
}

}  // namespace abbe::diagnose
