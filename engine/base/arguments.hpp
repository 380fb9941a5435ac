// Matched arguments of a statement, by name: what a signature (docs/language.md, "Signatures") hands to the
// feature kind, tolerance kind or construction that published it. Lets those kinds be written without knowing
// the language layer.
//
// Signature notation, one string per kind or statement:
//   CART                    the literal word
//   side:INNER|OUTER        one of several words, kept under the name `side`
//   x:length                a value under the name `x`; types: number, length, angle, integer, text, feature (F or FA label),
//                           datum (DAT label), tolerance (T or TA), sensor (S or SA), frame (D or DA), label (any),
//                           word (any bare word), condition (of IF), value (of any type)
//   [ a, b ]                optional, all or nothing
//   { a, b }                repeated zero or more times; values are appended under their names
//   ( a, b ; c, d )         alternatives, first match wins
// Commas separate items and are otherwise cosmetic.
//
// Values are already in engine units: length mm, angle rad (a `number` is as written).
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace abbe {

class Arguments {
 public:
  void add_number(std::string_view name, double value) { numbers_[std::string(name)].push_back(value); }
  /// Replaces the `index`-th number under `name`, which must be there.
  void set_number(std::string_view name, int index, double value) {
    numbers_.at(std::string(name)).at(static_cast<std::size_t>(index)) = value;
  }
  void add_text(std::string_view name, std::string value) { texts_[std::string(name)].push_back(std::move(value)); }
  /// A label resolved by the language: the index of the feature definition it stands for.
  void add_feature(std::string_view name, int id) { features_[std::string(name)].push_back(id); }

  bool has(std::string_view name) const {
    const std::string key(name);
    return numbers_.count(key) || texts_.count(key) || features_.count(key);
  }
  double number(std::string_view name, double otherwise = 0) const {
    const auto it = numbers_.find(std::string(name));
    return it == numbers_.end() ? otherwise : it->second.front();
  }
  /// The word or text under `name`, or `otherwise`. Words are in upper case.
  std::string text(std::string_view name, std::string_view otherwise = "") const {
    const auto it = texts_.find(std::string(name));
    return it == texts_.end() ? std::string(otherwise) : it->second.front();
  }
  std::vector<double> numbers(std::string_view name) const { return get(numbers_, name); }
  std::vector<std::string> texts(std::string_view name) const { return get(texts_, name); }
  std::vector<int> features(std::string_view name) const { return get(features_, name); }

 private:
  template <class T>
  static std::vector<T> get(const std::map<std::string, std::vector<T>>& from, std::string_view name) {
    const auto it = from.find(std::string(name));
    return it == from.end() ? std::vector<T>{} : it->second;
  }
  std::map<std::string, std::vector<double>> numbers_;
  std::map<std::string, std::vector<std::string>> texts_;
  std::map<std::string, std::vector<int>> features_;
};

/// A value, or the reason in plain words why there is none (static text).
template <class T>
struct Outcome {
  T value{};
  const char* failure = nullptr;

  static Outcome failed(const char* reason) { return {T{}, reason}; }
  explicit operator bool() const { return failure == nullptr; }
};

}  // namespace abbe
