#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "app/render/style_options.hpp"
#include "app/report/report_data.hpp"
#include "render/report/document/pdf.hpp"

#include <filesystem>
#include <optional>
#include <string_view>

namespace macadam {

struct ReportOptions {
    std::filesystem::path store;
    std::filesystem::path output;
    ReportConfig report;
    PdfConfig pdf;
    std::optional<std::filesystem::path> photos; ///< folder
};

/// Parses the options of a report.
/// \throws UsageError  for an invalid value or combination.
ReportOptions parse_report(const Arguments& arguments, const Console& console);

/// Returns the language and unit of a report.
/// \throws UsageError  for a language that there is not.
Localisation wording_of(const ChosenLook& chosen);

/// Parses the paper options.
/// \param ending  suffix of the output
/// \throws UsageError  if there is a paper, but no .pdf.
PdfConfig parse_paper(const Arguments& arguments, std::string_view ending);

bool is_to_standard_output(const Arguments& arguments);

} // namespace macadam
