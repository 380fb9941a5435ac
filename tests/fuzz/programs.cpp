#include "tests/fuzz/programs.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "engine/features/construct.hpp"
#include "engine/features/feature.hpp"
#include "engine/tolerances/tolerance.hpp"
#include "lang/signature.hpp"
#include "lang/statement.hpp"

namespace abbe::fuzz {

namespace {

using lang::Signature;
using lang::SignatureItem;
using lang::ValueType;

class Generator {
 public:
  explicit Generator(std::mt19937& random) : random_(random) {}

  std::string program() {
    out_ =
        "DMISMN/'by "
        "chance',5.2\nUNITS/MM,ANGDEC\nS(A)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,100,4\nSNSLCT/S(A)\n"
        "D(A)=TRANS/XORIG,800,YORIG,500,ZORIG,-500\n";
    const std::size_t count = 3 + below(25);
    for (std::size_t i = 0; i < count; ++i) below(5) == 0 ? any_statement() : measured_feature();
    if (below(8) != 0) out_ += "ENDFIL\n";
    return std::move(out_);
  }

 private:
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_()) % n; }
  template <class List>
  const auto& one_of(const List& list) {
    return list[below(std::size(list))];
  }

  std::string number(int size) {
    static constexpr std::array kOdd = {"0", "-0", "1E-300", "1E300", ".5", "-1.", "999999999", "1", "0.0001", "-7"};
    if (below(12) == 0) return one_of(kOdd);
    return std::to_string(static_cast<int>(below(static_cast<std::size_t>(2 * size + 1))) - size);
  }

  std::string name() { return std::string(1, static_cast<char>('A' + below(4))); }

  std::string value(ValueType type) {
    switch (type) {
      case ValueType::number: return number(1);
      case ValueType::length: return number(50);
      case ValueType::angle: return number(180);
      case ValueType::integer: return std::to_string(below(6));
      case ValueType::text: return below(2) == 0 ? "'text'" : "'it''s $$ text'";
      case ValueType::feature: return (below(2) == 0 ? "FA(" : "F(") + name() + ")";
      case ValueType::datum: return "DAT(" + name() + ")";
      case ValueType::tolerance: return "TA(" + name() + ")";
      case ValueType::sensor: return "S(A)";
      case ValueType::frame: return "D(" + name() + ")";
      case ValueType::label: return "V(" + name() + ")";
      case ValueType::word: return one_of(feature_kinds())->word.data();
      case ValueType::condition:
        return below(8) == 0 ? "X .LT. 1" : number(3) + (below(2) == 0 ? " .LT. " : " .EQ. ") + number(3);
      case ValueType::value: return below(2) == 0 ? number(5) + "+" + number(5) : "'text'";
    }
    return "";
  }

  void arguments(const Signature& signature, std::vector<std::string>& out) {
    for (const SignatureItem& item : signature) {
      switch (item.kind) {
        case SignatureItem::Kind::words: out.push_back(one_of(item.words)); break;
        case SignatureItem::Kind::value: out.push_back(value(item.type)); break;
        case SignatureItem::Kind::optional:
          if (below(2) == 0) arguments(item.branches[0], out);
          break;
        case SignatureItem::Kind::repeat:
          for (std::size_t n = below(3); n > 0; --n) arguments(item.branches[0], out);
          break;
        case SignatureItem::Kind::alternatives: arguments(one_of(item.branches), out); break;
        case SignatureItem::Kind::rest: break;
      }
    }
  }

  void statement(const std::string& head, std::string_view signature, std::vector<std::string> written = {}) {
    arguments(lang::parse_signature(signature), written);
    out_ += head;
    for (std::size_t i = 0; i < written.size(); ++i) out_ += (i == 0 ? "/" : ",") + written[i];
    out_ += "\n";
  }

