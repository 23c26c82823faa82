#pragma once

#include "storage/trips/detection/csv_dialect.hpp"
#include "storage/trips/detection/detected_channel.hpp"
#include "storage/trips/detection/text_sample.hpp"
#include "storage/trips/detection/time_detection.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Log of an unknown make whose layout, columns and units were detected.
struct DetectedLog {
    std::string built_in{}; ///< name of the built-in mapping that fits; "": none
    CsvDialect dialect{};
    TextEncoding encoding = TextEncoding::utf8;
    std::vector<std::string> names{};   ///< of all columns; "" without one
    std::vector<std::string> empty{};   ///< words that stand for an empty cell
    std::optional<DetectedTime> time{}; ///< without its values
    std::vector<DetectedChannel> channels{};
    bool has_gravity = true;
    bool of_device = false; ///< accelerations in the axes of the device
    std::string gravity{};  ///< for people; "" without accelerations

    const DetectedChannel* channel(std::string_view name) const; ///< null: none

    /// Tests whether a column of the trip log was found, with its unit.
    bool has(std::string_view column, Confidence least) const;
};

/// Detects the layout of a log from its first lines.
///
/// \returns `std::nullopt` if they are not a table, or a log of our own.
std::optional<DetectedLog> detect_log(const TextSample& sample);

/// Opens a file, also a compressed one, and detects its layout.
///
/// \throws InputError  if the file cannot be read.
std::optional<DetectedLog> detect_log(const std::filesystem::path& file);

/// Names what is needed and was not found, or not for sure (missing_measurements).
std::string missing_measurements(const DetectedLog& log, const TripNeeds& needs, Confidence least);

/// Describes a reading: "semicolons, decimal commas, time in ms, acceleration in g, ...".
std::string words_of(const DetectedLog& log);

} // namespace macadam
