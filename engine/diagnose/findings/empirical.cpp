#include "engine/diagnose/findings/empirical.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "engine/effects/empirical/empirical.hpp"
#include "engine/math/units.hpp"

namespace abbe::diagnose {

namespace {

/// Several settings are fitted together: a pattern over position is the sum of one along each axis.
struct Piece {
  const Effect* effect = nullptr;
  std::vector<double> theta;  ///< choices and ranges; the linear parameters are 0
};

Piece piece(const Effect& effect) {
  Piece p{&effect, {}};
  for (const EffectParameter& parameter : effect.parameters) p.theta.push_back(parameter.standard);
  return p;
}

Piece curve(const Case& c, CurveCoordinate along) {
  Piece p = piece(kEmpiricalCurve);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const int i : c.rows) {
    const double at = curve_coordinate(c.touches.touches[static_cast<std::size_t>(i)].scene, along);
    low = std::min(low, at), high = std::max(high, at);
  }
  p.theta[0] = static_cast<double>(along), p.theta[1] = low, p.theta[2] = high;
  return p;
}

/// One offset for each stylus system or each orientation.
std::vector<Piece> offsets(const Case& c, bool by_sensor) {
  std::set<std::vector<double>> groups;
  for (const int i : c.rows) {
    const StylusScene& s = c.touches.touches[static_cast<std::size_t>(i)].scene.stylus;
    groups.insert(by_sensor ? std::vector<double>{0, double(s.ordinal), 0, 0}
                            : std::vector<double>{1, 0, s.head_a_rad / kDegree, s.head_b_rad / kDegree});
  }
  std::vector<Piece> list;
  for (const std::vector<double>& g : groups) {
    list.push_back(piece(kEmpiricalOffset));
    std::copy(g.begin(), g.end(), list.back().theta.begin());
  }
  return list;
}

/// Effects that follow an explanation's pattern; none where it is a function of two factors, or of what
/// another program does not share.
std::vector<Piece> pieces_of(const Case& c, const Explanation& e) {
  if (!e.of_one_factor) return {};
  switch (e.factor) {
    case Factor::time: return {curve(c, CurveCoordinate::time)};
    case Factor::position: {
      std::vector<Piece> list{curve(c, CurveCoordinate::x), curve(c, CurveCoordinate::y), curve(c, CurveCoordinate::z)};
      // along the normal: on a ball, place and direction are one
      if (e.shape == "height") list.push_back(piece(kEmpiricalDirection));
      return list;
    }
    case Factor::temperature: return {curve(c, CurveCoordinate::part_temperature)};
    case Factor::speed: return {curve(c, CurveCoordinate::speed)};
    case Factor::head: return offsets(c, false);
    case Factor::sensor: return offsets(c, true);
    case Factor::direction: {
      Piece p = piece(kEmpiricalDirection);
      p.theta[0] = e.shape == "on the probe" || e.shape == "lobes" ? 1 : 0;
      return {p};
    }
    case Factor::setup:
    case Factor::feature:
    case Factor::run: return {};
  }
  return {};
}

/// The columns of all pieces, um per um, and which parameter of which piece each is.
struct Basis {
  Matrix columns;
  std::vector<std::pair<std::size_t, std::size_t>> of;
};

Basis basis_of(const Case& c, const std::vector<Piece>& pieces) {
  Basis b;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    for (std::size_t p = 0; p < pieces[k].theta.size(); ++p) {
      if (!pieces[k].effect->parameters[p].linear) continue;
      std::vector<double> theta = pieces[k].theta;
      theta[p] = 1;
      b.columns.conservativeResize(static_cast<Eigen::Index>(c.rows.size()), b.columns.cols() + 1);
      for (std::size_t i = 0; i < c.rows.size(); ++i) {
        const TouchScene& scene = c.touches.touches[static_cast<std::size_t>(c.rows[i])].scene;
        b.columns(static_cast<Eigen::Index>(i), b.columns.cols() - 1) =
            kUmPerMm * dot(scene.normal, pieces[k].effect->displace(scene, theta.data(), nullptr));
      }
      b.of.emplace_back(k, p);
    }
  }
  return b;
}

