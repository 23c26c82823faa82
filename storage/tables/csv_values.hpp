#pragma once

#include "storage/tables/csv_table.hpp"

#include <optional>
#include <string_view>

namespace macadam {

// What cells of several tables mean.

/// `direction`: whether it is "forward"; nothing where it is empty. \throws InputError  otherwise.
std::optional<bool> direction_in(const CsvRow& row);

/// An IRI in mm/m of a cell in the file's unit. \throws InputError  for what is none.
std::optional<double> iri_in(const CsvRow& row, std::string_view column, double mm_per_m_of_one);

} // namespace macadam
