// The state of a compilation while statements are lowered to the plan, one after the other.
//
// Plain data with a few members that every statement needs: messages at a place, labels, operands,
// operations. A label binds to the definition in force where it is used, so a label defined again
// leaves earlier uses alone.
//
// What an error takes away is followed up, because a result that silently lacks a touch or an
// alignment is worse than none:
//   - a statement with an error makes the label it would have defined *spoilt*; uses of a spoilt
//     label give no further message
//   - an error inside MEAS..ENDMES spoils the feature that is measured there
//   - an error in a statement that sets the coordinate system, the units or the sensor casts a
//     *doubt* on everything measured and evaluated until the next statement that sets it completely
//   - an error in a setting, which says how touches are made, compensated or fitted, casts one on
//     what is measured until the next statement that sets the same
//   - an error in a word of control casts one on all that follows
// An OUTPUT or EVAL of something spoilt or in doubt is entered in Compilation::lost with the line
// to blame.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "lang/compile.hpp"
#include "lang/parser.hpp"
#include "lang/shared_map.hpp"
#include "lang/signature.hpp"
#include "lang/units.hpp"
#include "lang/variables.hpp"

namespace abbe::lang {

/// One argument of a FEAT, TOL or SNSDEF statement, as OBTAIN counts and reads them.
struct FormItem {
  std::string text;  ///< as written
  std::string name;  ///< of a number, or of a choice of words, in the signature
  bool is_number = false;
  ValueType type{};
  plan::Operand operand;  ///< mm, rad or as written
};

/// The arguments of a statement from its first on; `match` names those that a signature matched.
std::vector<FormItem> written_form(const RawStatement&, const Match&);

/// The tolerance stays as it was written until OUTPUT or EVAL names it: datums may be bound after
/// TOL.
struct ToleranceSymbol {
  const ToleranceKind* kind = nullptr;
  Match match;
  int line = 0;  ///< of the program
  std::string label;
  /// By the features that its labels meant. All paths share them: the same meaning is the same tolerance. A
  /// definition that changes the meaning of the label has its own, so they also say which tolerance this is.
  std::shared_ptr<std::map<std::vector<int>, plan::ToleranceId>> instances;
  std::vector<FormItem> form;
};

/// Whether a feature has been measured or constructed at this place of the program.
struct ActualState {
  bool present = false;
  std::string spoilt;  ///< why what was measured is of no use; empty while it is
};

/// A MEAS block that is open.
struct OpenMeasure {
  plan::FeatureId feature;  ///< not valid when the block has an error in its MEAS statement
  int declared = 0, touches = 0;
  std::size_t first_operation = 0;
  Span span, count_span;
  Span place;  ///< in the program (Lowering::here)
  int line = 0;
  std::string spoilt;                        ///< why the measurement is of no use; empty while it is
  bool varies = false;                       ///< how many touches it has depends on what is measured
  std::optional<std::pair<Span, int>> scan;  ///< PAMEAS: place and line
  std::optional<plan::Point> displaced;      ///< RMEAS: by how much the touches lie beside their points
};

/// SNSMNT in force.
struct Mount {
  Vec3 offset_mm;
  double turn_rad = 0;

  bool operator==(const Mount&) const = default;
};

/// What one statement sets for others that come after it. Where paths meet that differ in it, which one holds depends on
/// what is measured, and nothing may use it until it is set again. What a loop of the plan uses before it sets it must
/// be on every turn what it was on the first, because the loop is lowered once.
template <class T>
struct Setting {
  T value{};
  bool varies = false;   ///< depends on what is measured
  bool carried = false;  ///< into a loop: on later turns it is what the loop leaves
  int relied_on = 0;     ///< how often it was used while it was carried

