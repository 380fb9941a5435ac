#include "engine/diagnose/findings/empirical.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "engine/diagnose/findings/carried.hpp"
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
  bool spans = true;  ///< whether touches differ in what it is a function of

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

/// The ends of a curve. Below a thousandth of a mm, s, degree or mm/s there is nothing between them.
struct Range {
  double low, high;
  bool spans() const {
    constexpr double kLeast = 1e-3;
    return high - low > kLeast;
  }
};
Range range_of(const Case& c, CurveCoordinate along) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const int i : c.rows) {
    const double at = curve_coordinate(c.touches.touches[i].scene, along);
    low = std::min(low, at), high = std::max(high, at);
  }
  return {low, high};
}

Piece curve(const Case& c, CurveCoordinate of, Along along) {
  Piece p = piece(kEmpiricalCurve);
  p.along = along;
  p.theta[0] = static_cast<double>(of);
  const Range range = range_of(c, of);
  p.theta[1] = range.low, p.theta[2] = range.high;
  p.spans = range.spans();
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
  const Range one = range_of(c, first), other = range_of(c, second);
  p.theta[1] = one.low, p.theta[2] = one.high, p.theta[3] = other.low, p.theta[4] = other.high;
  p.spans = one.spans() && other.spans();
  return p;
}

/// One offset for each stylus system or each orientation.
Pieces offsets(const Case& c, bool by_sensor) {
  std::set<std::vector<double>> groups;
  for (const int i : c.rows) {
    const StylusScene& s = c.touches.touches[i].scene.stylus;
    groups.insert(by_sensor ? std::vector<double>{0, double(s.ordinal), 0, 0}
                            : std::vector<double>{1, 0, in_degrees(s.head_a_rad), in_degrees(s.head_b_rad)});
  }
  Pieces list;
  for (const std::vector<double>& g : groups) {
    list.push_back(piece(kEmpiricalOffset));
    std::copy(g.begin(), g.end(), list.back().theta.begin());
  }
  return list;
}

/// Effects that are functions of a factor, the one or the other; none where another program does not share it.
std::vector<Pieces> followers_of(const Case& c, Factor factor) {
  std::vector<Pieces> list;
  const auto along_curve = [&](CurveCoordinate of) {
    for (const Along along : {Along::axes, Along::normal}) list.push_back({curve(c, of, along)});
  };
  switch (factor) {
    case Factor::time: along_curve(CurveCoordinate::time); break;
    case Factor::temperature: along_curve(CurveCoordinate::part_temperature); break;
    case Factor::speed: along_curve(CurveCoordinate::speed); break;
    case Factor::position:
      for (const Along along : {Along::axes, Along::normal}) {
        list.push_back({curve(c, CurveCoordinate::x, along), curve(c, CurveCoordinate::y, along),
                        curve(c, CurveCoordinate::z, along)});
        for (const MapPlane plane : {MapPlane::xy, MapPlane::xz, MapPlane::yz}) list.push_back({map(c, plane, along)});
      }
      break;
    case Factor::head: list.push_back(offsets(c, false)); break;
    case Factor::sensor: list.push_back(offsets(c, true)); break;
    case Factor::direction:
      for (const double frame : {0.0, 1.0}) {
        list.push_back({piece(kEmpiricalDirection)});
        list.back().front().theta[0] = frame;
      }
      break;
    case Factor::setup:
    case Factor::feature:
    case Factor::run: break;
  }
  for (Pieces& pieces : list) std::erase_if(pieces, [](const Piece& p) { return !p.spans; });
  std::erase_if(list, [](const Pieces& pieces) { return pieces.empty(); });
  return list;
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
      for (Eigen::Index i = 0; i < b.columns.rows(); ++i)
        b.columns(i, b.columns.cols() - 1) =
            kUmPerMm * dot(c.scene(i).normal, pieces[k].effect->displace(c.scene(i), theta.data(), nullptr));
      b.of.emplace_back(k, p);
    }
  }
  return b;
}

