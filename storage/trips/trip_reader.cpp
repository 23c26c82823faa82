#include "storage/trips/trip_reader.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/byte_stream.hpp"
#include "storage/files/decompress.hpp"
#include "storage/files/sha256.hpp"
#include "storage/trips/detection/detected_mapping.hpp"
#include "storage/trips/foreign/trip_files.hpp"
#include "storage/trips/foreign_trip.hpp"
#include "storage/trips/log/trip_assembly.hpp"
#include "storage/trips/log/trip_rows.hpp"
#include "storage/trips/positions/gpx_reader.hpp"
#include "storage/trips/positions/joined_trip.hpp"
#include "storage/trips/positions/nmea_reader.hpp"
#include "storage/trips/positions/position_files.hpp"
#include "storage/trips/rawlog/rawlog_reader.hpp"
#include "storage/trips/source/phone_export_files.hpp"
#include "storage/trips/source/trip_contents.hpp"
#include "storage/trips/trip_file_names.hpp"

#include <fmt/core.h>

#include <system_error>
#include <utility>

namespace macadam {

namespace {

std::unique_ptr<ByteStream> open(const TripSource& source) {
    return source.contents ? bytes_of(source.contents, "")
                           : decompressed(file_bytes(source.file), source.name());
}

/// Size of the file, or of the contents in memory.
std::size_t size_of(const TripSource& source) {
    if (source.contents) {
        return source.contents->files.front().bytes.size();
    }
    std::error_code unknown_size;
    const auto size = std::filesystem::file_size(source.file, unknown_size);
    return unknown_size ? 0 : static_cast<std::size_t>(size);
}

/// Tests for a file on disk whose name says no format.
bool may_be_detected(const TripSource& source) {
    const auto name = source.file.filename().string();
    return !is_foreign(source) && !source.contents && !is_trip_name(name) && !is_track_name(name) &&
           !marks_export(name) && !is_nmea_file(source.file);
}

TripSource with_mapping(TripSource source, std::shared_ptr<const TripMapping> mapping) {
    if (mapping) {
        source.files = {source.file.filename().string()};
        source.mapping = std::move(mapping);
    }
    return source;
}

/// Speed of the receiver is used if it is there.
TripNeeds needs_of_positions() {
    auto needs = needs_of_match();
    needs.speed = false;
    return needs;
}

void expect_sure(const DetectedLog& log, const TripNeeds& needs, const std::string& name) {
    const auto missing = missing_measurements(log, needs, Confidence::sure);
    if (!missing.empty()) {
        throw InputError{
            fmt::format("{0}: not a Macadam log; read as a CSV file ({1}), not found or not sure: "
                        "{2}. 'macadam inspect {0}' shows what was found and writes a mapping for "
                        "--mapping",
                        name,
                        words_of(log),
                        missing)};
    }
}

/// Bytes that report progress as they are read, and stop on request.
class WatchedBytes final : public ByteStream {
public:
    WatchedBytes(ByteStream& from, const TripSource& source, const Progress& progress)
        : from_{from}, name_{source.name()}, size_{size_of(source)}, progress_{progress} {}

    std::size_t read(std::span<char> into) override {
        progress_(static_cast<std::size_t>(consumed()), size_);
        if (progress_.stop.stop_requested()) {
            throw InputError{fmt::format("{}: reading was stopped", name_)};
        }
        return from_.read(into);
    }

    std::uint64_t consumed() const override { return from_.consumed(); }

private:
    ByteStream& from_;
    std::string name_;
    std::size_t size_;
    const Progress& progress_;
};

} // namespace

OpenTrip::OpenTrip(TripSource source) : source_{std::move(source)} {
    if (may_be_detected(source_) && std::filesystem::is_regular_file(source_.file)) {
        detected_ = detect_log(source_.file);
        source_ = detected_ ? with_mapping(std::move(source_),
                                           sure_mapping(*detected_, !source_.positions.empty()))
                            : std::move(source_);
    }
    is_nmea_ = !is_foreign(source_) &&
               (source_.contents ? is_nmea_name(source_.member) : is_nmea_file(source_.file));
    if (is_foreign(source_)) {
        source_ = with_contents(std::move(source_));
    } else {
        bytes_.emplace(open(source_));
    }
    if (!source_.positions.empty()) {
        positions_ =
            std::make_unique<OpenTrip>(TripSource{.file = source_.positions, .member = {}});
    }
}

std::optional<std::string> OpenTrip::sha256_ahead(std::size_t max_bytes) {
    const bool is_known = (!bytes_ || bytes_->read_ahead(max_bytes)) &&
                          (!positions_ || positions_->sha256_ahead(max_bytes));
    return is_known ? std::optional{sha256()} : std::nullopt;
}

TripLog OpenTrip::read(const TripNeeds& needs, const Progress& progress) {
    auto trip = parsed(positions_ ? needs_beside_positions(needs) : needs, progress);
    if (positions_) {
        auto positions =
            positions_->read(needs_of_positions(), {.report = {}, .stop = progress.stop});
        trip = joined_trip(std::move(trip),
                           std::move(positions),
                           needs,
                           source_.positions.string(),
                           progress.stop);
    }
    trip.sha256 = sha256();
    return trip;
}

std::string OpenTrip::sha256() {
    if (!positions_) {
        return own_sha256();
    }
    Sha256 both;
    both.add(own_sha256());
    both.add(positions_->sha256());
    return both.hex();
}

std::string OpenTrip::own_sha256() {
    if (bytes_) {
        return bytes_->sha256();
    }
    if (foreign_sha256_.empty()) {
        foreign_sha256_ = foreign_sha256(source_);
    }
    return foreign_sha256_;
}

TripLog OpenTrip::parsed(const TripNeeds& needs, const Progress& progress) {
    if (detected_) {
        expect_sure(*detected_, needs, source_.name());
    }
    if (!bytes_) {
        return read_foreign_trip(source_, needs, progress.stop);
    }
    const auto name = source_.name();
    auto bytes = std::make_unique<WatchedBytes>(*bytes_, source_, progress);
    if (name.ends_with(rawlog_suffix)) {
        return read_rawlog(std::move(bytes), name, needs);
    }
    if (is_nmea_) {
        return read_nmea(std::move(bytes), name, needs);
    }
    if (is_gpx_name(name)) {
        return read_gpx(std::move(bytes), name, needs);
    }
    TripRows rows{std::move(bytes), source_, needs};
    TripStreams streams{needs, rows.header()};
    while (const auto row = rows.next()) {
        streams.add(*row);
    }
    if (!rows.closed()) {
        refuse_unclosed(rows);
    }
    auto trip = streams.take();
    trip.meta = rows.meta();
    return trip;
}

TripLog read_trip(const TripSource& source, const TripNeeds& needs, const Progress& progress) {
    return OpenTrip{source}.read(needs, progress);
}

} // namespace macadam
