#include "lang/compile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>

#include "engine/base/utf8.hpp"
#include "lang/directives.hpp"
#include "lang/flow.hpp"
#include "lang/follow_up.hpp"
#include "lang/lines.hpp"
#include "lang/lowering.hpp"
#include "lang/parser.hpp"
#include "lang/statement.hpp"

namespace abbe::lang {

namespace {

constexpr std::size_t kLongestLabel = 64;
/// Free text begins with short words that are near to a word of DMIS by chance.
constexpr std::size_t kShortestSlip = 4;

bool in_label(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || static_cast<unsigned char>(c) >= 0x80 ||
      std::string_view("_-.+").find(c) != std::string_view::npos;
}

/// Drives the statements of one file through lookup, signature and lowering.
class Compiler {
 public:
  Compiler(const SourceFile& source, Sink& sink, const CompileOptions& options)
      : lowering_(source, sink), given_(options.answers), impossible_(options.impossible) {
    for (const auto& [name, answer] : given_) lowering_.answers[upper(name)] = answer;
    lowering_.only_valid = options.only_valid;
  }

  /// Throws Restart (flow.hpp).
  Compilation run(Moving& moving) {
    lowering_.out.plan.name = lowering_.source.name();
    std::vector<LogicalLine> lines = logical_lines(lowering_.source);
    for (const LogicalLine& line : lines) read_directives(line, lowering_);
    lowering_.answers.insert(lowering_.out.directives.answers.begin(), lowering_.out.directives.answers.end());
    Routine program = make_routine(lowering_.source, std::move(lines), lowering_);
    Flow(lowering_, moving, [this](const RawStatement& raw) { one(raw); }).run(program);
    for (int at = 0; at < program.size(); ++at)
      if (!program.visited[static_cast<std::size_t>(at)] && !program[at].skipped) never_run(program[at].raw);
    finish(program.size() == 0);
    return std::move(lowering_.out);
  }

 private:
  void one(const RawStatement& raw) {
    lowering_.statement = &raw;
    lowering_.failed = false;
    if (!raw.usable && !raw.missing_slash) lowering_.fail("the statement is not complete");
    std::string_view word = raw.word;
    if (raw.target) {
      outside(raw);
    } else if (const Statement* statement = find_statement(raw.word)) {
      known(*statement, raw);
    } else if (is_standard_word(raw.word)) {
      if (!outside(raw)) {
        not_supported(raw.word, raw.word_span, sets_frame(raw));
        if (sets_frame(raw)) lowering_.fail(fmt::format("{} is not supported yet", raw.word));
        if (raw.word == "PAMEAS" && lowering_.measuring) lowering_.measuring->scan = {raw.span, raw.line};
        if (raw.label) lowering_.skipped_labels.insert(raw.label->kind);
      }
    } else {
      meant_ = outside(raw) ? "" : unknown(raw);
      word = meant_;
    }
    if (lowering_.failed) {
      follow_up(lowering_, raw, word);
    } else if (raw.label) {
      lowering_.symbols.spoilt.erase(spoilt_key(raw.label->kind, raw.label->name));
    }
    lowering_.statement = nullptr;
  }

  /// A statement on a path that nothing takes: words can be checked, what they mean depends on the path.
  void never_run(const RawStatement& raw) {
    lowering_.statement = &raw;
    if (!raw.target && !is_standard_word(raw.word) && !find_statement(raw.word)) unknown(raw);
    lowering_.statement = nullptr;
  }

  /// True for statements that are not part of the plan: in a skipped region, or after the end of
  /// the program.
  bool outside(const RawStatement& raw) {
    if (lowering_.skipping) return true;
    if (lowering_.end_line == 0 && !lowering_.second_program) return false;
    const bool asks = raw.word == "OUTPUT" || raw.word == "EVAL";
    if (lowering_.second_program && asks) lowering_.fail("it belongs to a second program in the file");
    if (!lowering_.second_program && !after_end_reported_) {
      lowering_.warn(Code::W0224, raw.word_span, fmt::format("the program ended in line {}", lowering_.end_line),
                     "move ENDFIL to the end; what follows it is ignored");
      after_end_reported_ = true;
    }
    return true;
  }