  void any_statement() {
    const lang::Statement& s = *one_of(lang::statements());
    if (s.word == "ENDFIL" || s.word == "DMISMN" || s.word == "SNSDEF" || s.word == "READ") return;
    const std::string label = s.label.empty() || s.label == "*" ? "" : std::string(s.label) + "(" + name() + ")=";
    const std::string head = label + std::string(s.word);
    if (s.word == "TOL") {
      const ToleranceKind& kind = *one_of(tolerance_kinds());
      statement(head, kind.signature, {std::string(kind.word)});
    } else if (s.word == "CONST") {
      const Construction& method = *one_of(constructions());
      statement(head, method.signature,
                {one_of(feature_kinds())->word.data(), "F(" + name() + ")", std::string(method.word)});
    } else {
      statement(head, s.signature);
    }
    const bool opens = s.word == "MEAS" || s.word == "RMEAS" || s.word == "CALIB";
    if (opens && below(8) != 0) out_ += "ENDMES\n";
  }

  /// A feature and its measurement, so that what follows has something to work with.
  void measured_feature() {
    const FeatureKind& kind = *one_of(feature_kinds());
    const std::string label = name();
    statement("F(" + label + ")=FEAT", kind.signature, {std::string(kind.word)});
    const std::size_t touches = static_cast<std::size_t>(kind.minimum_points) + below(3);
    out_ += "MEAS/" + std::string(kind.word) + ",F(" + label + ")," + std::to_string(touches) + "\n";
    const lang::Statement& touch = *lang::find_statement("PTMEAS");
    for (std::size_t i = 0; i < touches; ++i) statement("PTMEAS", touch.signature);
    out_ += "ENDMES\n";
    if (below(2) == 0) out_ += "DATDEF/FA(" + label + "),DAT(" + name() + ")\n";
    const ToleranceKind& tolerance = *one_of(tolerance_kinds());
    statement("T(" + label + ")=TOL", tolerance.signature, {std::string(tolerance.word)});
    out_ +=
        "OUTPUT/FA(" + label + ")," + (tolerance.features == 2 ? "FA(" + name() + ")," : "") + "TA(" + label + ")\n";
  }

  std::mt19937& random_;
  std::string out_;
};

std::string random_line(const std::string& text, std::mt19937& random) {
  const std::size_t at = text.empty() ? 0 : random() % text.size();
  const std::size_t before = text.rfind('\n', at), begin = before == std::string::npos ? 0 : before + 1;
  return text.substr(begin, text.find('\n', begin) - begin) + "\n";
}

}  // namespace

std::string random_program(std::mt19937& random) { return Generator(random).program(); }

std::string damaged(std::string text, const std::string& other, std::mt19937& random) {
  static const std::array<std::string, 24> kPieces = {"$",
                                                      "$\n",
                                                      "$$",
                                                      "$$!",
                                                      "'",
                                                      "''",
                                                      "(",
                                                      ")",
                                                      ",",
                                                      "=",
                                                      "/",
                                                      "\n",
                                                      "\r",
                                                      std::string(1, '\0'),
                                                      "\xff",
                                                      "1E999",
                                                      "-",
                                                      "F(",
                                                      "ENDMES\n",
                                                      "MEAS/POINT,F(A),1\n",
                                                      "DO/I,1,9\n",
                                                      "ENDDO\n",
                                                      "IF/(1 .LT. 2)\n",
                                                      "JUMPTO/(A)\n"};
  const std::size_t edits = 1 + random() % 6;
  for (std::size_t i = 0; i < edits; ++i) {
    const std::size_t at = random() % (text.size() + 1);
    switch (random() % 6) {
      case 0: text.insert(at, kPieces[random() % kPieces.size()]); break;
      case 1: text.erase(at, 1 + random() % 12); break;
      case 2: text.insert(at, random_line(other, random)); break;
      case 3: text.insert(at, random_line(text, random)); break;
      case 4: text.resize(at); break;
      default:
        if (at < text.size()) text[at] = static_cast<char>(random() % 256);
    }
  }
  return text;
}

std::vector<std::string> existing_programs(const std::string& root) {
  std::vector<std::filesystem::path> paths;
  for (const char* folder : {"tests/lang", "examples"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(std::filesystem::path(root) / folder))
      if (entry.path().extension() == ".dmi") paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> programs;
  for (const auto& path : paths) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    programs.push_back(text.str());
  }
  return programs;
}

}  // namespace abbe::fuzz
