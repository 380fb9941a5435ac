#include "engine/diagnose/findings/empirical.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "engine/effects/empirical/empirical.hpp"
#include "engine/math/units.hpp"

namespace abbe::diagnose {

namespace {

/// In the axes of the machine, or along the normal: what few directions were touched does not tell apart, and stays one.
enum class Along { axes, normal, both };

struct Piece {
  const Effect* effect = nullptr;
  std::vector<double> theta;  ///< choices and ranges; the linear parameters are 0
  Along along = Along::both;

  bool fits(const EffectParameter& p) const {
    return p.linear && (along == Along::both || (along == Along::normal) == p.name.starts_with('r'));
  }
};

Piece piece(const Effect& effect) {
  Piece p;
  p.effect = &effect;
  for (const EffectParameter& parameter : effect.parameters) p.theta.push_back(parameter.standard);
  return p;
}

/// Several settings are fitted together: a pattern over position may be the sum of one along each axis.
using Pieces = std::vector<Piece>;

std::pair<double, double> range_of(const Case& c, CurveCoordinate along) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const int i : c.rows) {
    const double at = curve_coordinate(c.touches.touches[static_cast<std::size_t>(i)].scene, along);
    low = std::min(low, at), high = std::max(high, at);
  }
  return {low, high};
}

Piece curve(const Case& c, CurveCoordinate of, Along along) {
  Piece p = piece(kEmpiricalCurve);
  p.along = along;
  p.theta[0] = static_cast<double>(of);
  std::tie(p.theta[1], p.theta[2]) = range_of(c, of);
  return p;
}

Piece map(const Case& c, MapPlane plane, Along along) {
  constexpr std::pair<CurveCoordinate, CurveCoordinate> axes[] = {{CurveCoordinate::x, CurveCoordinate::y},
                                                                  {CurveCoordinate::x, CurveCoordinate::z},
                                                                  {CurveCoordinate::y, CurveCoordinate::z}};
  const auto& [first, second] = axes[static_cast<int>(plane)];
  Piece p = piece(kEmpiricalMap);
  p.along = along;
  p.theta[0] = static_cast<double>(plane);
  std::tie(p.theta[1], p.theta[2]) = range_of(c, first);
  std::tie(p.theta[3], p.theta[4]) = range_of(c, second);
  return p;
}

/// One offset for each stylus system or each orientation.
Pieces offsets(const Case& c, bool by_sensor) {
  std::set<std::vector<double>> groups;
  for (const int i : c.rows) {
    const StylusScene& s = c.touches.touches[static_cast<std::size_t>(i)].scene.stylus;
    groups.insert(by_sensor ? std::vector<double>{0, double(s.ordinal), 0, 0}
                            : std::vector<double>{1, 0, s.head_a_rad / kDegree, s.head_b_rad / kDegree});
  }
  Pieces list;
  for (const std::vector<double>& g : groups) {
    list.push_back(piece(kEmpiricalOffset));
    std::copy(g.begin(), g.end(), list.back().theta.begin());
  }
  return list;
}

