#pragma once

#include "storage/trips/signals/signal_rows.hpp"

#include <string>
#include <string_view>

namespace macadam {

/// Reads the datasets of an HDF5 file that a mapping names (hdf5_datasets.hpp says which are read).
/// Each line of a dataset with times is a row, with the numbers of the datasets on these times.
///
/// \param bytes  the whole file
/// \throws InputError  "file: ..." if it is damaged, lacks a dataset, or if a dataset and its
///                     times differ in length.
SignalRows read_hdf5(std::string_view bytes, const TableMapping& mapping, const std::string& name);

} // namespace macadam