/// A pattern over these belongs to the part or to the day, not to the machine: in another program the same
/// place is another feature.
bool of_the_occasion(Factor f) { return f == Factor::setup || f == Factor::feature || f == Factor::run; }

struct Fit {
  Vector value, u;
};

/// Ridge estimate; the prior size is the one of greatest evidence.
Fit fitted(const Information& info) {
  const Matrix one = Matrix::Identity(info.g.rows(), info.g.cols());
  double best = -std::numeric_limits<double>::infinity(), size = 1;
  for (const double s : {0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0}) {
    const Eigen::LLT<Matrix> llt(one + s * s * info.g);
    const Vector v = llt.matrixL().solve(info.u);
    const double log_bayes = 0.5 * s * s * v.squaredNorm() - llt.matrixLLT().diagonal().array().log().sum();
    if (log_bayes > best) best = log_bayes, size = s;
  }
  const Eigen::LLT<Matrix> llt(info.g + one / (size * size));
  const Matrix inverse = llt.solve(one);
  return {inverse * info.u, (inverse * info.g * inverse).diagonal().cwiseMax(0).cwiseSqrt()};
}

EffectSetting setting_of(const Piece& piece) {
  EffectSetting s{std::string(piece.effect->name), {}};
  for (std::size_t p = 0; p < piece.theta.size(); ++p) {
    const EffectParameter& parameter = piece.effect->parameters[p];
    if (parameter.linear) continue;
    EffectSetting::Value& v = s.parameters[std::string(parameter.name)];
    v.value = piece.theta[p];
    if (!parameter.choices.empty())
      v.word = parameter.choices[static_cast<std::size_t>(std::lround(piece.theta[p] - parameter.low))];
  }
  return s;
}

/// The likeliest pattern that an effect can follow, which need not be the likeliest of all. None where
/// nothing follows it that the recording speaks for.
const Explanation* carried(const Case& c, const Finding& f) {
  const Explanation* best = nullptr;
  double most = 0;
  for (std::size_t k = 0; k < c.explanations.list.size(); ++k) {
    const Explanation& e = c.explanations.list[k];
    if (e.effect || f.evidence.log_bayes[k] <= most || pieces_of(c, e).empty()) continue;
    most = f.evidence.log_bayes[k];
    best = &e;
  }
  return best;
}

}  // namespace

EmpiricalModel empirical_model(const Case& c, const SearchResult& result) {
  if (!result.other) return {};
  const Explanation& found = c.explanations.list[static_cast<std::size_t>(result.other->explanation)];
  if (of_the_occasion(found.factor)) return {};
  const Explanation* e = pieces_of(c, found).empty() ? carried(c, *result.other) : &found;
  if (!e) return {};
  const std::vector<Piece> pieces = pieces_of(c, *e);
  const Basis basis = basis_of(c, pieces);
  Explanations one;
  one.list.push_back(*e);
  one.list.back().blocks = {0};
  one.list.back().prior = 1;
  one.blocks.emplace_back();
  one.blocks.back().signature = basis.columns;
  const EvidenceSearch search(with_free(c.model, signatures_of(c, result.findings)), result.hyper, one);
  if (search.evidence().log_bayes[0] <= 0) return {};  // what follows the pattern so badly would spoil what was right
  const Fit fit = fitted(search.information(0));
  std::vector<EffectSetting> settings;
  for (const Piece& p : pieces) settings.push_back(setting_of(p));
  for (std::size_t k = 0; k < basis.of.size(); ++k) {
    const auto [at, p] = basis.of[k];
    const auto i = static_cast<Eigen::Index>(k);
    settings[at].parameters[std::string(pieces[at].effect->parameters[p].name)] = {fit.value(i), fit.u(i), {}};
  }
  return {std::move(settings), e};
}

}  // namespace abbe::diagnose
