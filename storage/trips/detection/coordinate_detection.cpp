#include "storage/trips/detection/coordinate_detection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace macadam {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double largest_extent_deg = 10; // of a trip

bool varies(const LogColumn& column) {
    const auto [low, high] = nonzero_range(column.values);
    return high > low;
}

/// Column beside a coordinate that holds only the two letters of a hemisphere; null if there is
/// none, or if the coordinate has a sign already.
const LogColumn*
hemisphere_column(const LogTable& table, const LogColumn& coordinate, std::string_view letters) {
    if (nonzero_range(coordinate.values).first < 0) {
        return nullptr;
    }
    const auto is_letter = [&](const std::string& text) {
        return text.empty() ||
               (text.size() == 1 && letters.find(text.front()) != std::string_view::npos);
    };
    const auto found = std::ranges::find_if(table.columns, [&](const LogColumn& column) {
        const bool is_beside =
            column.number == coordinate.number + 1 || column.number + 1 == coordinate.number;
        return is_beside && !column.texts.empty() && std::ranges::all_of(column.texts, is_letter);
    });
    return found == table.columns.end() ? nullptr : &*found;
}

double degrees_of(double value, const DetectedChannel& channel) {
    if (channel.unit != "ddmm.mmmm") {
        return value * channel.scale * channel.sign;
    }
    const double whole = std::trunc(value / 100);
    return whole + (value - 100 * whole) / 60;
}

/// \param hemisphere  its column; null: none
void set_degrees(Coordinate& coordinate, const LogColumn& column, const LogColumn* hemisphere) {
    constexpr std::string_view negative{"SWsw"};
    for (std::size_t i = 0; i < column.values.size(); ++i) {
        const double value = column.values[i];
        const bool is_negated = hemisphere != nullptr && !hemisphere->texts[i].empty() &&
                                negative.find(hemisphere->texts[i].front()) != negative.npos;
        const double deg = value == 0 ? unknown : degrees_of(value, coordinate.channel);
        coordinate.deg.push_back(is_negated ? -deg : deg);
    }
}

double largest_of(const LogColumn& column) {
    const auto [low, high] = nonzero_range(column.values);
    return std::max(std::abs(low), std::abs(high));
}

/// Tests whether two columns can be degrees. Both are written alike: near Greenwich, minutes of a
/// longitude would pass for degrees.
bool may_be_degrees(const LogColumn& lat, const LogColumn& lon) {
    const auto fits = [](double largest, double limit) {
        return largest <= limit || std::isinf(largest);
    };
    return fits(largest_of(lat), 90) && fits(largest_of(lon), 180);
}

bool are_minutes(const std::vector<double>& values) {
    return std::ranges::all_of(
        values, [](double v) { return std::isnan(v) || std::fmod(std::abs(v), 100) < 60; });
}

Coordinate coordinate_of(const LogTable& table,
                         const LogColumn& column,
                         bool is_latitude,
                         bool may_be_degrees,
                         double whole_scale) {
    const double limit = is_latitude ? 90 : 180;
    const auto [low, high] = nonzero_range(column.values);
    const double largest = std::max(std::abs(low), std::abs(high));
    Coordinate read{.channel = {.channel = is_latitude ? "lat_deg" : "lon_deg",
                                .column = column.number,
                                .unit = ""},
                    .deg = {}};
    auto& channel = read.channel;
    const auto* const hemisphere = hemisphere_column(table, column, is_latitude ? "NSns" : "EWew");
    if (hemisphere != nullptr) {
        channel.hemisphere = hemisphere->number;
    }
    const bool is_whole = are_whole(column.values);
    const bool is_vbox = table.dialect.names.front() == "sats";
    if (may_be_degrees && largest <= limit && (!is_whole || !varies(column))) {
        channel.confidence = is_vbox ? Confidence::likely : Confidence::sure;
        channel.reason = fmt::format("{:.2f} to {:.2f} degrees", low, high);
    } else if (is_vbox && largest <= limit * 60) {
        channel.scale = 1.0 / 60;
        channel.sign = is_latitude ? 1 : -1; // west is positive
        channel.confidence = Confidence::sure;
        channel.reason = "minutes, as VBOX writes them";
    } else if (largest < limit * 100 && are_minutes(column.values) && !is_whole) {
        channel.unit = "ddmm.mmmm";
        channel.confidence = channel.hemisphere ? Confidence::sure : Confidence::likely;
        channel.reason = "degrees and minutes as in NMEA";
    } else if (is_whole && largest >= 1e5) {
        channel.scale = whole_scale;
        channel.confidence = largest * whole_scale <= limit && whole_scale == 1e-7
                                 ? Confidence::sure
                                 : Confidence::likely;
        channel.reason = fmt::format("whole numbers of {:g} degrees", channel.scale);
    } else {
        channel.reason = fmt::format("{:g} to {:g} are no degrees", low, high);
    }
    set_degrees(read, column, hemisphere);
    if (high - low > largest_extent_deg / channel.scale) {
        channel.confidence = Confidence::likely;
        channel.reason += "; further apart than a trip is";
    }
    return read;
}

/// Scale of whole numbers, the same of both: the largest that is a position. That of 1e-7 is sure,
/// as others would lie beyond the poles or the antimeridian.
double whole_scale_of(const LogColumn& lat, const LogColumn& lon) {
    for (const double scale : {1e-5, 1e-6}) {
        if (largest_of(lat) * scale <= 90 && largest_of(lon) * scale <= 180) {
            return scale;
        }
    }
    return 1e-7;
}

} // namespace

Coordinates read_coordinates(const LogTable& table, const LogColumn& lat, const LogColumn& lon) {
    const double scale = whole_scale_of(lat, lon);
    const bool in_degrees = may_be_degrees(lat, lon);
    Coordinates read{coordinate_of(table, lat, true, in_degrees, scale),
                     coordinate_of(table, lon, false, in_degrees, scale)};
    if (!varies(lat) && !varies(lon)) {
        for (auto* const channel : {&read.latitude.channel, &read.longitude.channel}) {
            channel->confidence = Confidence::likely;
            channel->reason += "; always the same";
        }
    }
    return read;
}

} // namespace macadam