/// A pattern over these belongs to the part or to the day, not to the machine: in another program the same
/// place is another feature.
bool of_the_occasion(Factor f) { return f == Factor::setup || f == Factor::feature || f == Factor::run; }

/// What differences between neighbouring knots count beside what touches show: little, but where none, or hardly one, was
/// made a knot lies between its neighbours.
Matrix between_neighbours(const Pieces& pieces, const Basis& basis) {
  constexpr double kUnseen = 0.03, kUnknown = 1e-6;  // of what a touch at a knot shows
  std::map<std::pair<std::size_t, std::size_t>, Eigen::Index> column;
  for (std::size_t k = 0; k < basis.of.size(); ++k) column[basis.of[k]] = static_cast<Eigen::Index>(k);
  Matrix out = kUnknown * Matrix::Identity(basis.columns.cols(), basis.columns.cols());
  for (std::size_t p = 0; p < pieces.size(); ++p)
    for (const auto& [one, next] : pieces[p].effect->neighbours) {
      const auto a = column.find({p, one}), b = column.find({p, next});
      if (a == column.end() || b == column.end()) continue;
      const Eigen::Index i = a->second, j = b->second;
      out(i, i) += kUnseen, out(j, j) += kUnseen, out(i, j) -= kUnseen, out(j, i) -= kUnseen;
    }
  return out;
}

/// What columns show beside the placement of the part.
Matrix beside_placement(const Matrix& placement, const Matrix& columns) {
  return columns - placement * (placement.transpose() * columns);
}

/// What the basis must be weighted with to show what the pattern does, by least squares. A course of which the placement takes
/// up all but a tenth, in squares, is left out: the little that shows of it would make it large.
Matrix weights_of(const Basis& basis, const Matrix& between, const Matrix& placement, const Matrix& pattern) {
  constexpr double kSeen = 0.1;
  const Matrix visible = beside_placement(placement, basis.columns);
  const auto [share, course] =
      spectrum_beside(visible.transpose() * visible, basis.columns.transpose() * basis.columns + between);
  const Vector weight = (share.array() > kSeen).select(share.cwiseMax(kSeen).cwiseInverse(), 0);
  return course * weight.asDiagonal() * (course.transpose() * (visible.transpose() * pattern));
}

struct Fit {
  Vector value;
  Matrix covariance;
};

/// Ridge estimate; the prior size is the one of greatest evidence. Its covariance is what the data leave in what they see.
Fit fitted(const Information& info) {
  double best = -std::numeric_limits<double>::infinity(), size = 1;
  for (const double s : {0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0}) {
    const Cholesky root(s * s * info.g, 1);
    const Vector v = root.whitened(info.u);
    const double log_bayes = 0.5 * s * s * v.squaredNorm() - root.half_log_determinant();
    if (log_bayes > best) best = log_bayes, size = s;
  }
  const Matrix inverse = Cholesky(info.g, 1 / (size * size)).inverse();
  return {inverse * info.u, inverse * info.g * inverse};
}

/// Uncertainties of the basis' parameters, drawn independently of each other, that give every touch as much as the pattern
/// shows there.
Vector uncertainties(const Basis& basis, const Matrix& between, const Matrix& pattern, const Matrix& covariance) {
  const Vector variance = (pattern * covariance).cwiseProduct(pattern).rowwise().sum().cwiseMax(0);
  const Matrix share = basis.columns.cwiseAbs2();
  const Vector all = share.transpose() * share.rowwise().sum();
  return Cholesky(Matrix(all.asDiagonal()) + between)
      .solve(Vector(share.transpose() * variance))
      .cwiseMax(0)
      .cwiseSqrt();
}

/// Without its sizes.
EffectSetting setting_of(const Piece& piece) {
  EffectSetting s = setting_at(*piece.effect, piece.theta);
  for (const EffectParameter& p : piece.effect->parameters)
    if (p.linear) s.parameters.erase(std::string(p.name));
  return s;
}

