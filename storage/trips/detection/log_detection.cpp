#include "storage/trips/detection/log_detection.hpp"

#include "storage/files/decompress.hpp"
#include "storage/tables/csv_cells.hpp"
#include "storage/trips/detection/inertial_detection.hpp"
#include "storage/trips/detection/position_detection.hpp"
#include "storage/trips/log/trip_row.hpp"
#include "storage/trips/mappings/built_in_mappings.hpp"
#include "storage/trips/mappings/column_mapping_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace macadam {
namespace {

/// Finds the built-in mapping of a logger that names itself, if its columns are there.
std::string built_in_for(const TextSample& sample, const CsvDialect& dialect) {
    constexpr std::size_t looked_at = 5;
    for (const auto& [name, toml, first_line] : built_in_mappings()) {
        const std::size_t count = std::min(looked_at, sample.lines.size());
        const bool names_itself = std::any_of(
            sample.lines.begin(),
            sample.lines.begin() + static_cast<std::ptrdiff_t>(count),
            [&, begin = first_line](const std::string& line) { return line.starts_with(begin); });
        if (!names_itself) {
            continue;
        }
        const auto mapping = parse_mapping(toml, std::string{name});
        const auto& channels = mapping.tables.front().channels;
        const bool has_all = std::ranges::all_of(channels, [&](const ChannelMapping& channel) {
            return channel.column.number > 0
                       ? channel.column.number <= dialect.names.size()
                       : std::ranges::any_of(dialect.names, [&](const std::string& column) {
                             return fits(column, channel.column.pattern);
                         });
        });
        if (has_all) {
            return std::string{name};
        }
    }
    return "";
}

/// Channels of a built-in mapping, all of them sure.
std::vector<DetectedChannel> channels_of(const TripMapping& mapping, const CsvDialect& dialect) {
    std::vector<DetectedChannel> channels;
    for (const auto& channel : mapping.tables.front().channels) {
        const auto named = std::ranges::find_if(dialect.names, [&](const std::string& column) {
            return fits(column, channel.column.pattern);
        });
        const auto number = channel.column.number > 0
                                ? channel.column.number
                                : static_cast<std::size_t>(named - dialect.names.begin()) + 1;
        channels.push_back({.channel = std::string{name_of(channel.channel)},
                            .column = number,
                            .unit = "",
                            .confidence = Confidence::sure,
                            .reason = "by the built-in mapping"});
    }
    return channels;
}

bool is_own_log(const TextSample& sample) {
    return !sample.lines.empty() && sample.lines.front().starts_with("# macadam-trip");
}

/// Tests for channels whose numbers mean nothing without a unit.
bool needs_unit(std::string_view channel) {
    return channel.starts_with("acc_") || channel.starts_with("gyro_") ||
           channel.ends_with("speed_mps");
}

/// Tests for a column of which an import can make use. Lateral acceleration alone is no reason to
/// read a file by what was detected.
bool has_usable(const DetectedLog& log, std::string_view column, Confidence least) {
    return column != "acc_y_mps2" && log.has(column, least);
}

/// Detects the positions; speeds along them settle a unit of the time that is a guess, and show
/// that a time is wrong.
DetectedPositions positions_with_time(const LogTable& table, std::optional<DetectedTime>& time) {
    auto positions = detect_positions(table, time ? &*time : nullptr);
    if (!time) {
        return positions;
    }
    if (time->is_guess && !positions.speed_agrees) {
        for (auto& other : other_units_of(*time)) {
            auto by_other = detect_positions(table, &other);
            if (by_other.speed_agrees && !by_other.speed_contradicts) {
                time = std::move(other);
                positions = std::move(by_other);
                break;
            }
        }
    }
    if (time->is_guess && positions.speed_agrees) {
        time->confidence = Confidence::sure;
        time->reason = fmt::format("steps of {:.4g} s, by speed and positions", time->step_s);
    } else if (positions.speed_contradicts && !positions.speed_agrees) {
        time->confidence = Confidence::likely;
        time->reason += "; contradicts speed or positions";
    }
    return positions;
}

std::string unit_words(const DetectedLog& log, std::string_view channel, std::string_view name) {
    const auto* const found = log.channel(channel);
    if (found == nullptr || found->confidence != Confidence::sure || found->unit.empty()) {
        return "";
    }
    return fmt::format(", {} in {}{}",
                       name,
                       found->scale == 1 ? "" : "counts of ",
                       found->scale == 1
                           ? found->unit
                           : fmt::format("1/{:.0f} {}", 1 / found->scale, found->unit));
}

} // namespace

