#include "engine/diagnose/planning/program.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "engine/base/numbers.hpp"
#include "engine/diagnose/planning/alignment.hpp"
#include "engine/diagnose/planning/labels.hpp"
#include "engine/diagnose/planning/path.hpp"
#include "engine/diagnose/planning/shape.hpp"
#include "engine/run/motion.hpp"
#include "engine/workpiece/workpiece.hpp"

namespace abbe::diagnose {

namespace {

/// The setups of the new touches, in the order of measuring.
std::vector<int> new_setups(const Longer& longer) {
  std::vector<int> out;
  for (std::size_t k = longer.first; k < longer.touches.touches.size(); ++k) {
    const int setup = longer.touches.touches[k].scene.setup;
    if (std::find(out.begin(), out.end(), setup) == out.end()) out.push_back(setup);
  }
  return out;
}

/// The last setup of the first recording: new ones count on from it.
int last_setup(const Longer& longer) {
  int last = 0;
  for (std::size_t k = 0; k < longer.first; ++k) last = std::max(last, longer.touches.touches[k].scene.setup);
  return last;
}

/// Which setup of the first recording is repeated as this one.
int setup_before(const Longer& longer, int setup) {
  const int last = last_setup(longer);
  return setup > last ? setup - last : setup;
}

/// Whether the part is still as the first recording left it.
bool stays_put(const Longer& longer, int setup) { return setup <= last_setup(longer); }

double distance_said(const Recording& r, std::string_view key, double usual) {
  const std::optional<std::string> text = said(r.metadata, key);
  return text ? finite_number(*text).value_or(usual) : usual;
}

class Writer {
 public:
  Writer(const Case& c, const Change& change, const Longer& longer)
      : case_(c),
        change_(change),
        longer_(longer),
        path_(path_of(longer)),
        touches_(longer.touches.touches),
        labels_(labels_of(longer)) {
    find_blocks();
    setups_ = new_setups(longer);
    X_DW_ = {Mat3{}, surface_of(longer, longer.first) - scene(longer.first).point};
  }

  std::string program() {
    heading();
    styli();
    settings();
    set_motion(longer_.first);
    place_part();
    out_ += "MODE/PROG,MAN\n";
    for (const Step& step : path_.steps) {
      switch (step.kind) {
        case Step::Kind::go: go(step.to); break;
        case Step::Kind::stylus: select(step.touch); break;
        case Step::Kind::touch: touch(step.touch); break;
      }
    }
    return out_ + "ENDFIL\n";
  }

 private:
  const TouchScene& scene(std::size_t k) const { return touches_[k].scene; }
  const std::string& feature_label(std::size_t k) const {
    return labels_.features[static_cast<std::size_t>(scene(k).feature)];
  }
  const RecordingRow& row(std::size_t k) const { return longer_.recording.rows[touches_[k].row]; }

  /// Touches that one MEAS holds: of one feature, stylus and placement, and numbered on.
  void find_blocks() {
    for (std::size_t k = longer_.first; k < touches_.size(); ++k) {
      const bool begins = k == longer_.first || row(k).feature != row(k - 1).feature ||
          row(k).setup != row(k - 1).setup || scene(k).stylus.tip_ordinal != scene(k - 1).stylus.tip_ordinal ||
          (change_.reversed ? row(k).touch >= row(k - 1).touch : row(k).touch <= row(k - 1).touch);
      if (begins) blocks_[k] = k;
      std::prev(blocks_.end())->second = k;
    }
  }

  void say(const std::string& text) { out_ += "$$ " + text + "\n"; }
  void tell_operator(const std::string& text) { out_ += "TEXT/OPER,'" + text + "'\n"; }

