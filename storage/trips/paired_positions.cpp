#include "storage/trips/paired_positions.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/decompress.hpp"
#include "storage/trips/detection/log_detection.hpp"
#include "storage/trips/foreign_trip.hpp"
#include "storage/trips/log/trip_rows.hpp"
#include "storage/trips/mappings/column_mapping.hpp"
#include "storage/trips/positions/position_files.hpp"
#include "storage/trips/rawlog/rawlog_reader.hpp"
#include "storage/trips/trip_file_names.hpp"

#include <algorithm>

namespace macadam {

namespace {

bool gives_positions(const TripMapping& mapping) {
    const auto gives = [&](TripColumn column) {
        return std::ranges::any_of(mapping.tables, [&](const TableMapping& table) {
            return std::ranges::find(table.channels, column, &ChannelMapping::channel) !=
                   table.channels.end();
        });
    };
    return gives(TripColumn::lat) && gives(TripColumn::lon);
}

bool gives_positions(const TripSource& source) {
    if (source.mapping) {
        return gives_positions(*source.mapping);
    }
    if (is_trip_name(source.file.filename().string())) {
        const TripRows rows{
            decompressed(file_bytes(source.file), source.name()), source, TripNeeds{}};
        return rows.header().has(TripColumn::lat) && rows.header().has(TripColumn::lon);
    }
    const auto log = detect_log(source.file);
    return !log || (log->has("lat_deg", Confidence::sure) && log->has("lon_deg", Confidence::sure));
}

} // namespace

std::optional<std::filesystem::path> paired_positions(const TripSource& source) {
    const auto name = source.file.filename().string();
    const bool is_export = is_foreign(source) && !source.mapping;
    if (source.contents || is_export || is_track_name(name) || name.ends_with(rawlog_suffix)) {
        return std::nullopt;
    }
    try {
        auto beside = positions_beside(source.file);
        return beside && !is_nmea_file(source.file) && !gives_positions(source) ? std::move(beside)
                                                                                : std::nullopt;
    } catch (const InputError&) { // reported by the reader
        return std::nullopt;
    }
}

} // namespace macadam