  void set(T now) {
    value = std::move(now);
    varies = carried = false;
  }
};

/// Labels, folded to upper case. `spoilt` holds "F:NAME" and the reason why the label cannot be used;
/// `ambiguous` holds labels that mean different things on paths that have met, in the same form.
struct Symbols {
  template <class Meaning>
  using Labels = SharedMap<std::string, Meaning>;
  Labels<plan::FeatureId> features, datums;
  Labels<plan::FrameId> frames;
  Labels<plan::SensorId> sensors;
  Labels<ToleranceSymbol> tolerances;
  Labels<std::string> spoilt;
  std::set<std::string> ambiguous;
};

/// What holds at a place of the program. Where machines may part at a condition it is kept and restored, so
/// that each path is lowered from the same beginning, and merged where they meet (flow_merge.cpp).
struct State {
  Units units;
  Symbols symbols;
  SharedMap<int, ActualState> actuals;              ///< by FeatureId
  SharedMap<int, plan::ToleranceId> size_of;        ///< by FeatureId: the tolerance of size evaluated of it last
  std::map<Shape, Setting<FitCriterion>> criteria;  ///< GEOALG; a shape without an entry: least squares
  std::optional<OpenMeasure> measuring;
  bool sensor_selected = false;
  bool home_known = false;  ///< FROM on some path
  Setting<std::optional<Mount>> mount;
  Setting<bool> machine_chooses{true};                ///< MODE: touches of a block without PTMEAS
  std::string frame_doubt, unit_doubt, sensor_doubt;  ///< reason; empty when there is no doubt
  std::map<std::string, std::string> setting_doubts;  ///< reasons, by the setting: PRCOMP, GEOALG/CIRCLE
  std::string flow_doubt;  ///< an error in a statement of control: which statements run is unknown from there on
  Variables variables;
  /// What VALUE reads: by the word of a statement its first argument, by "WORD,FIRST" its last one; numbers that were
  /// converted in the units of the program.
  SharedMap<std::string, std::string> settings;
  bool reachable = true;  ///< false after a jump
};

/// While a program is lowered, jumps name labels; this one marks an operation that finish leaves out.
inline constexpr int kDropped = -1;

/// Whether a statement can use a number that depends on what is measured.
enum class Varying { refused, taken };

class Lowering : public State {
 public:
  Lowering(const SourceFile& source_, Sink& sink_) : source(source_), sink(sink_), file(&source_) {}

  // ---- messages; an error makes the current statement fail
  void error(Code, Span, std::string message, std::string help = "", std::string replacement = "");
  void warn(Code, Span, std::string message, std::string help = "", std::string replacement = "");
  /// A message as it is, unless there was one of that code at that place: a loop repeats its statements, not
  /// its messages.
  void add(Diagnostic);
  /// The statement fails without a message of its own: an earlier error is to blame.
  void fail(std::string reason);

  // ---- arguments
  /// Matches arguments from `first` on; reports a mismatch as an error of `what`.
  std::optional<Match> match(std::string_view signature, const RawStatement&, std::string_view what,
                             std::size_t first = 0, Varying = Varying::refused);
  /// Values of a match for a kind of feature, tolerance or construction. Labels of features must
  /// have been measured; datums must be bound. Nothing after an error.
  std::optional<Arguments> arguments(const Match&);

  /// The numbers of a match that stand in columns, as the Arguments of the same match name them.
  static std::vector<plan::VaryingNumber> varying(const Match&);
  /// The value of an argument of the current statement; nothing after an error.
  std::optional<Value> value(const RawArgument&);
  /// Reports why an expression of the current statement has no value.
  void mistake(const Mistake&);

  /// The value of a setting for the statement at this place; nullptr after an error. `what` names it: MODE.
  template <class T>
  const T* use(Setting<T>& setting, std::string_view what, Span at) {
    if (setting.carried) ++setting.relied_on;
    if (setting.varies) refuse_varying(what, at);
    return setting.varies ? nullptr : &setting.value;
  }

  // ---- labels: nothing after an error or when spoilt
  std::optional<plan::FeatureId> defined_feature(const LabelRef&);
  std::optional<plan::FeatureId> feature(const LabelRef&);         ///< FA(x) as it is, F(x) as FEAT says
  std::optional<plan::FeatureId> actual_feature(const LabelRef&);  ///< measured or constructed
  std::optional<plan::FeatureId> datum(const LabelRef&);           ///< DAT(...), or the feature itself
  std::optional<plan::FrameId> frame(const LabelRef&);
  std::optional<plan::SensorId> sensor(const LabelRef&);
  const ToleranceSymbol* tolerance(const LabelRef&);
  /// SA(name) that no SNSDEF defined names a sensor of the machine file: defines it so.
  void sensor_of_machine_file(const LabelRef&);

