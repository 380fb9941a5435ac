// Control flow: IF, DO, SELECT, JUMPTO, MACRO, CALL and modules, lowered to the plan.
//
// The compiler follows the program as a controller would. What it can decide by itself costs nothing at run
// time: the branch that is taken, the turns of a DO, the body of a macro are written out, so labels may be
// computed and every turn has features of its own. Where a decision depends on what is measured, virtual
// machines may part; then both branches are lowered, a loop is lowered once, and jumps of the plan lead the
// machines (docs/architecture.md, "Running a plan").
//
// A jump that only some machines take is found while the program is lowered, but what lies between it and its
// target has to be lowered for parted machines from the start. So lowering goes on to the end, to find as
// many of these *moving* jumps as can be found, and then the program is lowered again; each time there is at
// least one more, and a program has finitely many.
#pragma once

#include <functional>
#include <memory>
#include <set>
#include <type_traits>
#include <utility>

#include "lang/routine.hpp"

namespace abbe::lang {

/// Jumps that only some machines take: file and offset of the statement.
using Moving = std::set<std::pair<std::string, std::uint32_t>>;
/// Thrown after `Moving` has grown.
struct Restart {};

/// Thrown inside Flow to give up a program that is too long or too deep; the message is in the sink.
struct TooLong {};

/// How many statements a program may have when its loops, jumps and macros are written out.
inline constexpr int kMaximumStatements = 200'000;
/// How deep macros and modules may call each other.
inline constexpr int kMaximumCalls = 32;
/// How deep blocks, cases of a SELECT and what macros and modules hold may be nested in all, so that no input
/// can exhaust the stack. `kMaximumNesting` of the parser does the same for parentheses.
inline constexpr int kMaximumDepth = 256;
/// A DO with more turns than this is a loop of the plan: its labels cannot be computed then.
inline constexpr int kMaximumTurns = 1000;

/// Gives a variable another value and, however the block ends, its own one back. What Flow leaves in Lowering outlives
/// it and the modules that it has read.
template <class T>
class Changed {
 public:
  Changed(T& variable, std::type_identity_t<T> value)
      : variable_(variable), before_(std::exchange(variable, std::move(value))) {}
  ~Changed() { variable_ = std::move(before_); }
  Changed(const Changed&) = delete;
  Changed& operator=(const Changed&) = delete;

 private:
  T& variable_;
  T before_;
};

class Flow {
 public:
  /// `ordinary` lowers a statement that is no word of control.
  Flow(Lowering&, Moving&, std::function<void(const RawStatement&)> ordinary);

  /// Lowers a whole program. Throws Restart.
  void run(Routine&);

 private:
  using Jump = std::optional<int>;  ///< the line that a jump leads to, out of what was lowered
  using Body = std::function<Jump()>;
  struct Step {
    int next;
    Jump jump;
  };
  struct Interval {
    int first, last;
  };
  /// A target that machines jump to while they are parted.
  struct Target {
    int label;
    VariableNames names;          ///< what may change in its region
    std::optional<State> passed;  ///< what held when it was lowered
    std::vector<State> arrivals;  ///< of jumps forward to it
  };
  /// Counts how deep what is lowered is nested, while it lives. Throws TooLong.
  class Deeper {
   public:
    explicit Deeper(Flow& flow) : flow_(flow) { flow_.deepen(); }
    ~Deeper() { --flow_.nesting_; }
    Deeper(const Deeper&) = delete;
    Deeper& operator=(const Deeper&) = delete;

   private:
    Flow& flow_;
  };
  struct Module {
    std::unique_ptr<SourceFile> file;
    std::vector<LogicalLine> lines;
  };

  // flow.cpp
  Jump range(int begin, int end, int level);
  Step step(int at);
  void count();
  void deepen();
  std::optional<Match> matched(const RawStatement&);
  void failed_control();
  void lose(int begin, int end);
  void ordinary(const Line&);
  RawStatement with_labels(const RawStatement&);
  void resolve(LabelRef&, std::size_t begin);
  std::string label_text(const LabelRef&, const Value&);
  void part();
  void meet() { --lowering_.parted; }
  int new_label();
  void place(int label) {
    positions_[static_cast<std::size_t>(label)] = static_cast<int>(lowering_.out.plan.operations.size());
  }
  void finish_plan();

  // flow_blocks.cpp
  Step lost(int at, int end);
  Step condition(int at);
  Step loop(int at);
  Jump written_out(int at, const std::string& variable, double first, double step, double last);
  void rolled(int at, const std::string& variable, const Match&);
  Step choice(int at);
  Jump choose(const std::vector<int>& cases, std::size_t first, int fallback, const Value& value);
  std::optional<plan::Expression> case_condition(int at, const Value& value);
  bool set(const std::string& variable, const Value&);
  void check_measurement(const State& other);
  void branch(int begin, int end, plan::Expression condition, const Body& then, const Body& otherwise);

  // flow_jumps.cpp
  Step jump(int at);
  std::vector<Interval> moving_intervals(int level) const;
  static std::optional<Interval> region_at(int at, const std::vector<Interval>&);
  int opener_of(int otherwise) const;
  void region(Interval, std::optional<int> entry);
  void arrive(int at, const VariableNames&, const State& before);
  void check_same_meaning(const State& passed);

  // flow_calls.cpp
  void define_macro(int at);
  void call(int at);
  void call_macro(const LabelRef&, std::span<const RawArgument> actuals);
  void warn_of_variable(const Macro&, const std::string& dummy, const RawArgument& actual);
  void module(int at);
  void run_module(const RawArgument& name, bool only_macros);
  Module* load(const RawArgument& name);
  Routine read_routine(const SourceFile&, std::vector<LogicalLine>, const std::string& where);
  void inside(Routine&, const std::string& where, const std::string& scope);
  VariableNames assigned(int begin, int end) const;
  void add_assigned(const RawStatement&, VariableNames&, std::set<std::string>& macros) const;

  Lowering& lowering_;
  Moving& moving_;
  std::function<void(const RawStatement&)> lower_ordinary_;
  Routine* routine_ = nullptr;
  std::map<int, Target> targets_;  ///< of the routine, by line
  std::vector<int> positions_;     ///< of labels, operations; -1 before they are placed
  std::map<std::string, Macro> macros_;
  std::map<std::string, Module> modules_;  ///< by path
  int statements_ = 0, calls_ = 0, depth_ = 0, nesting_ = 0;
  bool again_ = false;  ///< there are more moving jumps than were known
};

/// Where two paths meet: what holds on either of them, and what cannot be told any more.
void merge(State& into, const State& other);

/// At the top of a loop that is lowered once: the settings are those of the way in.
void carry_settings(State&);

}  // namespace abbe::lang
