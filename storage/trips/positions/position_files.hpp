#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace macadam {

/// Tests for the name of a recording of positions: GPX or NMEA.
bool is_track_name(std::string_view name);

/// Tests for an NMEA recording: by its name or, for .log and .txt, by its first lines.
///
/// \throws InputError  if such a .log or .txt cannot be read.
bool is_nmea_file(const std::filesystem::path& file);

/// Finds the recording of positions that belongs to a log: the file beside it whose name has the
/// same stem (drive1.nmea beside drive1.trip.csv.gz), of .nmea and .gpx, plain or compressed, and
/// NMEA in .log or .txt.
std::optional<std::filesystem::path> positions_beside(const std::filesystem::path& log);

} // namespace macadam