  void heading() {
    out_ += fmt::format("DMISMN/'{}',5.2\nUNITS/MM,ANGDEC\n", change_.text);
    say("Paths are not checked for collision: a recording shows touches, not what stands beside them. Let it run at reduced speed first.");
    say("Between features the tip goes out along the stylus, then up, across, down and in again; only up there styli change and the head turns.");
    constexpr double kLittle_mm = 0.1;
    if (path_.missing_mm > kLittle_mm)
      say(fmt::format(
          "ATTENTION: the travel of the machine ends {:.0f} mm too early for that. Where the head turns, and how a stylus comes out, must be looked at.",
          path_.missing_mm));
    say(recording_sentence(longer_));
    labels_to_put_back();
    touches_left_out();
    if (const auto part = said(longer_.recording.metadata, "workpiece"))
      say(fmt::format("Its points are those of the true part '{}', not those of the drawing.", *part));
    if (change_.instruction.empty()) return;
    say("Before it: " + change_.instruction);
    tell_operator(change_.instruction);
  }

  /// Features that DMIS cannot call as the recording does.
  void labels_to_put_back() {
    std::set<std::string> told;
    for (std::size_t k = longer_.first; k < touches_.size(); ++k)
      if (feature_label(k) != row(k).feature) told.insert(fmt::format("{} is '{}'", feature_label(k), row(k).feature));
    if (told.empty()) return;
    say("DMIS cannot hold some labels of the first recording. Put them back into the column 'feature' of the new one, or its touches are others:");
    for (const std::string& label : told) say(label);
  }

  /// What the stylus does not reach, and the numbers of those after it.
  void touches_left_out() {
    if (longer_.left_out == 0) return;
    say(fmt::format(
        "{} touches of the first recording are left out: they lie on sides that face away from the stylus then.",
        longer_.left_out));
    std::map<std::pair<std::string, int>, std::vector<int>> numbers;  // by feature and setup
    for (std::size_t k = longer_.first; k < touches_.size(); ++k)
      numbers[{feature_label(k), row(k).setup}].push_back(row(k).touch);
    for (const auto& [of, list] : numbers)
      if (list.back() != static_cast<int>(list.size()))
        say(fmt::format("What is touched here of {} are its touches {}: put these numbers into the column 'touch'.",
                        of.first, fmt::join(list, ", ")));
  }

  /// Definitions of all styli: the recording may know some that the machine file does not.
  void styli() {
    std::set<int> defined;
    for (std::size_t k = longer_.first; k < touches_.size(); ++k) {
      const StylusScene& s = scene(k).stylus;
      if (!defined.insert(s.tip_ordinal).second) continue;
      const std::string& label = labels_.tips.at(s.tip_ordinal);
      const auto named = longer_.machine.sensors.find(std::string(s.name));
      if (named == longer_.machine.sensors.end()) {
        if (defined.size() == 1) tell_assumed(s);
        out_ += definition(label, k, -s.length_mm * (transpose(s.R_WR) * s.to_head));
        continue;
      }
      if (label != s.name) say(fmt::format("{}: stylus '{}' of the first recording", label, s.name));
      out_ += definition(label, k, named->second.tip_in_r_mm);
    }
  }

  /// A stylus that no row names, where the machine has none or several.
  void tell_assumed(const StylusScene& s) {
    say(fmt::format("The recording does not name its stylus: its length, {:g} mm, and its ball, {:g} mm, are assumed.",
                    s.length_mm, 2 * s.radius_mm));
    say("Write what they were, here and in the recording: the surface points below are reckoned with that ball.");
  }

  /// INDEX knows styli along the last link of the head only; the arms of a star are offsets from the mount, and so are its
  /// others where the recording tells no angles.
  std::string definition(const std::string& label, std::size_t k, const Vec3& tip) {
    const StylusScene& s = scene(k).stylus;
    const double ball = 2 * s.radius_mm;
    const bool angles = row(k).head_a_deg.has_value(),
               turned = row(k).head_a_deg.value_or(0) != 0 || row(k).head_b_deg.value_or(0) != 0;
    if (s.indexed && is_straight(tip) && (angles || !has_star()))
      return fmt::format("S({})=SNSDEF/PROBE,INDEX,POL,{:.4f},{:.4f},0,0,-1,{:.4f},{:.4f}\n", label,
                         in_degrees(s.head_a_rad), in_degrees(s.head_b_rad), norm(tip), ball);
    if (s.indexed && turned)
      say(
          fmt::format("{}: the head stands at A {:.4f}, B {:.4f} deg; DMIS defines no star on a turned head, so it is "
                      "written as it stands.",
                      label, in_degrees(s.head_a_rad), in_degrees(s.head_b_rad)));
    const Vec3 offset = angles || !s.indexed ? s.tip_from_mount_mm : tip, along = -s.to_head;
    return fmt::format("S({})=SNSDEF/PROBE,FIXED,CART,{:.4f},{:.4f},{:.4f},{:.6f},{:.6f},{:.6f},{:.4f}\n", label,
                       offset.x, offset.y, offset.z, along.x, along.y, along.z, ball);
  }

