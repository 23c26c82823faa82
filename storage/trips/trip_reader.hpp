#pragma once

#include "estimator/common/progress.hpp"
#include "estimator/common/trip.hpp"
#include "storage/files/hashed_bytes.hpp"
#include "storage/trips/detection/log_detection.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

namespace macadam {

/// A trip whose content is opened, decompressed and hashed once, while it is parsed.
class OpenTrip {
public:
    /// \throws InputError  if the file cannot be opened, or could not be extracted.
    explicit OpenTrip(TripSource source);

    /// SHA-256 of the decompressed content, to recognise a trip before it is parsed.
    /// `std::nullopt` for more than `max_bytes`, which are not kept in memory for this; by default
    /// four hours at 100 Hz.
    ///
    /// \throws InputError  if the content cannot be read.
    std::optional<std::string> sha256_ahead(std::size_t max_bytes = std::size_t{128} << 20);

    /// Parses the trip, as read_trip does. Callable once.
    TripLog read(const TripNeeds& needs, const Progress& progress = {});

    /// SHA-256 of the whole content, also if it could not be parsed: 64 lower-case hex digits. With
    /// positions of another file, that of the two digests, the log's first.
    ///
    /// \throws InputError  if the content cannot be read.
    std::string sha256();

private:
    TripLog parsed(const TripNeeds& needs, const Progress& progress);
    std::string own_sha256();

    TripSource source_;
    std::optional<HashedBytes> bytes_;    ///< `std::nullopt`: a foreign trip, of several files
    std::string foreign_sha256_;          ///< once it was asked for
    std::optional<DetectedLog> detected_; ///< of a CSV file of unknown make
    bool is_nmea_ = false;
    std::unique_ptr<OpenTrip> positions_; ///< of a log without its own
};

/// Reads a "macadam-trip 1" log, plain, .gz or .zst, as a stream: its samples, and for every data
/// row its contribution or the reason why it has none. By suffix also rawlogs
/// (storage/trips/rawlog/rawlog_reader.hpp), GPX tracks and NMEA recordings
/// (storage/trips/positions/). A source with positions of another file is joined to these.
/// Any other CSV file is read if its layout is detected for sure
/// (storage/trips/detection/log_detection.hpp); its meta data then say how it was read.
///
/// \throws InputError  "file:line: ..." if it is not such a log, lacks a required column, or does
///                     not end with "# end rows: N" and the correct N.
TripLog read_trip(const TripSource& source, const TripNeeds& needs, const Progress& progress = {});

} // namespace macadam
