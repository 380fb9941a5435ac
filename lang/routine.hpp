// The statements of a program, a macro or a module, and the blocks that they form.
//
// Blocks are found once, before anything is lowered, so that each mistake in them is reported at its own
// place together with the place where the block was opened: an ENDDO that closes an IF, an IF that nothing
// closes.
//
// A macro is expanded as text: its dummy arguments are replaced in a copy of its lines, and the copy is read
// like any other lines. Every byte of the copy still knows its place in the file.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "lang/lowering.hpp"
#include "lang/statement.hpp"

namespace abbe::lang {

/// One statement and its place among the blocks. Indices into Routine::lines; -1 for none.
struct Line {
  RawStatement raw;
  Control control = Control::none;
  int partner = -1;  ///< of a word that opens: where its block ends; of IF the ELSE if there is one, and so on to ENDIF
  int parent = -1;   ///< the word that opened the innermost block around it; of statements after ELSE that ELSE
  bool skipped = false;     ///< between DMESW/OFF and DMESW/ON
  std::size_t logical = 0;  ///< index into Routine::text
};

struct Routine {
  const SourceFile* file = nullptr;
  std::vector<LogicalLine> text;
  std::vector<Line> lines;
  std::map<std::string, int> targets;  ///< of jumps, by name in upper case
  std::vector<int> jumps;              ///< the lines with JUMPTO
  std::vector<char> visited;           ///< by line: it was lowered at least once

  int size() const { return static_cast<int>(lines.size()); }
  const Line& operator[](int line) const { return lines[static_cast<std::size_t>(line)]; }
  /// The last line of the block that `line` opens; `line` itself when it opens none.
  int end_of(int line) const;
  /// True when the block that `line` stands in, or one around it, is `block`; -1 is the routine itself.
  bool within(int line, int block) const;
};

/// Reads the lines; mistakes in blocks are errors and leave words that open or close nothing as Control::lost.
Routine make_routine(const SourceFile&, std::vector<LogicalLine>, Lowering&);

/// M(l)=MACRO/...: its lines, between MACRO and ENDMAC, and its dummy arguments.
struct Macro {
  std::string name;  ///< as written
  const SourceFile* file = nullptr;
  std::vector<LogicalLine> lines;
  std::vector<RawArgument> dummies;
};

/// The macro that the MACRO statement in this line defines.
Macro macro_at(const Routine&, int line);

/// How many characters the arguments of a call may add to one line of its macro, so that macros that hand them on
/// twice, as A+A, cannot fill the memory.
inline constexpr std::size_t kLongestArguments = 2'000;

/// The lines of the macro with actual arguments in place of its dummies; nothing when these are longer than
/// `kLongestArguments`. An expression without variables is replaced by its value. Precondition: as many actuals as
/// dummies.
std::optional<std::vector<LogicalLine>> expand(const Macro&, std::span<const RawArgument> actuals);

}  // namespace abbe::lang
