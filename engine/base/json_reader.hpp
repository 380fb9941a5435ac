// Strict reading of the JSON files that users write: machines with their known states, workpieces.
//
// A file with a mistyped key must not run on a default. So every key that the caller did not ask
// for is an error that names the key, its place and the nearest key that was asked for; so are
// duplicate and missing keys, wrong types and numbers outside their range. The questions asked are
// the schema: there is no second list of keys to keep in step.
//
//   JsonReader reader(read_source(path));
//   JsonObject axis = reader.root().object("axis");
//   const double travel_mm = axis.number("travel_mm", kPositive);
//   reader.finish();                     // throws one UserError with everything that was found
//
// Until finish() returns, values may be stand-ins (0, "", empty) for what was missing or wrong.
#pragma once

#include <deque>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/base/source.hpp"

namespace abbe {

/// One value of a JSON text and the bytes it came from.
struct JsonNode {
  enum class Kind { null, boolean, number, text, array, object };
  struct Member;
  Kind kind = Kind::null;
  Span span;
  double number = 0;  ///< booleans: 0 or 1
  std::string text;
  std::vector<JsonNode> items;  ///< of an array
  std::vector<Member> members;  ///< of an object, in the order of the file
};
struct JsonNode::Member {
  std::string key;
  Span key_span;
  JsonNode value;
};

/// Parses a JSON text. Throws UserError: not JSON, duplicate key, nested deeper than 64.
JsonNode parse_json(const SourceFile& source);

/// Where a number must lie; `words` completes "must be ...".
struct NumberRange {
  double low, high;
  bool low_included, high_included;
  std::string_view words;
  constexpr bool holds(double x) const {
    return (low_included ? x >= low : x > low) && (high_included ? x <= high : x < high);
  }
};
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr NumberRange kAnyNumber{-kInfinity, kInfinity, false, false, "a finite number"};
inline constexpr NumberRange kPositive{0, kInfinity, false, false, "greater than 0"};
inline constexpr NumberRange kNotNegative{0, kInfinity, true, false, "0 or greater"};
inline constexpr NumberRange kShare{0, 1, true, true, "between 0 and 1"};
inline constexpr NumberRange kPositiveShare{0, 1, false, true, "greater than 0 and at most 1"};

class JsonReader;

/// A view of one object of the file. The plain form of a question requires the key; the `_or` form
/// has a default. A view of an object that is missing or not an object answers every question with
/// the default, without further messages.
class JsonObject {
 public:
  bool has(std::string_view key) const { return find(key) != nullptr; }
  /// A key that may stand here, whether or not it is read: it is suggested for a near word, and is not unknown.
  void offer(std::string_view key);

  double number(std::string_view key, const NumberRange& range = kAnyNumber);
  double number_or(std::string_view key, double otherwise, const NumberRange& range = kAnyNumber);
  /// A whole number, however it is written: 7 or 7.0.
  int integer_or(std::string_view key, int otherwise, int low, int high);
  /// A text that is not empty.
  std::string text(std::string_view key);
  std::string text_or(std::string_view key, std::string otherwise);
  bool flag_or(std::string_view key, bool otherwise);
  /// A list of exactly `size` numbers, each in `range`.
  std::vector<double> numbers_or(std::string_view key, std::vector<double> otherwise, std::size_t size,
                                 const NumberRange& range = kAnyNumber);
  /// A list of any length.
  std::vector<double> number_list(std::string_view key, const NumberRange& range = kAnyNumber);
  /// A list of such lists.
  std::vector<std::vector<double>> number_lists(std::string_view key, const NumberRange& range = kAnyNumber);
  std::vector<std::string> text_list_or(std::string_view key, std::vector<std::string> otherwise);
  /// The object under `key`; an absent object when it is missing.
  JsonObject object(std::string_view key);
  JsonObject object_or_absent(std::string_view key);
  /// The elements of a list of objects; empty when the key is missing.
  std::vector<JsonObject> object_list(std::string_view key);
  /// The keys of an object whose keys are the user's own names (sensors, parameters), in the order
  /// of the file.
  std::vector<std::string> own_names() const;
  /// The kind of the value under `key`; null when it is missing. Does not count as asking for the
  /// key.
  JsonNode::Kind kind_of(std::string_view key) const;
  /// The bytes of the value under `key`, for messages and for reading it with other means; the
  /// object's when it is missing.
  Span span_of(std::string_view key) const;
  bool present() const { return node_ != nullptr; }

  /// Reports an error at the value of `key`, or at the object when it has no such key.
  void fault(std::string_view key, Code code, std::string message, std::string help = "");
  /// Holds a text under `schema` against the one that is read, and throws UserError where it is another: of such a file
  /// no other key means anything. `kind`: what has this schema, as "a machine file".
  void check_schema(std::string_view schema, std::string_view kind, std::string help);
  /// Reports an error when `value`, which stands under `key`, is none of `words`, and names the
  /// nearest.
  void one_of(std::string_view key, const std::string& value, const std::vector<std::string_view>& words);

 private:
  friend class JsonReader;
  JsonObject(JsonReader* reader, const JsonNode* node, std::string path)
      : reader_(reader), node_(node), path_(std::move(path)) {}
  const JsonNode* find(std::string_view key) const;
  const JsonNode* ask(std::string_view key, JsonNode::Kind kind);
  const JsonNode* require(std::string_view key, JsonNode::Kind kind);
  bool check(const JsonNode& node, std::string_view key, JsonNode::Kind kind);
  double checked(const JsonNode& node, std::string_view key, const NumberRange& range);
  std::vector<double> numbers_of(const JsonNode& list, std::string_view key, const NumberRange& range);
  std::string path_to(std::string_view key) const;

  JsonReader* reader_;
  const JsonNode* node_;  ///< null: absent
  std::string path_;      ///< "axes.x", for messages
};

class JsonReader {
 public:
  /// Throws UserError when the text is not a JSON object.
  explicit JsonReader(SourceFile source);
  JsonReader(const JsonReader&) = delete;
  JsonReader& operator=(const JsonReader&) = delete;

  JsonObject root() { return {this, &root_, ""}; }
  const SourceFile& source() const { return source_; }
  void report(Span span, Code code, std::string message, std::string help = "", std::string replacement = "");
  /// Reports the keys that nobody asked for, and throws UserError when anything was reported.
  void finish();

 private:
  friend class JsonObject;
  void report_unknown_keys(const JsonNode& node);

  SourceFile source_;
  JsonNode root_;
  std::map<const JsonNode*, std::vector<std::string>> asked_;  ///< by object
  Sink sink_;
};

}  // namespace abbe
