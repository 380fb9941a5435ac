#include "engine/diagnose/planning/alignment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/diagnose/planning/labels.hpp"
#include "engine/diagnose/planning/shape.hpp"

namespace abbe::diagnose {

namespace {

/// Some touches of one feature; `k` are those of the recording.
struct Face {
  std::string label;
  std::vector<std::size_t> k;
  Touched touched;
};

class Aligner {
 public:
  explicit Aligner(const Longer& longer) : longer_(longer), labels_(labels_of(longer)) {
    for (std::size_t k = longer.first; k < longer.touches.touches.size(); ++k) {
      const TouchScene& s = scene(k);
      for (Face* f : {&features_[s.feature], &everything_}) {
        f->k.push_back(k);
        f->touched.points.push_back(surface_of(longer, k));
        f->touched.normals.push_back(s.normal);
      }
    }
    for (auto& [which, f] : features_) f.label = of_its_own(labels_.features[static_cast<std::size_t>(which)]);
  }

  std::optional<Alignment> on_a_ball() {
    const std::optional<Ball> ball = ball_of(everything_.touched);
    if (!ball) return std::nullopt;
    const std::vector<std::size_t> chosen = apart();
    Face some;
    some.label = features_.size() == 1 ? features_.begin()->second.label : of_its_own("BALL");
    for (const std::size_t i : chosen) {
      some.k.push_back(everything_.k[i]);
      some.touched.points.push_back(everything_.touched.points[i]),
          some.touched.normals.push_back(everything_.touched.normals[i]);
    }
    if (!ball_of(some.touched)) return std::nullopt;
    measure(some.label, dmis_feature(some.touched), some.k);
    out_.statements += fmt::format("D(PART)=TRANS/XORIG,FA({0}),YORIG,FA({0}),ZORIG,FA({0})\n", some.label);
    out_.X_DR = {Mat3{}, -ball->centre};
    return out_;
  }

  std::optional<Alignment> on_faces() {
    for (const auto& [a, first] : features_) {
      if (!is_face(first.touched)) continue;
      const std::vector<std::size_t> three = widest_triangle(first.touched.points);
      if (three.size() < 3) continue;
      for (const auto& [b, second] : features_)
        if (const auto line = line_on(second, first)) {
          const Vec3 z = first.touched.normals[0], from = second.touched.points[line->first],
                     to = second.touched.points[line->second];
          const Vec3 x = unit(perpendicular_part(to - from, z)), y = cross(z, x);
          for (const auto& [c, third] : features_)
            if (is_face(third.touched) && std::abs(dot(third.touched.normals[0], x)) > kAcross)
              return aligned(first, three, second, *line, third, {x, y, z});
        }
    }
    return std::nullopt;
  }

 private:
  static constexpr double kAcross = 0.7, kNotAlong = 0.5, kLine_mm = 10;
  using Pair = std::pair<std::size_t, std::size_t>;

  const TouchScene& scene(std::size_t k) const { return longer_.touches.touches[k].scene; }

  /// Its touches are others than those of the feature that is measured then.
  std::string of_its_own(const std::string& label) const {
    std::string out = "ALIGN_" + label;
    while (std::find(labels_.features.begin(), labels_.features.end(), out) != labels_.features.end())
      out = "ALIGN_" + out;
    return out;
  }

  /// The two touches of a face that give the best direction across another face.
  static std::optional<Pair> line_on(const Face& face, const Face& other) {
    const Vec3 z = other.touched.normals[0];
    if (!is_face(face.touched) || std::abs(dot(face.touched.normals[0], z)) > kNotAlong) return std::nullopt;
    const std::vector<Vec3>& p = face.touched.points;
    Pair best{0, 0};
    double most = kLine_mm;
    for (std::size_t i = 0; i < p.size(); ++i)
      for (std::size_t j = 0; j < p.size(); ++j)
        if (const double apart = norm(perpendicular_part(p[j] - p[i], z)); apart > most) most = apart, best = {i, j};
    return best.first == best.second ? std::nullopt : std::optional(best);
  }

