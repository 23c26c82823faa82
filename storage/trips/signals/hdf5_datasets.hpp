#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Numbers of a dataset, row by row.
struct Hdf5Dataset {
    std::size_t rows = 0;
    std::size_t columns = 1;
    std::vector<double> values;
};

/// Reads datasets of an HDF5 file in memory: integers or floats of one or two dimensions, compact,
/// contiguous or in chunks, with the filters deflate, shuffle and fletcher32 or none. External
/// links, external and virtual storage, other filters and plug-ins of the library are refused.
///
/// The library runs in a process of its own (macadam_hdf5, beside the plug-ins), because it was not
/// made for hostile files; what ends that process (a crash, too much memory, 20 s of computing, 30
/// s without an answer) is a refusal.
///
/// \param bytes  the whole file
/// \param most  bytes that the numbers of all datasets together may take
/// \throws InputError  "dataset ...: ..." (without the name of the file)
std::vector<Hdf5Dataset>
read_hdf5_datasets(std::string_view bytes, std::span<const std::string> datasets, std::size_t most);

} // namespace macadam
