#pragma once

#include "storage/trips/mappings/column_mapping.hpp"

#include <filesystem>

namespace macadam {

class TomlTable;

/// Reads the mapping of a CAN log or a measurement file (MDF, HDF5): its signals have names, and
/// the format knows their times. A DBC file is sought from `folder`.
///
/// \throws InputError  "file:line: ..." for an unknown or missing key, an invalid value, or a
/// signal
///                      that the DBC file does not have.
TableMapping signal_table_of(const TomlTable& table, const std::filesystem::path& folder);

} // namespace macadam
