#pragma once

#include "storage/tables/csv_table.hpp"

#include <optional>
#include <string_view>

namespace macadam {

// Values that occur in several kinds of tables.

/// Reads the column `direction`: true for "forward", `std::nullopt` for an empty cell.
///
/// \throws InputError  for other text.
std::optional<bool> direction_in(const CsvRow& row);

/// Reads an IRI and converts it to mm/m.
///
/// \param mm_per_m_of_one  mm/m of an IRI of 1 in the unit of the file.
/// \throws InputError  if the cell is not a valid IRI.
std::optional<double> iri_in(const CsvRow& row, std::string_view column, double mm_per_m_of_one);

} // namespace macadam
