// One format of the report of `abbe run`. A format is one file in engine/report/writers and one
// line in its all.cpp.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "engine/report/run_report.hpp"

namespace abbe {

struct ReportWriter {
  std::string_view name;  ///< what --format takes: "text", "json", "html"
  std::string (*write)(const RunReport&);
};

std::span<const ReportWriter* const> report_writers();
const ReportWriter* find_report_writer(std::string_view name);

}  // namespace abbe