  void known(const Statement& statement, const RawStatement& raw) {
    const bool switches = statement.word == "DMESW", begins = statement.word == "DMISMN";
    if (!switches && !begins && outside(raw)) return;
    if (raw.missing_slash && statement.signature.empty())
      return lowering_.error(Code::E0108, *raw.missing_slash, fmt::format("{} takes no arguments", statement.word),
                             "a comment begins with $$", "");
    if (raw.missing_slash)
      return lowering_.error(Code::E0115, *raw.missing_slash, fmt::format("expected '/' after {}", statement.word),
                             fmt::format("for example: {}", statement.example),
                             fmt::format("/{}", lowering_.file->text(*raw.missing_slash)));
    if (!label_fits(statement, raw) || lowering_.failed) return;
    if (const auto match = lowering_.match(statement.signature, raw, statement.word, 0, statement.varying))
      lower(statement, raw, *match);
    if (begins && lowering_.failed && lowering_.begin_line != 0) lowering_.second_program = true;
  }

  void lower(const Statement& statement, const RawStatement& raw, const Match& match) {
    const auto impossible = lowering_.place ? impossible_.end() : impossible_.find(raw.span.begin);
    if (impossible != impossible_.end())
      return lowering_.error(Code::E0304, raw.span, "not even an error-free machine can do this: " + impossible->second,
                             "correct the statement, or what it works on");
    statement.lower(lowering_, raw, match);
    if (!lowering_.failed) settle(lowering_, raw);
    if (lowering_.failed || raw.arguments.empty() || raw.label) return;
    // For VALUE: what the statement sets, in the units of the program.
    const auto text = [&](const RawArgument& a) {
      for (const MatchedValue& v : match.values)
        if (v.span == a.span && v.type <= ValueType::integer && a.kind != RawArgument::Kind::number)
          return fmt::format("{}",
                             v.number /
                                 (v.type == ValueType::length      ? lowering_.units.mm_per_unit
                                      : v.type == ValueType::angle ? lowering_.units.rad_per_unit
                                                                   : 1));
      return a.text;
    };
    lowering_.settings.set(raw.word, text(raw.arguments.front()));
    if (raw.arguments.size() > 1)
      lowering_.settings.set(raw.word + "," + upper(raw.arguments.front().text), text(raw.arguments.back()));
  }

  void check_name(const LabelRef& label) {
    if (const std::size_t characters = count_characters(label.name); characters > kLongestLabel)
      lowering_.warn(Code::W0123, label.span, fmt::format("this label has {} characters", characters),
                     fmt::format("a controller may refuse more than {}", kLongestLabel));
    const auto foreign = std::find_if_not(label.name.begin(), label.name.end(), in_label);
    if (foreign != label.name.end() && !label.kind.empty())
      lowering_.warn(Code::W0128, label.span, fmt::format("the label {} holds '{}'", written(label), *foreign),
                     "a controller may refuse it; labels are made of letters, digits and _ - . +");
  }

  bool label_fits(const Statement& statement, const RawStatement& raw) {
    if (raw.label && raw.usable) check_name(*raw.label);
    const std::string given = !raw.label ? "" : raw.label->kind.empty() ? "=" : raw.label->kind;
    if (statement.label == "*" || given == statement.label) {
      if (!raw.label || !raw.label->name.empty()) return true;
      lowering_.error(Code::E0109, raw.label->span, "this label is empty", "write a name between the parentheses");
      return false;
    }
    lowering_.error(Code::E0109, raw.label ? raw.label->span : raw.word_span,
                    statement.label.empty() ? fmt::format("{} takes no label", statement.word)
                        : statement.label == "="
                        ? fmt::format("{} needs a variable before it: X={}/...", statement.word, statement.word)
                        : fmt::format("{} needs a label {}(name)", statement.word, statement.label),
                    fmt::format("for example: {}", statement.example));
    return false;
  }

