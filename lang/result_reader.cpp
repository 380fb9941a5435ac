#include "lang/result_reader.hpp"

#include <fmt/format.h>

#include <sstream>

#include "engine/base/numbers.hpp"
#include "lang/lines.hpp"
#include "lang/parser.hpp"
#include "lang/signature.hpp"
#include "lang/units.hpp"

namespace abbe::lang {

namespace {

constexpr std::string_view kMatrix =
    "TRMATX, xi:number, xj:number, xk:number, yi:number, yj:number, yk:number, zi:number, zj:number, zk:number, "
    "tx:length, ty:length, tz:length";

class ResultReader {
 public:
  ResultReader(const SourceFile& source, Sink& sink) : source_(source), sink_(sink) {}

  DmisResult run() {
    for (const LogicalLine& line : logical_lines(source_)) {
      if (const auto raw = parse_statement(line, source_, sink_); raw && raw->usable) read(*raw);
      if (line.comment) read_uncertainty(line.comment->text());
    }
    return std::move(result_);
  }

 private:
  void read(const RawStatement& raw) {
    if (raw.word == "UNITS") return read_units(raw);
    if (!raw.label || raw.arguments.empty()) return;
    if (raw.label->kind == "FA" && raw.word == "FEAT") return read_feature(raw);
    if (raw.label->kind == "TA" && raw.word == "TOL") return read_value(raw);
    if (raw.label->kind == "DA" && raw.word == "DATSET" && raw.arguments[0].word == "TRMATX") return read_frame(raw);
  }

  void read_units(const RawStatement& raw) {
    for (const RawArgument& argument : raw.arguments) {
      units_.mm_per_unit = length_unit_mm(argument.word).value_or(units_.mm_per_unit);
      units_.rad_per_unit = angle_unit_rad(argument.word).value_or(units_.rad_per_unit);
    }
  }

  /// The arguments from `first` on by name; nothing after a message.
  std::optional<Match> matched(std::string_view signature, const RawStatement& raw, std::size_t first) {
    const std::span<const RawArgument> arguments = std::span(raw.arguments).subspan(first);
    auto made = match(parse_signature(signature), arguments, units_);
    if (Match* good = std::get_if<Match>(&made)) return std::move(*good);
    sink_.add(describe(std::get<Mismatch>(made), arguments, raw.word, first, raw.span, source_));
    return std::nullopt;
  }

  void unknown(const RawStatement& raw, std::string_view what) {
    sink_.add(diagnostic_at(source_, raw.arguments[0].span, Code::E0112,
                            fmt::format("'{}' is not a {} that is known here", raw.arguments[0].text, what),
                            "this result is passed over"));
  }

  void read_feature(const RawStatement& raw) {
    const FeatureKind* kind = find_feature_kind(raw.arguments[0].word);
    if (!kind) return unknown(raw, "kind of feature");
    const auto match = matched(kind->signature, raw, 1);
    if (!match) return;
    Arguments arguments;
    for (const MatchedValue& v : match->values)
      v.type <= ValueType::integer ? arguments.add_number(v.name, v.number) : arguments.add_text(v.name, v.text);
    const Outcome<Element> actual = kind->nominal(arguments);
    if (!actual) {
      sink_.add(diagnostic_at(source_, raw.span, Code::E0208,
                              fmt::format("this {} cannot be: {}", kind->word, actual.failure),
                              "this result is passed over"));
      return;
    }
    result_.features.push_back({raw.label->name, kind, actual.value, arguments.text("side") == "INNER", raw.line});
  }

  void read_value(const RawStatement& raw) {
    ResultValue v;
    v.label = raw.label->name, v.line = raw.line;
    v.kind = find_tolerance_kind(raw.arguments[0].word);
    if (!v.kind) return unknown(raw, "tolerance");
    const RawArgument* number = nullptr;
    bool judged = false;
    for (const RawArgument& a : std::span(raw.arguments).subspan(1)) {
      if (a.kind == RawArgument::Kind::number && !number) number = &a;
      if (a.kind != RawArgument::Kind::word) continue;
      if (a.word == "INTOL" || a.word == "OUTOL")
        judged = true, v.in_tolerance = a.word == "INTOL";
      else if (a.word != "NOMINL" && v.qualifier.empty())
        v.qualifier = a.word;
    }
    if (!number || !judged) {
      sink_.add(diagnostic_at(source_, raw.span, Code::E0507,
                              fmt::format("TA({}) has no value or no INTOL or OUTOL", v.label),
                              "this result is passed over"));
      return;
    }
    Arguments axis;
    if (!v.qualifier.empty()) axis.add_text("axis", v.qualifier);
    const double unit = unit_of(*v.kind, axis) == Unit::mm ? units_.mm_per_unit : units_.rad_per_unit;
    v.value = number->number * unit, v.last_digit = last_digit(number->text) * unit;
    result_.values.push_back(std::move(v));
  }

  void read_frame(const RawStatement& raw) {
    const auto match = matched(kMatrix, raw, 0);
    if (!match) return;
    const auto vector = [&](std::size_t k) {
      return Vec3{match->values[k].number, match->values[k + 1].number, match->values[k + 2].number};
    };
    result_.frames.push_back({raw.label->name, {{vector(0), vector(3), vector(6)}, vector(9)}, raw.line});
  }

  /// `! u TA(LEN) 0.00052 lcl -0.00101 ucl 0.00104 conforms 0.98`, of the value read last.
  void read_uncertainty(const std::string& comment) {
    if (result_.values.empty() || !comment.starts_with("! u TA(")) return;
    const std::size_t end = comment.find(") ");
    if (end == std::string::npos || comment.substr(7, end - 7) != result_.values.back().label) return;
    std::istringstream in(comment.substr(end + 2));
    ResultUncertainty read;
    std::string lcl, ucl, conforms;
    double probability = 0;
    if (!(in >> read.u >> lcl >> read.lcl >> ucl >> read.ucl) || lcl != "lcl" || ucl != "ucl") return;
    if (in >> conforms >> probability && conforms == "conforms") read.conformance = probability;
    result_.values.back().uncertainty = read;
  }

  const SourceFile& source_;
  Sink& sink_;
  Units units_;
  DmisResult result_;
};

}  // namespace

DmisResult read_dmis_result(const SourceFile& source, Sink& sink) { return ResultReader(source, sink).run(); }

}  // namespace abbe::lang