  bool has_star() const {
    const auto& sensors = longer_.machine.sensors;
    for (std::size_t k = longer_.first; k < touches_.size(); ++k)
      if (const auto named = sensors.find(std::string(scene(k).stylus.name));
          named != sensors.end() && !is_straight(named->second.tip_in_r_mm))
        return true;
    return false;
  }

  void settings() {
    const Recording& r = longer_.recording;
    const MotionSettings usual = default_motion(longer_.machine);
    approach_mm_ = distance_said(r, "approach_mm", usual.approach_mm),
    retract_mm_ = distance_said(r, "retract_mm", usual.retract_mm);
    out_ += "PRCOMP/ON\n";
    const std::optional<std::string> compensation = said(r.metadata, "temperature_compensation");
    const bool by_file = case_.options.workpiece && case_.options.workpiece->compensated;
    if (compensation == "on" || by_file)
      out_ += "TECOMP/ON\n";
    else if (compensation == "off")
      out_ += "TECOMP/OFF\n";
    else
      say("The recording does not tell whether temperatures were compensated: set TECOMP as it was then.");
    if (!said(r.metadata, "approach_mm"))
      say("The recording does not tell how far from the surface a touch begins: SNSET is a usual one.");
    if (!moves(row(longer_.first).speed_mm_s))
      say("The recording does not tell how fast it was touched: set FEDRAT/MESVEL as it was then.");
  }

  /// The coordinate system: that of the recording, or of the part where it now stands.
  void place_part() {
    if (longer_.recording.in_part_frame)
      say("In part coordinates: align the part as for the first recording, and put its coordinate system in the place of the next line.");
    out_ += "D(0)=DATSET/MCS\n";
    if (!change_.move) return;
    const std::optional<Alignment> alignment = setups_.size() == 1 ? alignment_of(longer_) : std::nullopt;
    if (alignment) {
      say("Manual alignment on touches of its own (ALIGN_...), which are not for the diagnosis: their rows may be left out. Where they should lie is only a guide.");
      out_ += "MODE/MAN\n" + alignment->statements;
      tell_operator("drive the tip above the part, clear of everything");
      X_DW_ = alignment->X_DR * X_DW_;
      return;
    }
    const Rigid& X = *change_.move;
    say("Its touches do not make an alignment. The part must stand as this matrix says, to within the approach distance; or put your own");
    say("alignment here. The coordinates below are those that its points have in the first recording.");
    out_ += fmt::format(
        "D(PART)=DATSET/TRMATX,{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.6f},{:.6f},{:.6f}\n",
        X.R.cx.x, X.R.cx.y, X.R.cx.z, X.R.cy.x, X.R.cy.y, X.R.cy.z, X.R.cz.x, X.R.cz.y, X.R.cz.z, X.p.x, X.p.y, X.p.z);
    X_DW_ = inverse(X) * X_DW_;
  }

  void go(const Vec3& to) {
    const Vec3 p = X_DW_ * to;
    out_ += fmt::format("GOTO/{:.4f},{:.4f},{:.4f}\n", p.x, p.y, p.z);
  }

  void select(std::size_t k) { out_ += fmt::format("SNSLCT/SA({})\n", labels_.tips.at(scene(k).stylus.tip_ordinal)); }

  /// With a 0 that stands for what was not logged, no machine would move.
  static bool moves(const std::optional<double>& logged) { return logged && *logged > 0; }

  /// Settings that this touch has and the one before had not.
  void set(const char* statement, double value, double& before) {
    if (value == before) return;
    before = value;
    out_ += fmt::format("{},{:.6g}\n", statement, value);
  }

