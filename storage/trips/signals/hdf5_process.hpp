#pragma once

#include "storage/trips/signals/hdf5_datasets.hpp"

#include <cstddef>
#include <cstdint>

namespace macadam {

/// Message of the process that reads HDF5: the numbers of a dataset follow, row by row; for each
/// dataset in order.
struct Hdf5Message {
    std::uint64_t rows;
    std::uint64_t columns; ///< 0: `rows` bytes of words follow, a refusal
};

inline constexpr std::size_t max_hdf5_words = 4096;

} // namespace macadam
