#include "engine/report/writer.hpp"

namespace abbe {

extern const ReportWriter text_writer;
extern const ReportWriter json_writer;
extern const ReportWriter html_writer;

std::span<const ReportWriter* const> report_writers() {
  static const ReportWriter* const all[] = {
      &text_writer,
      &json_writer,
      &html_writer,
  };
  return all;
}

const ReportWriter* find_report_writer(std::string_view name) {
  for (const ReportWriter* writer : report_writers())
    if (writer->name == name) return writer;
  return nullptr;
}

}  // namespace abbe