const DetectedChannel* DetectedLog::channel(std::string_view name) const {
    const auto found = std::ranges::find(channels, name, &DetectedChannel::channel);
    return found == channels.end() ? nullptr : &*found;
}

bool DetectedLog::has(std::string_view column, Confidence least) const {
    if (column == "t_s") {
        return time && is_at_least(time->confidence, least);
    }
    const auto* const found = channel(column);
    return found != nullptr && (!found->unit.empty() || !needs_unit(column) || !built_in.empty()) &&
           is_at_least(found->confidence, least);
}

std::optional<DetectedLog> detect_log(const TextSample& sample) {
    auto dialect = is_own_log(sample) ? std::nullopt : detect_csv_dialect(sample.lines);
    if (!dialect) {
        return std::nullopt;
    }
    const auto built_in = built_in_for(sample, *dialect);
    const auto table = parse_log_table(sample, std::move(*dialect));
    if (table.rows < 2) {
        return std::nullopt;
    }
    DetectedLog log{.built_in = built_in,
                    .dialect = table.dialect,
                    .encoding = table.encoding,
                    .names = {},
                    .empty = table.empty,
                    .time = detect_time(table),
                    .channels = {},
                    .gravity = {}};
    for (const auto& column : table.columns) {
        log.names.push_back(column.name);
    }
    if (!built_in.empty()) {
        const auto mapping = read_mapping(built_in);
        log.channels = channels_of(mapping, log.dialect);
        log.has_gravity = mapping.meta.gravity_included;
        log.gravity = "removed";
        if (log.time) {
            log.time->confidence = Confidence::sure;
        }
    } else {
        auto positions = positions_with_time(table, log.time);
        const auto inertia = detect_inertia(table, positions.is_moving);
        log.channels = inertia.channels;
        log.has_gravity = inertia.has_gravity;
        log.of_device = inertia.of_device;
        log.gravity = inertia.gravity;
        std::ranges::move(positions.channels, std::back_inserter(log.channels));
    }
    if (log.time) {
        log.time->t_s = {};
    }
    return log;
}

std::optional<DetectedLog> detect_log(const std::filesystem::path& file) {
    const auto bytes = decompressed(file_bytes(file), file.string());
    const auto sample = read_text_sample(*bytes, file.string());
    return sample ? detect_log(*sample) : std::nullopt;
}

std::string missing_measurements(const DetectedLog& log, const TripNeeds& needs, Confidence least) {
    return missing_measurements(
        needs, [&](const std::string& column) { return has_usable(log, column, least); });
}

std::string words_of(const DetectedLog& log) {
    if (!log.built_in.empty()) {
        return log.built_in;
    }
    const auto& dialect = log.dialect;
    std::string words = dialect.separator == ';'    ? "semicolons"
                        : dialect.separator == '\t' ? "tabs"
                        : dialect.separator == ' '  ? "blanks"
                        : dialect.separator == '|'  ? "vertical bars"
                                                    : "commas";
    words += dialect.decimal == ',' ? ", decimal commas" : "";
    words += dialect.has_header ? "" : ", no header";
    if (log.time) {
        words += fmt::format(", time in {}", unit_words(*log.time));
    }
    words += unit_words(log, "acc_z_mps2", "acceleration");
    words += unit_words(log, "gyro_z_radps", "rates");
    words += unit_words(log, "gnss_speed_mps", "GNSS speed");
    words += unit_words(log, "speed_mps", "speed");
    return words;
}

} // namespace macadam