/// Effects that may follow an explanation's pattern, the one or the other; none where it is a function of two factors, or
/// of what another program does not share.
std::vector<Pieces> followers_of(const Case& c, const Explanation& e) {
  if (!e.of_one_factor) return {};
  std::vector<Pieces> list;
  const auto along_curve = [&](CurveCoordinate of) {
    for (const Along along : {Along::axes, Along::normal}) list.push_back({curve(c, of, along)});
    return list;
  };
  switch (e.factor) {
    case Factor::time: return along_curve(CurveCoordinate::time);
    case Factor::position:
      for (const Along along : {Along::axes, Along::normal}) {
        list.push_back({curve(c, CurveCoordinate::x, along), curve(c, CurveCoordinate::y, along),
                        curve(c, CurveCoordinate::z, along)});
        for (const MapPlane plane : {MapPlane::xy, MapPlane::xz, MapPlane::yz}) list.push_back({map(c, plane, along)});
      }
      // along the normal: on a ball, place and direction are one
      if (e.shape == "height")
        for (Pieces& pieces : list) pieces.push_back(piece(kEmpiricalDirection));
      return list;
    case Factor::temperature: return along_curve(CurveCoordinate::part_temperature);
    case Factor::speed: return along_curve(CurveCoordinate::speed);
    case Factor::head: return {offsets(c, false)};
    case Factor::sensor: return {offsets(c, true)};
    case Factor::direction: {
      Piece p = piece(kEmpiricalDirection);
      p.theta[0] = e.shape == "on the probe" || e.shape == "lobes" ? 1 : 0;
      return {{p}};
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

Basis basis_of(const Case& c, const Pieces& pieces) {
  Basis b;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    for (std::size_t p = 0; p < pieces[k].theta.size(); ++p) {
      if (!pieces[k].fits(pieces[k].effect->parameters[p])) continue;
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

/// What differences between neighbouring knots count beside what touches show: next to nothing, but where none was made a
/// knot lies between its neighbours.
Matrix between_neighbours(const Pieces& pieces, const Basis& basis) {
  constexpr double kUnseen = 1e-4, kUnknown = 1e-8;  // of what a touch at a knot shows
  std::map<std::pair<std::size_t, std::size_t>, Eigen::Index> column;
  for (std::size_t k = 0; k < basis.of.size(); ++k) column[basis.of[k]] = static_cast<Eigen::Index>(k);
  Matrix out = kUnknown * Matrix::Identity(basis.columns.cols(), basis.columns.cols());
  for (std::size_t p = 0; p < pieces.size(); ++p)
    for (const auto& [one, next] : neighbouring_knots(*pieces[p].effect)) {
      const auto a = column.find({p, one}), b = column.find({p, next});
      if (a == column.end() || b == column.end()) continue;
      const Eigen::Index i = a->second, j = b->second;
      out(i, i) += kUnseen, out(j, j) += kUnseen, out(i, j) -= kUnseen, out(j, i) -= kUnseen;
    }
  return out;
}

/// What the basis must be weighted with to follow a pattern: its least squares.
Matrix weights_of(const Basis& basis, const Matrix& between, const Matrix& pattern) {
  const Matrix seen = basis.columns.transpose() * basis.columns + between;
  return seen.llt().solve(basis.columns.transpose() * pattern);
}

struct Fit {
  Vector value;
  Matrix covariance;
};

/// Ridge estimate; the prior size is the one of greatest evidence. Its covariance is what the data leave in what they see.
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
  return {inverse * info.u, inverse * info.g * inverse};
}

/// Uncertainties of the basis' parameters, drawn independently of each other, that give every touch as much as the pattern
/// has there. What a placement of the part takes up is common to all of them and shows nowhere.
Vector uncertainties(const Basis& basis, const Matrix& between, const Matrix& pattern, const Matrix& covariance,
                     const Matrix& free) {
  const Matrix placement = independent(free), shown = pattern - placement * (placement.transpose() * pattern);
  const Vector variance = (shown * covariance).cwiseProduct(shown).rowwise().sum().cwiseMax(0);
  const Matrix share = basis.columns.cwiseAbs2();
  const Vector all = share.transpose() * share.rowwise().sum();
  return (Matrix(all.asDiagonal()) + between).llt().solve(share.transpose() * variance).cwiseMax(0).cwiseSqrt();
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
    if (e.effect || f.evidence.log_bayes[k] <= most || followers_of(c, e).empty()) continue;
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
  const Explanation* e = followers_of(c, found).empty() ? carried(c, *result.other) : &found;
  if (!e) return {};
  const auto index = static_cast<int>(e - c.explanations.list.data());
  const int block = e == &found ? result.other->block : best_block(c.explanations, index, result.other->evidence);
  const Matrix& pattern = c.explanations.blocks[static_cast<std::size_t>(block)].signature;
  const std::vector<Pieces> followers = followers_of(c, *e);
  std::vector<Basis> bases;
  std::vector<Matrix> between, weights;
  Explanations each;
  for (const Pieces& pieces : followers) {
    bases.push_back(basis_of(c, pieces));
    between.push_back(between_neighbours(pieces, bases.back()));
    weights.push_back(weights_of(bases.back(), between.back(), pattern));
    Explanation follower = *e;
    follower.prior = 1 / double(followers.size());
    follower.blocks = {static_cast<int>(each.blocks.size())};
    each.list.push_back(std::move(follower));
    each.blocks.emplace_back().signature = bases.back().columns * weights.back();
  }
  const LinearModel beside = with_free(c.model, signatures_of(c, result.findings));
  const EvidenceSearch search(beside, result.hyper, each);
  const std::vector<double>& belief = search.evidence().log_bayes;
  const auto best = static_cast<std::size_t>(std::max_element(belief.begin(), belief.end()) - belief.begin());
  if (belief[best] <= 0) return {};  // what follows the pattern so badly would spoil what was right
  const Fit fit = fitted(search.information(static_cast<int>(best)));
  const Vector value = weights[best] * fit.value;
  const Vector u = uncertainties(bases[best], between[best], each.blocks[best].signature, fit.covariance, beside.free);
  const Pieces& pieces = followers[best];
  std::vector<EffectSetting> settings;
  for (const Piece& p : pieces) settings.push_back(setting_of(p));
  for (std::size_t k = 0; k < bases[best].of.size(); ++k) {
    const auto [at, p] = bases[best].of[k];
    const auto i = static_cast<Eigen::Index>(k);
    settings[at].parameters[std::string(pieces[at].effect->parameters[p].name)] = {value(i), u(i), {}};
  }
  return {std::move(settings), e};
}

}  // namespace abbe::diagnose