  Alignment aligned(const Face& a, const std::vector<std::size_t>& three, const Face& b, const Pair& line,
                    const Face& c, const Mat3& R_RD) {
    Touched plane;
    std::vector<std::size_t> k;
    for (const std::size_t i : three)
      plane.points.push_back(a.touched.points[i]), plane.normals.push_back(a.touched.normals[i]), k.push_back(a.k[i]);
    measure(a.label, dmis_feature(plane), k);
    out_.statements += fmt::format("DATDEF/FA({}),DAT(A)\n", a.label);
    const Vec3 from = b.touched.points[line.first], to = b.touched.points[line.second],
               n = b.touched.normals[line.first];
    measure(b.label,
            {"LINE",
             fmt::format("LINE,BND,CART,{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f}", from.x, from.y,
                         from.z, to.x, to.y, to.z, n.x, n.y, n.z)},
            {b.k[line.first], b.k[line.second]});
    out_.statements += fmt::format("DATDEF/FA({}),DAT(B)\n", b.label);
    measure(c.label, dmis_feature({{c.touched.points[0]}, {c.touched.normals[0]}}), {c.k[0]});
    out_.statements +=
        fmt::format("DATDEF/FA({}),DAT(C)\nD(PART)=DATSET/DAT(A),ZDIR,ZORIG,DAT(B),XDIR,YORIG,DAT(C),XORIG\n", c.label);
    const Vec3 origin{dot(R_RD.cx, c.touched.points[0]), dot(R_RD.cy, from), dot(R_RD.cz, plane.points[0])};
    out_.X_DR = {transpose(R_RD), -origin};
    return out_;
  }

  /// Touches with the stylus of the first one, each as far from those before it as there is.
  std::vector<std::size_t> apart() const {
    constexpr std::size_t kEnough = 6;
    const std::vector<Vec3>& n = everything_.touched.normals;
    std::vector<std::size_t> out{0};
    while (out.size() < kEnough) {
      std::size_t best = 0;
      double most = 0;
      for (std::size_t i = 0; i < n.size(); ++i) {
        if (scene(everything_.k[i]).stylus.tip_ordinal != scene(everything_.k[0]).stylus.tip_ordinal) continue;
        double least = 4;
        for (const std::size_t j : out) least = std::min(least, norm(n[i] - n[j]));
        if (least > most) most = least, best = i;
      }
      if (most == 0) break;
      out.push_back(best);
    }
    return out;
  }

  void measure(const std::string& label, const DmisFeature& feature, const std::vector<std::size_t>& k) {
    std::string measuring = begin_measuring(label, feature, k.size());
    std::string styli;
    for (const std::size_t i : k) {
      if (const std::string& tip = labels_.tips.at(scene(i).stylus.tip_ordinal); tip != stylus_) {
        stylus_ = tip;
        const std::string select = fmt::format(
            "TEXT/OPER,'drive to a clear place: the stylus is changed or turned to {0}'\nSNSLCT/SA({0})\n", stylus_);
        (i == k.front() ? styli : measuring) += select;
      }
      measuring += measure_point(surface_of(longer_, i), scene(i).normal);
    }
    out_.statements += styli + measuring + "ENDMES\n";
  }

  const Longer& longer_;
  std::map<int, Face> features_;
  Face everything_;
  Labels labels_;
  std::string stylus_;
  Alignment out_;
};

}  // namespace

std::optional<Alignment> alignment_of(const Longer& longer) {
  if (std::optional<Alignment> ball = Aligner(longer).on_a_ball()) return ball;
  return Aligner(longer).on_faces();
}

Vec3 surface_of(const Longer& longer, std::size_t touch) {
  const RecordedTouch& t = longer.touches.touches[touch];
  const RecordingRow& row = longer.recording.rows[t.row];
  return longer.recording.point == RecordedPoint::surface ? *row.target_mm
                                                          : *row.target_mm - t.scene.stylus.radius_mm * *row.normal;
}

}  // namespace abbe::diagnose
