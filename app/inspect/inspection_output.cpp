#include "app/inspect/inspection_output.hpp"

#include "app/cli/console.hpp"
#include "app/cli/terminal_escape.hpp"

#include "storage/text/json.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

namespace macadam {
namespace {

std::string line(std::string_view term, const std::string& text) {
    return fmt::format("  {:<14} {}\n", term, printable_name(text));
}

std::string_view word(Confidence confidence) {
    return confidence == Confidence::sure ? "sure" : "likely";
}

std::string column_name(const DetectedLog& log, std::size_t column) {
    const auto& name = log.names.at(column - 1);
    return name.empty() ? fmt::format("column {}", column) : fmt::format("'{}'", name);
}

/// Columns that serve an import and were not found, or not for sure.
std::string missing_of(const DetectedLog& log, Confidence least) {
    return missing_measurements(log, needs_of_import(), least);
}

std::string columns_text(const DetectedLog& log) {
    std::string text = line("layout", words_of(log));
    if (log.time) {
        std::string names;
        for (const auto column : log.time->columns) {
            names += (names.empty() ? "" : " and ") + column_name(log, column);
        }
        text += line("time",
                     fmt::format("{}, {}; {}: {}",
                                 names,
                                 unit_words(*log.time),
                                 word(log.time->confidence),
                                 log.time->reason));
    }
    for (const auto& channel : log.channels) {
        text += line(channel.channel,
                     fmt::format("{}{}; {}: {}",
                                 column_name(log, channel.column),
                                 channel.unit.empty() ? "" : ", " + channel.unit,
                                 word(channel.confidence),
                                 channel.reason));
    }
    const auto missing = missing_of(log, Confidence::likely);
    const auto unsure = missing_of(log, Confidence::sure);
    if (!missing.empty()) {
        text += line("not found", missing);
    }
    if (!unsure.empty() && unsure != missing) {
        text += line("not sure", unsure);
    }
    return text;
}

std::string duration_text(double seconds) {
    const auto whole = static_cast<long>(std::llround(seconds));
    return whole >= 3600
               ? fmt::format("{}:{:02}:{:02} h", whole / 3600, whole / 60 % 60, whole % 60)
               : fmt::format("{}:{:02} min", whole / 60, whole % 60);
}

std::string rate_text(const SensorSummary& sensor) {
    auto text = fmt::format("{} at {:.4g} Hz", counted(sensor.readings, "reading"), sensor.rate_hz);
    if (sensor.gaps > 0) {
        text += fmt::format(
            ", {} (longest {:.1f} s)", counted(sensor.gaps, "gap"), sensor.longest_gap_s);
    }
    return text;
}

std::string acceleration_text(const TripSummary& trip) {
    auto text = rate_text(trip.acceleration);
    text += trip.gravity_mps2 > 0
                ? fmt::format("; gravity {:.2f} m/s2, included", trip.gravity_mps2)
            : !trip.gravity_stated ? "; gravity removed"
            : trip.distance_m      ? "; gravity not found"
                                   : ""; // not sought without a known motion
    if (trip.gravity_mps2 > 0) {
        text += fmt::format("; tilted by {:.0f} degrees{}",
                            trip.tilt_deg,
                            trip.mounting_is_estimated ? ", mounting estimated" : "");
    }
    return text;
}

std::string positions_text(const TripSummary& trip) {
    auto text = rate_text(trip.positions);
    if (trip.first_at) {
        text += fmt::format(" near {:.2f}, {:.2f}", trip.first_at->lat_deg, trip.first_at->lon_deg);
    }
    text += trip.accuracy_share > 0
                ? fmt::format("; accuracy stated for {:.0f} % (median {:.0f} m)",
                              100 * trip.accuracy_share,
                              trip.median_accuracy_m)
                : "; accuracy not stated";
    return text + fmt::format("; {}", trip.jumps == 0 ? "no jumps" : counted(trip.jumps, "jump"));
}

std::string estimates_text(const TripSummary& trip) {
    if (trip.gives_roughness && trip.gives_roads) {
        return "roughness along the trip (trace), the roads driven (match), a map (import)";
    }
    if (trip.gives_roughness) {
        return "roughness along the trip (trace); no roads, no map";
    }
    return trip.gives_roads ? "the roads driven (match); no roughness, no map" : "nothing";
}

std::string trip_text(const TripSummary& trip) {
    auto text = line(
        "duration",
        fmt::format(
            "{}, {}; {}{}",
            duration_text(trip.duration_s),
            trip.t0_utc_s ? "from " + utc_text(std::llround(*trip.t0_utc_s * 1000)) : "no date",
            counted(trip.rows, "row"),
            trip.unusable_rows > 0 ? fmt::format(", {} of them unusable", trip.unusable_rows)
                                   : ""));
    if (trip.acceleration.readings > 0) {
        text += line("acceleration", acceleration_text(trip));
    }
    if (trip.rates.readings > 0) {
        text += line("angular rates", rate_text(trip.rates));
    }
    if (trip.speed.readings > 0) {
        text += line("wheel speed", rate_text(trip.speed));
    }
    if (trip.positions.readings > 0) {
        text += line("positions", positions_text(trip));
    }
    if (!std::isnan(trip.max_speed_mps)) {
        text +=
            line("speed",
                 fmt::format(
                     "{:.0f} to {:.0f} km/h", trip.min_speed_mps * 3.6, trip.max_speed_mps * 3.6));
    }
    if (trip.distance_m) {
        text += line("distance", fmt::format("{:.2f} km", *trip.distance_m / 1000));
    }
    text += line("gives", estimates_text(trip));
    for (const auto& missing : trip.missing) {
        text += line("without", missing);
    }
    for (const auto& warning : trip.warnings) {
        text += line("note", warning);
    }
    return text;
}

std::string advice_of(const Inspection& found) {
    if (!found.detected) {
        return found.kind.advice;
    }
    if (!found.finds_columns()) {
        return "no column of a trip log was recognised; if it is one, write a mapping "
               "(docs/reference/other-loggers.md)";
    }
    if (found.detected->built_in.empty() && !found.is_sure()) {
        return "write the mapping with -o logger.toml, complete it, then: macadam import STORE "
               "FILE "
               "--mapping logger.toml";
    }
    if (found.trip && !found.trip->gives_roughness && !found.trip->gives_roads) {
        return "nothing can be estimated from this recording";
    }
    const bool is_import_sure = missing_of(*found.detected, Confidence::sure).empty();
    if (!is_import_sure && missing_of(*found.detected, Confidence::likely).empty()) {
        return "write the mapping with -o logger.toml, check it, then: macadam import STORE FILE "
               "--mapping logger.toml";
    }
    return is_import_sure ? "macadam import STORE FILE, which reads it as above"
                          : "macadam match or trace FILE, which read it as above";
}

JsonValue text_or_null(const std::string& text) {
    return text.empty() ? JsonValue{nullptr} : JsonValue{text};
}

std::string json_of(const SensorSummary& sensor) {
    return JsonObject{}
        .add("readings", static_cast<std::int64_t>(sensor.readings))
        .add("rate_hz", json_number(sensor.rate_hz, 3))
        .add("gaps", static_cast<std::int64_t>(sensor.gaps))
        .add("longest_gap_s", json_number(sensor.longest_gap_s, 3))
        .text();
}

std::string json_of(const DetectedLog& log) {
    std::vector<std::string> channels;
    const auto add = [&](const std::string& channel,
                         std::size_t column,
                         const std::string& unit,
                         Confidence confidence,
                         const std::string& reason) {
        channels.push_back(JsonObject{}
                               .add("channel", channel)
                               .add("column", static_cast<std::int64_t>(column))
                               .add("name", text_or_null(log.names.at(column - 1)))
                               .add("unit", text_or_null(unit))
                               .add("confidence", std::string{word(confidence)})
                               .add("reason", reason)
                               .text());
    };
    if (log.time) {
        for (const auto column : log.time->columns) {
            add("t_s", column, unit_words(*log.time), log.time->confidence, log.time->reason);
        }
    }
    for (const auto& channel : log.channels) {
        add(channel.channel, channel.column, channel.unit, channel.confidence, channel.reason);
    }
    return JsonObject{}
        .add("layout", words_of(log))
        .add("columns", JsonRaw{json_array(channels)})
        .add("not_found", text_or_null(missing_of(log, Confidence::likely)))
        .add("not_sure", text_or_null(missing_of(log, Confidence::sure)))
        .text();
}

std::string json_of(const TripSummary& trip) {
    const auto gravity = trip.gravity_mps2 > 0 ? std::optional{trip.gravity_mps2} : std::nullopt;
    return JsonObject{}
        .add("t0_utc",
             trip.t0_utc_s ? JsonValue{utc_text(std::llround(*trip.t0_utc_s * 1000))}
                           : JsonValue{nullptr})
        .add("duration_s", json_number(trip.duration_s, 3))
        .add("rows", static_cast<std::int64_t>(trip.rows))
        .add("unusable_rows", static_cast<std::int64_t>(trip.unusable_rows))
        .add("acceleration", JsonRaw{json_of(trip.acceleration)})
        .add("angular_rates", JsonRaw{json_of(trip.rates)})
        .add("wheel_speed", JsonRaw{json_of(trip.speed)})
        .add("positions", JsonRaw{json_of(trip.positions)})
        .add("accuracy_share", json_number(trip.accuracy_share, 3))
        .add("median_accuracy_m", json_number(trip.median_accuracy_m, 1))
        .add("jumps", static_cast<std::int64_t>(trip.jumps))
        .add("gravity_mps2", json_number(gravity, 3))
        .add("tilt_deg", json_number(trip.tilt_deg, 1))
        .add("min_speed_mps", json_number(trip.min_speed_mps, 2))
        .add("max_speed_mps", json_number(trip.max_speed_mps, 2))
        .add("distance_m", json_number(trip.distance_m, 1))
        .add("gives_roughness", trip.gives_roughness)
        .add("gives_roads", trip.gives_roads)
        .add("missing", JsonRaw{json_string_array(trip.missing)})
        .add("warnings", JsonRaw{json_string_array(trip.warnings)})
        .text();
}

} // namespace

std::string inspection_text(const Inspection& found) {
    const auto kind = found.kind.name.empty() ? "cannot be read" : found.kind.name;
    auto text = fmt::format("{}: {}\n", printable_name(found.name), printable_name(kind));
    text += found.detected ? columns_text(*found.detected) : "";
    text += found.trip ? trip_text(*found.trip) : "";
    text += found.error.empty() ? "" : line("error", found.error);
    const auto advice = advice_of(found);
    const bool is_unknown = found.kind.use == FileKind::Use::unknown;
    return text + (advice.empty() || !found.error.empty()
                       ? ""
                       : line(is_unknown ? "reason" : "next", advice));
}

std::string inspection_json(const Inspection& found) {
    return JsonObject{}
        .add("file", found.name)
        .add("kind", text_or_null(found.kind.name))
        .add("next", text_or_null(advice_of(found)))
        .add("detected",
             found.detected ? JsonValue{JsonRaw{json_of(*found.detected)}} : JsonValue{nullptr})
        .add("sure", found.is_sure())
        .add("trip", found.trip ? JsonValue{JsonRaw{json_of(*found.trip)}} : JsonValue{nullptr})
        .add("mapping", text_or_null(found.mapping))
        .add("error", text_or_null(found.error))
        .text();
}

} // namespace macadam
