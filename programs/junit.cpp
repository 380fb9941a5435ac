#include "programs/junit.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/base/utf8.hpp"

namespace abbe {

namespace {

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
    const std::size_t length = utf8_character(text, 0).bytes;
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
