#pragma once

#include "storage/tables/toml.hpp"
#include "storage/trips/log/trip_row.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace macadam {

/// Keys of a mapping that stand for lines in the head of a trip log.
inline constexpr std::array<std::string_view, 9> meta_keys{"vehicle_id",
                                                           "frame",
                                                           "gravity",
                                                           "mount",
                                                           "mount_rpy_deg",
                                                           "gnss_latency_s",
                                                           "speed_latency_s",
                                                           "speed_scale",
                                                           "gnss_antenna_pos_m"};

inline constexpr std::int64_t max_columns = 10000;
inline constexpr double hour_s = 3600;

/// Words of the key `epoch`: whether times count since 1970.
inline constexpr std::pair<std::string_view, bool> epoch_words[] = {{"boot", false},
                                                                    {"unix", true}};

/// Value of a key that must be one of several words.
///
/// \throws InputError  "file:line: ..." with the words, for another one.
template <typename Value, std::size_t count>
Value one_of(const TomlTable& table,
             std::string_view key,
             const std::pair<std::string_view, Value> (&words)[count]) {
    const auto text = table.text(key);
    std::string expected;
    for (const auto& [word, value] : words) {
        if (word == text) {
            return value;
        }
        expected += fmt::format("{}{}", expected.empty() ? "" : ", ", word);
    }
    table.refuse(key, "one of " + expected);
}

/// Channel that a key of `[channels]` names; the value is a table with `expected_key`.
///
/// \throws InputError  "file:line: ..." for an unknown channel, or text in place of a table.
TripColumn
known_channel(const TomlTable& channels, const std::string& name, std::string_view expected_key);

/// Axes of the sensor as 1, 2, 3 for x, y, z, negative where turned, by the key `axes`.
///
/// \throws InputError  "file:line: ..." unless it has each axis once.
std::array<int, 3> axes_of(const TomlTable& table);

} // namespace macadam
