// Raw readings as they would be without the noise of the touch. A reading holds its own touch's noise, and so
// does the residual: where targets lie on a grid, any short period of the scale would seem to explain the one
// by the other. What the recording plainly holds beside noise must stay in the reading, or the phase within a
// short period is lost: it is fitted first, as far as readings are not needed for it.
#include <algorithm>

#include "engine/diagnose/case.hpp"

namespace abbe::diagnose {

void free_readings_of_noise(Case& c, const EvidenceSearch& first) {
  constexpr int kMost = 3;
  constexpr double kPlain = 10;  // nats
  if ((c.touches.known & static_cast<unsigned>(Covariate::raw_reading)) == 0) return;
  LinearModel model = c.model;
  Hyperparameters hyper = c.hyper;
  Evidence evidence = first.evidence();
  for (int round = 1; evidence.statistic >= kPlain; ++round) {
    const auto& bayes = evidence.block_log_bayes;
    const auto best = static_cast<std::size_t>(std::max_element(bayes.begin(), bayes.end()) - bayes.begin());
    model = with_free(model, {&c.explanations.blocks[best].signature});
    hyper = estimate(model);
    if (round == kMost) break;
    evidence = EvidenceSearch(model, hyper, c.explanations).evidence();
  }
  // Its expectation given the recording, no more: what is taken out beyond it comes back with the other sign,
  // and where one place was touched again and again, nothing else would be left in the readings.
  const Vector noise_um = expected_noise(model, hyper);
  for (std::size_t k = 0; k < c.rows.size(); ++k)
    c.touches.touches[static_cast<std::size_t>(c.rows[k])].beyond_target_mm -=
        noise_um(static_cast<Eigen::Index>(k)) / kUmPerMm;
}

}  // namespace abbe::diagnose
