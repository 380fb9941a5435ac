#include "programs/junit.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace abbe {

namespace {

/// Bytes of the UTF-8 character at the start of `text`, 0 when there is none (RFC 3629: no
/// surrogates, no overlong forms).
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xC2 && lead < 0xE0 ? 2
      : lead >= 0xE0 && lead < 0xF0                      ? 3
      : lead >= 0xF0 && lead < 0xF5                      ? 4
                                                         : 0;
  if (length == 0 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  const unsigned char second = byte(1);
  const bool overlong = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
  const bool outside = (lead == 0xED && second >= 0xA0) || (lead == 0xF4 && second >= 0x90);
  return overlong || outside ? 0 : length;
}

std::string escaped_character(std::string_view character) {
  constexpr const char* kReplacement = "\xEF\xBF\xBD";
  switch (character[0]) {
    case '&': return "&amp;";
    case '<': return "&lt;";
    case '>': return "&gt;";
    case '"': return "&quot;";
    case '\'': return "&apos;";
    case '\n': return "&#10;";
    case '\t': return "&#9;";
    case '\r': return "&#13;";
    default: break;
  }
  const bool control = static_cast<unsigned char>(character[0]) < 0x20;
  const bool noncharacter = character == "\xEF\xBF\xBE" || character == "\xEF\xBF\xBF";
  return control || noncharacter ? kReplacement : std::string(character);
}

long failures(const TestSuite& suite) {
  return std::count_if(suite.cases.begin(), suite.cases.end(), [](const TestCase& c) { return !c.passed; });
}

std::string case_xml(const TestSuite& suite, const TestCase& c) {
  const std::string open = fmt::format("    <testcase classname=\"{}\" name=\"{}\" file=\"{}\" line=\"{}\"",
                                       xml_escaped(suite.file), xml_escaped(c.name), xml_escaped(suite.file), c.line);
  if (c.passed) return open + "/>\n";
  return fmt::format("{}>\n      <failure message=\"{}\"/>\n    </testcase>\n", open, xml_escaped(c.outcome));
}

}  // namespace

std::string xml_escaped(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    out += length ? escaped_character(text.substr(0, length)) : "\xEF\xBF\xBD";
    text.remove_prefix(std::max<std::size_t>(1, length));
  }
  return out;
}

std::string junit_xml(const std::vector<TestSuite>& suites) {
  std::size_t tests = 0;
  long failed = 0;
  std::string body;
  for (const TestSuite& suite : suites) {
    tests += suite.cases.size();
    failed += failures(suite);
    body += fmt::format("  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\">\n", xml_escaped(suite.file),
                        suite.cases.size(), failures(suite));
    for (const TestCase& c : suite.cases) body += case_xml(suite, c);
    body += "  </testsuite>\n";
  }
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"abbe\" tests=\"{}\" "
      "failures=\"{}\">\n{}</testsuites>\n",
      tests, failed, body);
}

}  // namespace abbe
