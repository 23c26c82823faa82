#include "storage/trips/log/trip_meta.hpp"

#include "estimator/common/error.hpp"
#include "storage/text/text.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <string_view>

namespace macadam {

namespace {

constexpr auto trimmed_key = "trimmed_m";

[[noreturn]] void refuse(const MetaLine& line, std::string_view expected) {
    throw InputError{fmt::format(
        "{}: key '{}' is {}, expected {}", line.where, line.key, in_quotes(line.value), expected)};
}

double number(const MetaLine& line) {
    const auto value = parse_number(line.value);
    if (!value || !std::isfinite(*value)) {
        refuse(line, "a number");
    }
    return *value;
}

double positive_number(const MetaLine& line) {
    const auto value = number(line);
    if (value <= 0) {
        refuse(line, "a number above 0");
    }
    return value;
}

/// Parses numbers separated by blanks or commas.
template <std::size_t count>
std::array<double, count> numbers(const MetaLine& line, std::string_view expected) {
    std::array<double, count> values{};
    std::string_view rest = line.value;
    for (auto& value : values) {
        rest = trimmed(rest);
        const auto size = std::min(rest.find_first_of(", \t"), rest.size());
        const auto found = parse_number(rest.substr(0, size));
        if (!found || !std::isfinite(*found)) {
            refuse(line, expected);
        }
        value = *found;
        rest = trimmed(rest.substr(size));
        if (rest.starts_with(',')) {
            rest.remove_prefix(1);
        }
    }
    if (!trimmed(rest).empty()) {
        refuse(line, expected);
    }
    return values;
}

std::array<double, 3> three_numbers(const MetaLine& line) {
    return numbers<3>(line, "three numbers");
}

std::array<double, 4> unit_quaternion(const MetaLine& line) {
    constexpr std::string_view expected = "four numbers, w x y z of length 1";
    const auto q = numbers<4>(line, expected);
    const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
    if (std::abs(length - 1) > 0.01) { // tolerates values with two decimals
        refuse(line, expected);
    }
    return {q[0] / length, q[1] / length, q[2] / length, q[3] / length};
}

Frame frame(const MetaLine& line) {
    if (line.value == "FLU") {
        return Frame::flu;
    }
    if (line.value == "FRD") {
        return Frame::frd;
    }
    if (line.value == "sensor") {
        return Frame::sensor;
    }
    refuse(line, "FLU, FRD or sensor");
}

bool gravity_included(const MetaLine& line) {
    if (line.value != "included" && line.value != "removed") {
        refuse(line, "included or removed");
    }
    return line.value == "included";
}

double utc_s(const MetaLine& line) {
    const auto time = parse_utc_s(line.value);
    if (!time) {
        refuse(line, "a time like 2018-08-02T16:14:48.225Z or unknown");
    }
    return *time;
}

/// Parses a plausible latency of a receiver or bus.
double latency_s(const MetaLine& line) {
    constexpr double max_s = 60;
    const double value = number(line);
    if (std::abs(value) > max_s) {
        refuse(line, "a latency of at most 60 s");
    }
    return value;
}

/// Parses a length that may be 0.
double length_m(const MetaLine& line) {
    const double value = number(line);
    if (value < 0) {
        refuse(line, "a length of 0 m or more");
    }
    return value;
}

/// Keeps a checked key under its name: few commands need it.
void keep(TripMeta& meta, const MetaLine& line) {
    meta.other[line.key] = line.value;
}

using Setter = void (*)(TripMeta&, const MetaLine&);

const std::map<std::string_view, Setter>& setters() {
    using M = TripMeta;
    using L = MetaLine;
    static const std::map<std::string_view, Setter> table{
        {"trip_id", [](M& meta, const L& line) { meta.trip_id = line.value; }},
        {"vehicle_id", [](M& meta, const L& line) { meta.vehicle_id = line.value; }},
        {"t0_utc", [](M& meta, const L& line) { meta.t0_utc_s = utc_s(line); }},
        {"frame",
         [](M& meta, const L& line) {
             meta.frame = frame(line);
             meta.frame_stated = true;
         }},
        {"gravity", [](M& meta, const L& line) { meta.gravity_included = gravity_included(line); }},
        {"mount_rpy_deg", [](M& meta, const L& line) { meta.mount_rpy_deg = three_numbers(line); }},
        {"mount_quat", [](M& meta, const L& line) { meta.mount_quat = unit_quaternion(line); }},
        {"acc_sensor_pos_m",
         [](M& meta, const L& line) { meta.acc_sensor_pos_m = three_numbers(line); }},
        {"gnss_antenna_pos_m",
         [](M& meta, const L& line) { meta.gnss_antenna_pos_m = three_numbers(line); }},
        {"gnss_latency_s",
         [](M& meta, const L& line) {
             meta.gnss_latency_s = latency_s(line);
             meta.gnss_latency_stated = true;
         }},
        {"speed_latency_s", [](M& meta, const L& line) { meta.speed_latency_s = latency_s(line); }},
        {"speed_scale", [](M& meta, const L& line) { meta.speed_scale = positive_number(line); }},
        {std::string_view{trimmed_key},
         [](M& meta, const L& line) {
             static_cast<void>(length_m(line));
             keep(meta, line);
         }},
    };
    return table;
}

/// Text as it will be read: without line breaks, then without blanks at its ends.
std::string on_one_line(std::string text) {
    std::ranges::replace_if(
        text, [](char c) { return c == '\n' || c == '\r' || c == '\0'; }, ' ');
    return std::string{trimmed(text)};
}

std::string meta_line(std::string_view key, std::string_view value) {
    return fmt::format(
        "# {}: {}\n", on_one_line(std::string{key}), on_one_line(std::string{value}));
}

std::string meta_line(std::string_view key, std::span<const double> numbers) {
    return meta_line(key, fmt::format("{}", fmt::join(numbers, " ")));
}

std::string_view name_of(Frame frame) {
    switch (frame) {
    case Frame::flu:
        return "FLU";
    case Frame::frd:
        return "FRD";
    case Frame::sensor:
        break;
    }
    return "sensor";
}

/// Formats a time to the millisecond if that is exact, otherwise to the microsecond.
std::string utc_text_of(double utc_s) {
    if (auto text = utc_text(std::llround(utc_s * 1e3)); parse_utc_s(text) == utc_s) {
        return text;
    }
    const auto utc_us = std::llround(utc_s * 1e6);
    const auto whole_s = static_cast<std::int64_t>(std::floor(static_cast<double>(utc_us) / 1e6));
    auto text = utc_text(1000 * whole_s);
    text.pop_back(); // without the Z
    return text + fmt::format(".{:06}Z", utc_us - 1'000'000 * whole_s);
}

} // namespace

std::string meta_text(const TripMeta& meta) {
    std::string text;
    const auto add = [&](std::string_view key, const auto& value) {
        text += meta_line(key, value);
    };
    if (!meta.trip_id.empty()) {
        add("trip_id", meta.trip_id);
    }
    if (!meta.vehicle_id.empty()) {
        add("vehicle_id", meta.vehicle_id);
    }
    add("t0_utc", meta.t0_utc_s ? utc_text_of(*meta.t0_utc_s) : "unknown");
    if (meta.frame_stated) {
        add("frame", name_of(meta.frame));
    }
    add("gravity", std::string_view{meta.gravity_included ? "included" : "removed"});
    if (meta.mount_auto) {
        add("mount", std::string_view{"auto"});
    }
    if (meta.mount_rpy_deg) {
        add("mount_rpy_deg", *meta.mount_rpy_deg);
    }
    if (meta.mount_quat) {
        add("mount_quat", *meta.mount_quat);
    }
    if (meta.acc_sensor_pos_m) {
        add("acc_sensor_pos_m", *meta.acc_sensor_pos_m);
    }
    if (meta.gnss_antenna_pos_m) {
        add("gnss_antenna_pos_m", *meta.gnss_antenna_pos_m);
    }
    if (meta.gnss_latency_stated) {
        add("gnss_latency_s", fmt::format("{}", meta.gnss_latency_s));
    }
    if (meta.speed_latency_s != 0) {
        add("speed_latency_s", fmt::format("{}", meta.speed_latency_s));
    }
    if (meta.speed_scale) {
        add("speed_scale", fmt::format("{}", *meta.speed_scale));
    }
    for (const auto& [key, value] : meta.other) {
        add(key, value);
    }
    return text;
}

double trimmed_before_m(const TripMeta& meta) {
    constexpr double most_m = 1e6; // more says no more
    const auto stated = meta.other.find(trimmed_key);
    const double stated_m =
        stated == meta.other.end() ? 0 : parse_number(stated->second).value_or(0);
    return stated_m > 0 ? std::min(stated_m, most_m) : 0; // also for what is no number
}

TripMeta parse_meta(const std::vector<MetaLine>& lines) {
    TripMeta meta;
    for (const auto& line : lines) {
        const auto setter = setters().find(line.key);
        if (line.key == "mount" && line.value == "auto") {
            meta.mount_auto = true;
        } else if (setter == setters().end()) {
            meta.other[line.key] = line.value;
        } else if (!line.value.empty() && line.value != "unknown") {
            setter->second(meta, line);
        }
    }
    return meta;
}

} // namespace macadam
