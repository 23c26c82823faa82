#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

// Interface between storage/trips/signals/hdf5_reader.cpp and the plug-in macadam_hdf5, the one
// place that opens HDF5.

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
/// The library runs in a child process of its own, because it was not made for hostile files; what
/// ends that process (a crash, 20 s of computing) is a refusal.
///
/// \param bytes  the whole file
/// \param most  bytes that the numbers of all datasets together may take
/// \throws InputError  "dataset ...: ..." (without the name of the file)
using Hdf5Read = void(std::string_view bytes,
                      std::span<const std::string> datasets,
                      std::size_t most,
                      const std::function<void(Hdf5Dataset)>& take);
inline constexpr const char* hdf5_read_name = "macadam_hdf5_read";

} // namespace macadam
