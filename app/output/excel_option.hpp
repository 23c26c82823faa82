#pragma once

#include "app/cli/arguments.hpp"
#include "storage/tables/excel_csv.hpp"

#include <optional>

namespace macadam {

inline constexpr Option excel_option{"--excel",
                                     "[LOCALE]",
                                     "CSV for Excel: separator and decimal mark of a language such "
                                     "as de or en; by default of LANG."};

/// Parses --excel.
/// \throws UsageError  for an unknown language.
std::optional<ExcelDialect> parse_excel(const Arguments& arguments);

} // namespace macadam
