#include "storage/trips/signals/signal_rows.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace macadam::testing {
namespace {

TableMapping latitude_and_longitude() {
    TableMapping mapping;
    mapping.format = LogFormat::can;
    mapping.channels = {{.channel = TripColumn::lat, .column = {.pattern = "lat"}},
                        {.channel = TripColumn::lon, .column = {.pattern = "lon"}}};
    return mapping;
}

void add(SignalRows& rows, double t_s, std::uint16_t channel, double value) {
    rows.add(t_s, std::array{SignalRows::Value{channel, value}});
}

/// Longitudes of the rows with a latitude.
std::vector<double> longitudes(SignalRows& rows) {
    std::vector<double> lon_deg;
    rows.finish();
    while (const auto row = rows.next()) {
        if (!std::isnan(row->value[static_cast<std::size_t>(TripColumn::lat)])) {
            lon_deg.push_back(row->value[static_cast<std::size_t>(TripColumn::lon)]);
        }
    }
    return lon_deg;
}

TEST(SignalRows, InterpolateLongitudesOverTheAntimeridian) {
    SignalRows rows{latitude_and_longitude()};
    add(rows, 0, 1, 179.9);
    add(rows, 0.5, 0, -17);
    add(rows, 1, 1, -179.9);
    const auto lon_deg = longitudes(rows);
    ASSERT_EQ(lon_deg.size(), 1U);
    EXPECT_NEAR(std::abs(lon_deg[0]), 180, 1e-9);
}

TEST(SignalRows, KeepTheSamplesAfterOneWhoseTimeIsFarAhead) {
    SignalRows rows{latitude_and_longitude()};
    add(rows, 1e9, 1, 15);
    for (int i = 0; i < 10; ++i) {
        add(rows, i, 1, 16);
        add(rows, i + 0.5, 0, 48);
    }
    const auto lon_deg = longitudes(rows);
    ASSERT_EQ(lon_deg.size(), 10U);
    for (std::size_t i = 0; i + 1 < lon_deg.size(); ++i) {
        EXPECT_DOUBLE_EQ(lon_deg[i], 16);
    }
}

} // namespace
} // namespace macadam::testing