  /// How a touch is made.
  void set_motion(std::size_t k) {
    constexpr double kLeast_mm = 0.1;
    const double free_mm = std::max(kLeast_mm, path_.free_mm[k - longer_.first]);
    if (moves(row(k).speed_mm_s)) set("FEDRAT/MESVEL,MMPS", *row(k).speed_mm_s, speed_mm_s_);
    if (moves(row(k).accel_mm_s2)) set("ACLRAT/MESACL,MMPSS", *row(k).accel_mm_s2, acceleration_mm_s2_);
    set("SNSET/APPRCH", std::min(approach_mm_, free_mm), set_approach_mm_);
    set("SNSET/RETRCT", std::min(retract_mm_, free_mm), set_retract_mm_);
  }

  void touch(std::size_t k) {
    set_motion(k);
    const auto block = blocks_.find(k);
    if (block != blocks_.end()) begin(k, block->second);
    out_ += measure_point(on_part(k), X_DW_.R * scene(k).normal);
    if (std::prev(blocks_.upper_bound(k))->second == k)
      out_ += fmt::format("ENDMES\nOUTPUT/FA({})\n", feature_label(k));
  }
  Vec3 on_part(std::size_t k) const { return X_DW_ * scene(k).point; }

  void begin(std::size_t first, std::size_t last) {
    if (row(first).setup != setup_ && setups_.size() > 1)
      tell_operator(stays_put(longer_, row(first).setup)
                        ? fmt::format("leave the part as it stands, for setup {} of this recording", row(first).setup)
                        : fmt::format("put the part as in setup {} of the first recording, for setup {} of this one",
                                      setup_before(longer_, row(first).setup), row(first).setup));
    setup_ = row(first).setup;
    Touched touched;
    std::vector<int> numbers;
    bool as_recorded = true;
    for (std::size_t k = first; k <= last; ++k) {
      touched.points.push_back(on_part(k)), touched.normals.push_back(X_DW_.R * scene(k).normal);
      numbers.push_back(row(k).touch);
      as_recorded = as_recorded && numbers.back() == static_cast<int>(numbers.size());
    }
    const std::string& label = feature_label(first);
    if (label != row(first).feature) say(fmt::format("'{}' of the first recording", row(first).feature));
    if (!as_recorded) say(fmt::format("its touches are numbers {} of the first recording", fmt::join(numbers, " ")));
    out_ += begin_measuring(label, dmis_feature(touched), numbers.size());
  }

  const Case& case_;
  const Change& change_;
  const Longer& longer_;
  Path path_;
  const std::vector<RecordedTouch>& touches_;
  Labels labels_;
  std::map<std::size_t, std::size_t> blocks_;  ///< first and last touch of each
  Rigid X_DW_;
  double approach_mm_ = 0, retract_mm_ = 0;  ///< where there is room
  double speed_mm_s_ = -1, acceleration_mm_s2_ = -1, set_approach_mm_ = -1, set_retract_mm_ = -1;
  std::vector<int> setups_;  ///< in the order of measuring
  int setup_ = 0;
  std::string out_;
};

}  // namespace

std::string recording_sentence(const Longer& longer) {
  const std::vector<int> setups = new_setups(longer);
  const int first = setups.front(), anew = first + last_setup(longer);
  const bool stays = stays_put(longer, first);
  std::string out = fmt::format("Give its recording run {}", longer.recording.rows.back().run);
  if (setups.size() > 1) {
    out += fmt::format(" and setups {}, one for each placement in this order: ", fmt::join(setups, ", "));
    if (stays) out += fmt::format("{} only if the part is not touched before it, else {}. ", first, anew);
    return out + (stays ? "A" : "a") +
        " part that is put down anew stands elsewhere for the diagnosis, in the same place too.";
  }
  return out +
      (stays ? fmt::format(
                   ". The part must not be touched in between: if it was, or was left for hours, give setup {}.", anew)
             : fmt::format(" and setup {}: for the diagnosis the part stands elsewhere.", first));
}

std::string dmis_program(const Case& c, const Longer& longer, const Change& change) {
  return Writer(c, change, longer).program();
}

}  // namespace abbe::diagnose
