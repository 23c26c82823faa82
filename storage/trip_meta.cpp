#include "storage/trip_meta.hpp"

#include "estimator/common/error.hpp"
#include "storage/text.hpp"
#include "storage/utc.hpp"

#include <fmt/core.h>

#include <cmath>
#include <map>
#include <string_view>

namespace macadam {

namespace {

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

/// Numbers with blanks or commas between.
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
    if (std::abs(length - 1) > 0.01) { // two decimals are the least that anyone writes
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

/// A latency that a receiver or a bus can have.
double latency_s(const MetaLine& line) {
    constexpr double most_s = 60;
    const double value = number(line);
    if (std::abs(value) > most_s) {
        refuse(line, "a latency of at most 60 s");
    }
    return value;
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
    };
    return table;
}

} // namespace

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
