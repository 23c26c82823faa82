#pragma once

#include "storage/trips/detection/inertial_detection.hpp"
#include "storage/trips/detection/text_sample.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
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
};

/// Detects the layout of a log from its first lines.
///
/// \returns `std::nullopt` if they are not a table, or a log of our own.
std::optional<DetectedLog> detect_log(const TextSample& sample);

/// Opens a file, also a compressed one, and detects its layout.
///
/// \throws InputError  if the file cannot be read.
std::optional<DetectedLog> detect_log(const std::filesystem::path& file);

/// Names the columns of the trip log that are needed and were not found, or not for sure; "" if
/// there is none. They read as "t_s and acc_z_mps2 or acc_y_mps2".
std::string missing_columns(const DetectedLog& log, const TripNeeds& needs, Confidence least);

/// Describes a reading: "semicolons, decimal commas, time in ms, acceleration in g, ...".
std::string words_of(const DetectedLog& log);

/// Mapping of what is at least as sure as `least`, as a file for --mapping. Remarks say how sure
/// each column is, and which are missing.
///
/// \param files  pattern of the names of such files, "*.csv".
std::string mapping_toml(const DetectedLog& log, Confidence least, const std::string& files);

/// Mapping of what is sure; null unless that serves `match` or `trace`.
std::shared_ptr<const TripMapping> sure_mapping(const DetectedLog& log);

/// Key of the meta data of a trip that was read by a detected mapping: its words.
inline constexpr const char* detected_key = "read_as";

} // namespace macadam
