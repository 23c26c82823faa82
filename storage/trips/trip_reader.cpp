#include "storage/trips/trip_reader.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/byte_stream.hpp"
#include "storage/files/decompress.hpp"
#include "storage/trips/foreign/foreign_trip.hpp"
#include "storage/trips/foreign/gpx_reader.hpp"
#include "storage/trips/foreign/phone_export.hpp"
#include "storage/trips/log/trip_assembly.hpp"
#include "storage/trips/log/trip_rows.hpp"
#include "storage/trips/rawlog/rawlog_reader.hpp"
#include "storage/trips/source/trip_contents.hpp"

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
std::size_t bytes_of_source(const TripSource& source) {
    if (source.contents) {
        return source.contents->files.front().bytes.size();
    }
    std::error_code unknown_size;
    const auto size = std::filesystem::file_size(source.file, unknown_size);
    return unknown_size ? 0 : static_cast<std::size_t>(size);
}

/// Reports progress at intervals, and stops on request.
class ProgressThrottle {
public:
    ProgressThrottle(const TripSource& source, const Progress& progress)
        : name_{source.name()}, progress_{progress}, whole_{bytes_of_source(source)} {}

    void step(const TripRows& rows) {
        constexpr std::size_t rows_between = 1 << 16;
        if (++rows_ % rows_between != 0) {
            return;
        }
        progress_(static_cast<std::size_t>(rows.consumed()), whole_);
        if (progress_.stop.stop_requested()) {
            throw InputError{fmt::format("{}: reading was stopped", name_)};
        }
    }

private:
    std::string name_;
    const Progress& progress_;
    std::size_t whole_;
    std::size_t rows_ = 0;
};

} // namespace

std::string content_sha256(const TripSource& source) {
    if (is_foreign(source)) {
        return foreign_sha256(source);
    }
    constexpr std::size_t block = 1 << 20;
    const auto bytes = open(source);
    std::vector<char> buffer(block);
    Sha256 sha256;
    while (const auto count = bytes->read(buffer)) {
        sha256.add({buffer.data(), count});
    }
    return sha256.hex();
}

TripLog read_trip(const TripSource& source, const TripNeeds& needs, const Progress& progress) {
    if (is_foreign(source)) {
        return read_foreign_trip(source, needs, progress);
    }
    if (source.name().ends_with(rawlog_suffix)) {
        return read_rawlog({open(source), source.name(), bytes_of_source(source)}, needs, progress);
    }
    if (is_gpx_name(source.name())) {
        return read_gpx({open(source), source.name(), bytes_of_source(source)}, needs, progress);
    }
    TripRows rows{open(source), source, needs};
    TripStreams streams{needs, rows.header()};
    ProgressThrottle pace{source, progress};
    while (const auto row = rows.next()) {
        pace.step(rows);
        streams.add(*row);
    }
    if (!rows.closed()) {
        refuse_unclosed(rows);
    }
    auto trip = streams.take();
    trip.meta = rows.meta();
    trip.sha256 = rows.sha256();
    return trip;
}

} // namespace macadam
