#include "engine/machine/machine.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "engine/base/file_kind.hpp"
#include "engine/base/files.hpp"
#include "engine/machine/shipped.hpp"

namespace abbe {

std::string_view name(Component c) {
  static constexpr std::string_view names[kComponents] = {"exx", "eyx", "ezx", "eax", "ebx", "ecx",
                                                          "exy", "eyy", "ezy", "eay", "eby", "ecy",
                                                          "exz", "eyz", "ezz", "eaz", "ebz", "ecz"};
  return names[static_cast<int>(c)];
}

std::vector<std::string> shipped_machines() {
  std::vector<std::string> names;
  for (const ShippedFile& file : shipped_machine_files()) names.emplace_back(file.name);
  return names;
}

namespace {

/// A machine file by name or path, wherever it lies.
SourceFile machine_source(const std::string& name_or_path) {
  std::vector<std::string_view> names;
  for (const ShippedFile& file : shipped_machine_files()) {
    if (file.name == name_or_path) return {std::string(file.name) + ".json", std::string(file.text)};
    names.push_back(file.name);
  }
  const bool is_path = name_or_path.find_first_of("/.") != std::string::npos || is_there(name_or_path);
  if (is_path) {
    SourceFile source = read_source(name_or_path);
    refuse_other_kind(source, FileKind::json);
    return source;
  }
  const std::string near = nearest_word(name_or_path, names);
  throw UserError(
      diagnostic(Code::E0411,
                 fmt::format("there is no machine \"{}\": neither a file nor one of the shipped machines ({})",
                             name_or_path, fmt::join(names, ", ")),
                 near.empty() ? "`abbe machine init NAME` prints a machine file to start from"
                              : fmt::format("did you mean \"{}\"?", near)));
}

}  // namespace

Machine read_machine(const std::string& name_or_path) {
  const SourceFile source = machine_source(name_or_path);
  return parse_machine(source.name(), std::string(source.text()));
}

std::string machine_text(const std::string& name_or_path) { return std::string(machine_source(name_or_path).text()); }

std::vector<Diagnostic> machine_warnings(const Machine& machine) {
  std::vector<Diagnostic> warnings;
  if (!machine.offsets_not_given.empty())
    warnings.push_back(diagnostic(Code::W0417,
                                  fmt::format("machine \"{}\" gives no scale position for {}: zero is taken",
                                              machine.name, fmt::join(machine.offsets_not_given, ", ")),
                                  "measure where the scales are and give \"offsets_mm\": without them "
                                  "measurements far from the scales seem too good"));
  const Specification& spec = machine.specification;
  if (spec.shorter_than_standard())
    warnings.push_back(
        diagnostic(Code::W0419,
                   fmt::format("the longest test length of \"{}\" is {:g} of its line, but ISO 10360-2 asks "
                               "for {:g} or more",
                               machine.name, spec.longest_share, Specification::kLeastLongestShare),
                   fmt::format("leave \"longest_share\" out, which is {:g}: a test over short lengths accepts "
                               "machines that the standard's test rejects",
                               Specification::kLeastLongestShare)));
  return warnings;
}

}  // namespace abbe