  // ---- the plan
  /// The current statement, or the call of the module that it stands in: a place of the program, as plans have them.
  std::pair<Span, int> here() const;
  void emit(plan::Action);
  /// A new coordinate system under the label of the statement.
  plan::FrameId new_frame(const RawStatement&);
  /// The feature that a label stands for from here on. Where machines may have parted, definitions of one
  /// label and kind are one feature, so that the paths may meet again. `match` holds its arguments.
  void define(const RawStatement&, plan::FeatureDef, const Match& match);
  ActualState actual(plan::FeatureId) const;
  /// A column for the value of an expression, computed here.
  plan::ColumnId evaluated(const plan::Expression&);
  /// The columns that belong to `slot`, always the same ones.
  plan::ColumnId columns_of(const std::string& slot, int count);
  /// The one way from a matched number to an operand.
  static plan::Operand operand(const MatchedValue& value) { return {value.number, value.column}; }
  /// An operand as an expression, and back again.
  static plan::Expression expression(const plan::Operand&);
  plan::Operand operand(const plan::Expression&);
  /// A point given by radius, angle and height: the numbers `r`, `a`, `h` of the match.
  plan::Point polar(const Match&);
  /// Three numbers of the match that begin at the one named `first`.
  static plan::Point point(const Match&, std::string_view first);

  const SourceFile& source;
  Sink& sink;
  Compilation out;

  const SourceFile* file;  ///< that the current statement stands in: the program, or a module
  std::string call;        ///< where a macro or module was called, for messages; empty in the program itself
  std::optional<std::pair<Span, int>> place;  ///< of the call in the program, while a module is lowered
  Texts texts;
  std::vector<std::string> scopes;                    ///< prefixes of local variables, of the macros that are being run
  std::map<int, std::vector<FormItem>> forms;         ///< by FeatureId
  std::map<int, std::vector<FormItem>> sensor_forms;  ///< by SensorId, of those that the program defines
  std::map<std::string, std::string> answers;         ///< to PROMPT, by variable in upper case
  std::set<std::string> asked;                        ///< by PROMPT: variables in upper case
  int parted = 0;                                     ///< conditions that machines may have decided differently here
  int parting = 0;                                    ///< counts the places where machines part while all were together
  int looping = 0;                                    ///< loops around here whose turns differ from machine to machine
  bool only_valid = false;                            ///< CompileOptions
  bool second_program = false;                        ///< the program has ended and another begins in the same file

  bool skipping = false;                 ///< DMESW/OFF
  int begin_line = 0, end_line = 0;      ///< of DMISMN and ENDFIL; 0 before them
  std::optional<Span> external_files;    ///< the XTERN whose list is open
  std::set<std::string> reported_words;  ///< words warned about once
  std::set<std::string> skipped_labels;  ///< kinds of labels that skipped statements had: PN of PN(1)=PARTID/...
  std::vector<Span> expectation_spans;   ///< of Directives::expectations

  // ---- of the current statement
  bool failed = false;
  std::string failure;   ///< the first reason
  int failure_line = 0;  ///< where its message points: ENDMES may complain of its MEAS
  const RawStatement* statement = nullptr;

  /// The first doubt that holds now and why, or "".
  std::string doubt() const;
  /// The same for what is measured here.
  std::string measuring_doubt() const;
  /// Why the current statement failed, as the cause of what follows from it: "line 12: MESSAGE".
  std::string blame() const;

 private:
  void refuse_varying(std::string_view setting, Span);
  void warn_of_lengths(const Match&);
  template <class Meaning>
  const Meaning* find(const Symbols::Labels<Meaning>&, std::string_view kind, const LabelRef& label,
                      std::string_view next_step);

  std::map<std::string_view, Signature> signatures_;  ///< parsed once; signature texts are static
  std::map<std::string, plan::ColumnId> columns_;     ///< by slot
  std::map<int, plan::FeatureId> nominals_;           ///< by FeatureId: what F(x) is where FA(x) may stand
  std::map<std::pair<std::string, int>, plan::FeatureId> features_of_paths_;  ///< by label and parting
  std::set<std::tuple<Code, const SourceFile*, std::uint32_t>> reported_;
};

/// "FA(X) is not measured <- line 12: a comma is missing": a reason and its cause, which may have a
/// cause itself. Long chains keep their end, the mistake to be corrected, so that a program whose
/// every line follows from the one before needs no more memory than any other.
std::string chain(std::string consequence, std::string_view cause);

/// Folded key for Symbols::spoilt: F and FA, T and TA, D and DA, S and SA share their names.
std::string spoilt_key(std::string_view kind, std::string_view name);

}  // namespace abbe::lang