  /// Each word is named once: a program may use it a thousand times.
  void not_supported(const std::string& what, Span span, bool sets_frame) {
    if (!lowering_.reported_words.insert(what).second) return;
    lowering_.warn(Code::W0121, span, fmt::format("{} is not supported yet and is skipped wherever it stands", what),
                   what == "PAMEAS" ? "its MEAS has the touches of its PTMEAS, or else the default ones"
                       : sets_frame
                       ? "what is measured and evaluated after it is lost, up to a RECALL, DATSET/MCS or DATSET/TRMATX"
                       : "results are those of a program without it");
  }

  /// The word that was probably meant, or "". A loop may hold the slip in each of its turns: it is looked up once.
  const std::string& meant_by(const std::string& word) {
    const auto [found, is_new] = meant_by_.try_emplace(word);
    if (is_new) found->second = nearest_word(word, {standard_words().begin(), standard_words().end()});
    return found->second;
  }

  /// Reports the word; the word that was probably meant, or "".
  std::string unknown(const RawStatement& raw) {
    const std::string& near = meant_by(raw.word);
    if (raw.missing_slash && (near.empty() || raw.word.size() < kShortestSlip)) {
      lowering_.error(Code::E0101, raw.span, fmt::format("'{}' is not a statement", lowering_.file->text(raw.span)),
                      "a statement is WORD/argument,argument; a comment begins with $$");
      lowering_.failed = false;  // free text takes nothing away
      return "";
    }
    lowering_.error(Code::E0110, raw.word_span, fmt::format("{} is not a word of DMIS", raw.word),
                    near.empty() ? "`abbe explain` lists the words; a comment begins with $$"
                                 : fmt::format("did you mean {}?", near),
                    near);
    return near;
  }

  void finish(bool empty) {
    const std::uint32_t end = static_cast<std::uint32_t>(lowering_.source.text().size());
    const Span last{end > 0 ? end - 1 : 0, end};
    if (lowering_.measuring) {
      const OpenMeasure& block = *lowering_.measuring;
      lowering_.sink.add(diagnostic_at(lowering_.source, block.place, Code::E0205, "this MEAS has no ENDMES",
                                       "end the measurement with ENDMES"));
    }
    if (lowering_.external_files)
      lowering_.sink.add(diagnostic_at(lowering_.source, *lowering_.external_files, Code::E0117,
                                       "this XTERN has no ENDXTN", "end the list of external files with ENDXTN"));
    if (lowering_.begin_line == 0 && !lowering_.out.plan.operations.empty())
      lowering_.warn(Code::W0226, {0, 1}, "the program has no DMISMN", "begin it with DMISMN/'name',5.2");
    if (lowering_.end_line == 0 && (lowering_.begin_line != 0 || empty))
      lowering_.warn(Code::W0225, last, "the program has no ENDFIL", "end it with ENDFIL");
    check_expectations(lowering_);
    for (const auto& [name, answer] : given_) check_asked(name);
  }

  /// Only answers of the command line: those of the program may be meant for another path through it.
  void check_asked(const std::string& name) {
    if (lowering_.asked.contains(upper(name))) return;
    const std::string near = nearest_word(name, {lowering_.asked.begin(), lowering_.asked.end()});
    Diagnostic d = diagnostic(
        Code::W0263, fmt::format("the program does not ask for {}: its answer is not used", name),
        near.empty() ? "the name is that of the variable before =PROMPT/" : fmt::format("did you mean {}?", near));
    d.file = lowering_.source.name();
    lowering_.sink.add(std::move(d));
  }

  Lowering lowering_;
  const std::map<std::string, std::string>& given_;         ///< CompileOptions::answers
  const std::map<std::uint32_t, std::string>& impossible_;  ///< likewise
  std::string meant_;
  std::map<std::string, std::string> meant_by_;
  bool after_end_reported_ = false;
};

}  // namespace

Compilation compile(const SourceFile& source, Sink& sink, const CompileOptions& options) {
  for (Moving moving;;) {
    Sink found;
    try {
      Compilation out = Compiler(source, found, options).run(moving);
      for (const Diagnostic& d : found.list()) sink.add(d);
      return out;
    } catch (const Restart&) {  // with more moving jumps
    }
  }
}

}  // namespace abbe::lang
