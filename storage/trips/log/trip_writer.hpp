#pragma once

#include "estimator/common/trip.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <stop_token>
#include <string_view>

namespace macadam {

/// Suffixes that write_trip knows: .trip.csv, .trip.csv.gz, .trip.csv.zst.
std::span<const std::string_view> trip_log_suffixes();

/// Writes a trip as a "macadam-trip 1" log; the suffix says how it is compressed. The file appears
/// when it is whole, or not at all. Equal trips give equal bytes. \returns how many rows it has.
///
/// Samples whose stamps agree to the microsecond share a row. Only columns that occur are written,
/// with fixed decimals: t_s and gyro 6, accelerations 5, speeds and course 4, accuracy 3, latitude
/// and longitude 8 (1 mm). Reading the log gives the same samples to these digits. Fixes that look
/// alike one after the other, as of a car that stands, would be taken for one fix repeated: then a
/// column gnss_utc_s tells them apart, which is the stamp (and t0_utc, where known).
///
/// Rows that gave nothing, and columns that nobody knows, are not in a TripLog and so not written.
///
/// \param level  of compression: 1 (fast) to 9 (small).
/// \throws InputError  for another suffix, if the file cannot be written, or when `stop` is
///                     requested before it is whole.
std::size_t write_trip(const TripLog& trip,
                       const std::filesystem::path& file,
                       int level = 6,
                       const std::stop_token& stop = {});

} // namespace macadam