/// How well effects follow a pattern.
struct Following {
  Factor factor = Factor::time;
  Pieces pieces;
  Basis basis;
  Vector value, u;
  double log_bayes = 0;
  double share = 0;  ///< of the squares that the pattern shows, what these effects make too
};

/// The likeliest of the effects that are functions of these factors.
Following best_following(const Case& c, const LinearModel& beside, const Hyperparameters& hyper, const Matrix& pattern,
                         const std::vector<Factor>& factors) {
  const Matrix placement = independent(beside.free), visible = beside_placement(placement, pattern);
  std::vector<Following> all;
  std::vector<Matrix> between, weights;
  Explanations each;
  const auto add = [&](Matrix signature) {
    Explanation e;
    e.variants = {static_cast<int>(each.variants.size())};
    each.list.push_back(std::move(e));
    each.variants.emplace_back().signature = std::move(signature);
  };
  add(pattern);
  for (const Factor factor : factors) {
    for (Pieces& pieces : followers_of(c, factor)) {
      Following f;
      f.factor = factor, f.basis = basis_of(c, pieces), f.pieces = std::move(pieces);
      if (f.basis.columns.cols() > f.basis.columns.rows()) continue;  // more values than touches to tell them
      between.push_back(between_neighbours(f.pieces, f.basis));
      weights.push_back(weights_of(f.basis, between.back(), placement, visible));
      add(f.basis.columns * weights.back());
      all.push_back(std::move(f));
    }
  }
  if (all.empty()) return {};
  for (Explanation& e : each.list) e.prior = 1 / double(each.list.size());
  const EvidenceSearch search(beside, hyper, each);
  const std::vector<double>& belief = search.evidence().log_bayes;
  const auto best = static_cast<std::size_t>(std::max_element(belief.begin() + 1, belief.end()) - belief.begin());
  Following out = std::move(all[best - 1]);
  out.log_bayes = belief[best];
  const Fit found = fitted(search.information(0)), fit = fitted(search.information(static_cast<int>(best)));
  const Matrix& followed = each.variants[best].signature;
  const Vector whole = visible * found.value, left = whole - beside_placement(placement, followed) * fit.value;
  out.share = 1 - left.squaredNorm() / whole.squaredNorm();
  out.value = weights[best - 1] * fit.value;
  out.u = uncertainties(out.basis, between[best - 1], beside_placement(placement, followed), fit.covariance);
  return out;
}

}  // namespace

EmpiricalModel empirical_model(const Case& c, const SearchResult& result) {
  constexpr double kFollows = 0.5, kWholly = 0.9;
  if (!result.other) return {};
  const Factor factor = c.explanations.list[result.other->explanation].factor;
  if (of_the_occasion(factor)) return {};
  const Matrix& pattern = c.explanations.variants[result.other->variant].signature;
  const LinearModel beside = with_free(c.model, signatures_of(c, result.findings));
  const auto follows = [](const Following& f) { return f.log_bayes > 0 && f.share >= kFollows; };
  Following best = best_following(c, beside, result.hyper, pattern, {factor});
  if (!follows(best))
    best = best_following(c, beside, result.hyper, pattern,
                          {Factor::time, Factor::position, Factor::direction, Factor::head, Factor::sensor,
                           Factor::temperature, Factor::speed});
  if (!follows(best)) return {};  // what follows it so badly would spoil what was right
  EmpiricalModel out;
  if (best.factor != factor || best.share < kWholly) out.follows = best.factor;
  for (const Piece& p : best.pieces) out.settings.push_back(setting_of(p));
  for (std::size_t k = 0; k < best.basis.of.size(); ++k) {
    const auto [at, p] = best.basis.of[k];
    const auto i = static_cast<Eigen::Index>(k);
    out.settings[at].parameters[std::string(best.pieces[at].effect->parameters[p].name)] = {
        best.value(i), best.u(i), {}};
  }
  return out;
}

}  // namespace abbe::diagnose
