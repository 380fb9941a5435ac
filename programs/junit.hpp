// Test results as JUnit XML, the form that continuous-integration servers read (testsuites /
// testsuite / testcase / failure).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace abbe {

struct TestCase {
  std::string name;  ///< the expectation as written
  int line = 0;
  std::string outcome;  ///< the figure and its bounds, or why there is none
  bool passed = false;
};

/// The expectations of one program.
struct TestSuite {
  std::string file;
  std::vector<TestCase> cases;
};

std::string junit_xml(const std::vector<TestSuite>& suites);

/// Text that may stand in an attribute or element: the five characters of XML as entities; bytes
/// that are not UTF-8 and characters that XML 1.0 forbids become U+FFFD.
std::string xml_escaped(std::string_view text);

}  // namespace abbe
