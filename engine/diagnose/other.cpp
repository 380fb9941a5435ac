// OTHER: random patterns in each factor, for physics that the catalogue does not have. Without it a diagnosis names the nearest
// effect with great confidence whatever the truth is. Patterns are Gaussian processes in their subset-of-regressors form on evenly spread
// centres (Rasmussen & Williams 2006, 4.2.1 and 8.3.1): columns K_rows,centres K_centres^(-1/2), amplitude 1 um. Smooth ones have a
// squared-exponential covariance, rugged ones an exponential one: jumps, saws and chirps are no smooth functions. Periodic ones are sines and
// cosines of one frequency each.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "engine/diagnose/explanation.hpp"

namespace abbe::diagnose {

namespace {

using Points = std::vector<std::vector<double>>;

double squared_distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

/// Centres spread over the points: each the point farthest from those before, until all are nearer than half a length, or `most`.
Points centres(const Points& points, double length, int most) {
  Points chosen{points.front()};
  std::vector<double> nearest(points.size(), 1e300);
  while (static_cast<int>(chosen.size()) < most) {
    std::size_t far = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      nearest[i] = std::min(nearest[i], squared_distance(points[i], chosen.back()));
      if (nearest[i] > nearest[far]) far = i;
    }
    if (nearest[far] < length * length / 4) break;
    chosen.push_back(points[far]);
  }
  return chosen;
}

/// Functions of the points with a covariance of their squared distance: columns of variance about 1.
template <class Covariance>
Matrix functions(const Points& points, const Points& at, Covariance covariance) {
  const auto kernel = [&](const Points& a, const Points& b) {
    Matrix k(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
      for (std::size_t j = 0; j < b.size(); ++j) k(i, j) = covariance(squared_distance(a[i], b[j]));
    return k;
  };
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(kernel(at, at) + 1e-6 * Matrix::Identity(at.size(), at.size()));
  return kernel(points, at) * solver.operatorInverseSqrt();
}

Matrix smooth(const Points& points, double length, int most) {
  return functions(points, centres(points, length, most), [&](double d2) { return std::exp(-d2 / (2 * length * length)); });
}

Matrix rugged(const Points& points, double length, int most) {
  return functions(points, centres(points, 4.0 / most, most), [&](double d2) { return std::exp(-std::sqrt(d2) / length); });
}

/// The values lie in [0, 1] then.
void onto_unit(Points& line) {
  double low = line.front()[0], high = low;
  for (const auto& p : line) low = std::min(low, p[0]), high = std::max(high, p[0]);
  for (auto& p : line) p[0] = (p[0] - low) / std::max(1e-9, high - low);
}

/// Columns times each component of a direction by row: a vector field seen along the normals.
Matrix along(const Matrix& field, const std::vector<Vec3>& direction) {
  Matrix out(field.rows(), 3 * field.cols());
  for (int k = 0; k < 3; ++k)
    for (Eigen::Index i = 0; i < field.rows(); ++i) out.row(i).segment(k * field.cols(), field.cols()) = field.row(i) * direction[i][k];
  return out;
}

/// One column for each group: 1 in its rows.
Matrix indicator(const std::vector<int>& group) {
  std::map<int, int> index;
  for (const int g : group) index.emplace(g, 0);
  int next = 0;
  for (auto& [g, i] : index) i = next++;
  Matrix out = Matrix::Zero(group.size(), next);
  for (std::size_t i = 0; i < group.size(); ++i) out(i, index[group[i]]) = 1;
  return out;
}

/// Every column of one times every column of the other.
Matrix products(const Matrix& a, const Matrix& b) {
  Matrix out(a.rows(), a.cols() * b.cols());
  for (Eigen::Index k = 0; k < b.cols(); ++k) out.middleCols(k * a.cols(), a.cols()) = b.col(k).asDiagonal() * a;
  return out;
}

/// Columns of `field` kept apart by group.
Matrix by_group(const Matrix& field, const std::vector<int>& group) {
  const Matrix in = indicator(group);
  Matrix out = Matrix::Zero(field.rows(), field.cols() * in.cols());
  for (Eigen::Index g = 0; g < in.cols(); ++g) out.middleCols(g * field.cols(), field.cols()) = in.col(g).asDiagonal() * field;
  return out;
}

/// Cosine of the angle between an approach and the surface's normal beyond which the two differ.
constexpr double kStraight = 0.99;

/// The factors of the touches, in the units in which kernels are spread.
class Patterns {
 public:
  Patterns(const RecordedTouches& t, const std::vector<int>& rows, Explanations& out) : out_(out) {
    std::map<std::pair<double, double>, int> orientation;
    for (const int i : rows) {
      const TouchScene& s = t.touches[i].scene;
      normal_.push_back(s.normal);
      time_.push_back({s.time_s});
      place_.push_back({s.point.x, s.point.y, s.point.z});
      for (int k = 0; k < 3; ++k) reading_[k].push_back({s.reading[k]});
      directions_.push_back({s.normal.x, s.normal.y, s.normal.z});
      const Vec3 n = transpose(s.stylus.R_WR) * s.normal;
      on_probe_.push_back({n.x, n.y, n.z});
      orientation_.push_back(orientation.emplace(std::pair{s.stylus.head_a_rad, s.stylus.head_b_rad}, int(orientation.size())).first->second);
      sensor_.push_back(s.stylus.ordinal), feature_.push_back(s.feature), setup_.push_back(s.setup), run_.push_back(s.run);
      speed_.push_back(int(std::lround(1000 * s.speed_mm_s)));
      travel_.push_back({s.travel.x, s.travel.y, s.travel.z});
      oblique_ = oblique_ || dot(s.travel, s.normal) > -kStraight;
      normal_on_part_.push_back(s.normal_on_part);
      touch_.push_back({double(touch_.size())});
    }
    onto_unit(touch_);
    part_above20_.resize(static_cast<Eigen::Index>(rows.size()));
    for (Vector& v : scale_above20_) v.resize(part_above20_.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto& temperature = t.touches[rows[i]].scene.temperature;
      part_above20_(static_cast<Eigen::Index>(i)) = temperature.part - 20;
      for (int k = 0; k < 3; ++k) scale_above20_[k](static_cast<Eigen::Index>(i)) = temperature.scale[k] - 20;
    }
    for (auto& p : time_) p[0] = (p[0] - t.touches.front().scene.time_s) / std::max(1.0, t.touches.back().scene.time_s - t.touches.front().scene.time_s);
    normalise(place_);
    for (Points& r : reading_) onto_unit(r);
    // Time since the head, or the part, was moved to where it is.
    std::map<std::array<int, 3>, double> begun;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const TouchScene& s = t.touches[rows[k]].scene;
      settled_.push_back({s.time_s - begun.emplace(std::array{s.run, s.setup, s.visit}, s.time_s).first->second});
      clamped_.push_back({s.time_s - begun.emplace(std::array{s.run, s.setup, -1}, s.time_s).first->second});
    }
    onto_unit(settled_), onto_unit(clamped_);
  }

  void add_all() {
    const Matrix one = Matrix::Ones(normal_.size(), 1);
    add(Factor::time, "slow", along(smooth(time_, 0.3, 8), normal_));
    add(Factor::time, "quick", along(smooth(time_, 0.07, 22), normal_));
    add(Factor::time, "rugged", in_one_direction(rugged(time_, 0.2, 40)));
    add_joint(Factor::time, "stretching", stretching());
    add_joint(Factor::time, "turning to and fro", turning());
    add_joint(Factor::time, "size along the sequence", sizes_along_the_sequence());
    add(Factor::position, "smooth", along(smooth(place_, 0.6, 14), normal_));
    add(Factor::position, "patch", along(smooth(place_, 0.25, 26), normal_));
    add(Factor::position, "height", smooth(place_, 0.4, 24));
    add(Factor::position, "along a guide", guides());
    add_joint(Factor::position, "in time", along(products(smooth(place_, 0.6, 8), trend()), normal_));
    add(Factor::direction, "smooth", smooth(directions_, 0.6, 40));
    add_joint(Factor::direction, "in time", products(smooth(directions_, 0.9, 8), smooth(time_, 0.2, 8)));
    if (oblique_) add_joint(Factor::direction, "of travel", smooth(travel_, 0.6, 40));
    if (several(orientation_)) {
      add(Factor::direction, "on the probe", smooth(on_probe_, 0.6, 40));
      add(Factor::direction, "lobes", lobes());
      add(Factor::head, "orientation", along(indicator(orientation_), normal_));
      add_joint(Factor::head, "orientation in time", along(by_group(trend(), orientation_), normal_));
      add_joint(Factor::head, "settling", along(by_group(settling(settled_), orientation_), normal_));
      add_joint(Factor::head, "over position", along(by_group(linear_place(), orientation_), normal_));
    }
    if (several(sensor_)) {
      add(Factor::sensor, "offset", hcat(along(indicator(sensor_), normal_), indicator(sensor_)));
      add_joint(Factor::sensor, "over position", along(by_group(smooth(place_, 0.6, 8), sensor_), normal_));
      add_joint(Factor::sensor, "in time", by_group(hcat(along(trend(), normal_), trend()), sensor_));
    }
    if (several(feature_)) {
      add(Factor::feature, "size", indicator(feature_));
      add_joint(Factor::feature, "size in time", by_group(trend(), feature_));
      add(Factor::feature, "offset on the part", along(indicator(feature_), normal_on_part_));
      add(Factor::feature, "form", by_group(smooth(directions_, 0.9, 8), feature_));
    }
    if (several(setup_)) {
      add(Factor::setup, "form", by_group(along(smooth(place_, 0.6, 6), normal_), setup_));
      add_joint(Factor::setup, "settling", along(by_group(products(linear_place(), settling(clamped_)), setup_), normal_));
    }
    if (several(run_)) {
      add(Factor::run, "offset", along(indicator(run_), normal_));
      add_joint(Factor::run, "form", by_group(along(smooth(place_, 0.6, 6), normal_), run_));
      add_joint(Factor::run, "over direction", by_group(smooth(directions_, 0.9, 8), run_));
    }
    if (several(speed_)) {
      add(Factor::speed, "offset", by_group(one, speed_));
      add_joint(Factor::speed, "over direction", products(smooth(travel_, 0.6, 24), faster()));
    }
    constexpr double kDiffers_K = 0.1;
    if (part_above20_.maxCoeff() - part_above20_.minCoeff() > kDiffers_K)
      add(Factor::temperature, "growth", along(part_above20_.asDiagonal() * linear_place(), normal_));
    std::vector<Matrix> scales;
    for (int k = 0; k < 3; ++k)
      if (scale_above20_[k].maxCoeff() - scale_above20_[k].minCoeff() > kDiffers_K)
        scales.push_back(Vector(scale_above20_[k].array() * normals_along(k).array()).asDiagonal() * smooth(reading_[k], 0.1, 16));
    if (!scales.empty()) add_joint(Factor::temperature, "along a scale", scales);
  }

 private:
  static void normalise(Points& points) {
    std::vector<double> low(points.front()), high(points.front());
    for (const auto& p : points)
      for (std::size_t k = 0; k < p.size(); ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
    double extent = 1e-9;
    for (std::size_t k = 0; k < low.size(); ++k) extent = std::max(extent, high[k] - low[k]);
    for (auto& p : points)
      for (std::size_t k = 0; k < p.size(); ++k) p[k] = (p[k] - low[k]) / extent;
  }
  static bool several(const std::vector<int>& group) { return std::set<int>(group.begin(), group.end()).size() > 1; }
  static Matrix hcat(const Matrix& a, const Matrix& b) {
    Matrix out(a.rows(), a.cols() + b.cols());
    out << a, b;
    return out;
  }
  /// Two to nine lobes about the axis of the probe, greatest on its equator: fixed to the probe.
  std::vector<Matrix> lobes() const {
    std::vector<Matrix> out;
    for (int count = 2; count <= 9; ++count) {
      Matrix m(on_probe_.size(), 2);
      for (std::size_t i = 0; i < on_probe_.size(); ++i) {
        const auto& n = on_probe_[i];
        const double angle = count * std::atan2(n[1], n[0]), equator = n[0] * n[0] + n[1] * n[1];
        m.row(static_cast<Eigen::Index>(i)) << equator * std::cos(angle), equator * std::sin(angle);
      }
      out.push_back(std::move(m));
    }
    return out;
  }

  /// The part turns about its middle, back and forth at one frequency.
  std::vector<Matrix> turning() const {
    constexpr int kMost = 12;
    std::vector<Matrix> out;
    Vec3 middle;
    for (const auto& p : place_) middle += Vec3{p[0], p[1], p[2]} / double(place_.size());
    for (int half_cycles = 1; half_cycles <= 2 * kMost; ++half_cycles) {
      Matrix m(place_.size(), 6);
      for (std::size_t i = 0; i < place_.size(); ++i) {
        const Vec3 turned = cross(Vec3{place_[i][0], place_[i][1], place_[i][2]} - middle, normal_[i]);   // n . (w x l) = w . (l x n)
        const double phase = kPi * half_cycles * time_[i][0];
        for (int k = 0; k < 3; ++k) {
          m(static_cast<Eigen::Index>(i), k) = turned[k] * std::cos(phase);
          m(static_cast<Eigen::Index>(i), 3 + k) = turned[k] * std::sin(phase);
        }
      }
      out.push_back(std::move(m));
    }
    return out;
  }

  /// One function, in every direction or in one of thirteen: the axes, and halfway between two or three of them.
  std::vector<Matrix> in_one_direction(const Matrix& f) const {
    std::vector<Matrix> out{along(f, normal_)};
    for (int code = 14; code < 27; ++code) {   // the half of the 27 directions with components -1, 0, 1 that is after the middle
      const Vec3 d{double(code / 9 - 1), double(code / 3 % 3 - 1), double(code % 3 - 1)};
      Vector share(f.rows());
      for (Eigen::Index i = 0; i < f.rows(); ++i) share(i) = dot(normal_[static_cast<std::size_t>(i)], d) / norm(d);
      out.push_back(share.asDiagonal() * f);
    }
    return out;
  }

  /// A rugged function of the reading of one axis.
  std::vector<Matrix> guides() const {
    std::vector<Matrix> out;
    for (const Points& reading : reading_)
      for (Matrix& m : in_one_direction(rugged(reading, 0.15, 24))) out.push_back(std::move(m));
    return out;
  }

  Vector normals_along(int axis) const {
    Vector v(static_cast<Eigen::Index>(normal_.size()));
    for (Eigen::Index i = 0; i < v.size(); ++i) v(i) = normal_[static_cast<std::size_t>(i)][axis];
    return v;
  }

  /// One axis shifts and stretches along itself, as a rugged function of time.
  std::vector<Matrix> stretching() const {
    std::vector<Matrix> out;
    const Matrix f = rugged(time_, 0.2, 20);
    for (int k = 0; k < 3; ++k) {
      Matrix shift_and_stretch(f.rows(), 2);
      for (Eigen::Index i = 0; i < f.rows(); ++i) shift_and_stretch.row(i) << 1, 2 * reading_[k][static_cast<std::size_t>(i)][0] - 1;
      out.push_back(normals_along(k).asDiagonal() * products(shift_and_stretch, f));
    }
    return out;
  }

  /// Functions of a time since: a straight line, and one that slows down.
  static Matrix settling(const Points& since) {
    Matrix m(since.size(), 2);
    for (std::size_t i = 0; i < since.size(); ++i) m.row(static_cast<Eigen::Index>(i)) << since[i][0], std::sqrt(since[i][0]);
    return m;
  }

  /// What gathers on the tip, or wears off it, with every touch and not with the clock: on all styli alike, or on each by itself.
  std::vector<Matrix> sizes_along_the_sequence() const {
    std::vector<Matrix> out{rugged(touch_, 0.2, 40)};
    if (several(sensor_)) out.push_back(by_group(rugged(touch_, 0.2, 24), sensor_));
    return out;
  }

  /// The approach speed beyond its mean, 1 at the farthest from it.
  Matrix faster() const {
    Matrix m(speed_.size(), 1);
    for (std::size_t i = 0; i < speed_.size(); ++i) m(static_cast<Eigen::Index>(i), 0) = speed_[i];
    m.array() -= m.mean();
    return m / m.cwiseAbs().maxCoeff();
  }

  Matrix trend() const {
    Matrix m(time_.size(), 2);
    for (std::size_t i = 0; i < time_.size(); ++i) m(i, 0) = time_[i][0] - 0.5, m(i, 1) = std::pow(time_[i][0] - 0.5, 2);
    return m * 2;
  }
  Matrix linear_place() const {
    Matrix m(place_.size(), 4);
    for (std::size_t i = 0; i < place_.size(); ++i) m.row(i) << 1, place_[i][0], place_[i][1], place_[i][2];
    return m;
  }

  /// One explanation with these variants, functions of the factor alone.
  void add(Factor factor, std::string shape, const std::vector<Matrix>& variants) { append(factor, std::move(shape), variants, true); }
  void add(Factor factor, std::string shape, const Matrix& columns) { add(factor, std::move(shape), std::vector{columns}); }
  /// The same, but functions of something else too, or of what another recording does not share.
  void add_joint(Factor factor, std::string shape, const std::vector<Matrix>& variants) { append(factor, std::move(shape), variants, false); }
  void add_joint(Factor factor, std::string shape, const Matrix& columns) { add_joint(factor, std::move(shape), std::vector{columns}); }

  void append(Factor factor, std::string shape, const std::vector<Matrix>& variants, bool of_one_factor) {
    Explanation e;
    e.of_one_factor = of_one_factor;
    e.name = "OTHER " + std::string(abbe::diagnose::name(factor)) + ", " + shape;
    e.factor = factor;
    e.shape = std::move(shape);
    for (const Matrix& columns : variants) {
      Block block;
      block.explanation = static_cast<int>(out_.list.size());
      block.signature = compressed(columns);
      block.columns.assign(static_cast<std::size_t>(block.signature.cols()), {});
      block.joined = true;
      e.blocks.push_back(static_cast<int>(out_.blocks.size()));
      out_.blocks.push_back(std::move(block));
    }
    share_belief(e, out_.blocks);
    out_.list.push_back(std::move(e));
  }

  Explanations& out_;
  std::vector<Vec3> normal_;
  std::vector<Vec3> normal_on_part_;
  Points time_, touch_, place_, directions_, on_probe_, travel_, reading_[3], settled_, clamped_;
  bool oblique_ = false;          ///< some approaches are not along the normal
  std::vector<int> orientation_, sensor_, feature_, setup_, run_, speed_;
  Vector part_above20_, scale_above20_[3];
};

}  // namespace

std::string_view name(Factor f) {
  constexpr std::string_view names[] = {"time", "position", "direction", "head", "sensor", "setup", "feature", "run", "temperature", "speed"};
  return names[static_cast<int>(f)];
}

void add_other(const RecordedTouches& t, const std::vector<int>& rows, Explanations& out) { Patterns(t, rows, out).add_all(); }

}  // namespace abbe::diagnose
