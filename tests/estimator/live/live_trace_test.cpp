#include "estimator/roughness/roughness_mean.hpp"
#include "live_drive.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace macadam::testing {
namespace {

using ::testing::Each;
using ::testing::Field;
using ::testing::Gt;
using ::testing::Le;
using ::testing::SizeIs;

constexpr double max_lag_s = 2;

double steady(double) {
    return 20;
}

/// Half a minute of driving, ten seconds of standing, and again.
double stopping(double t_s) {
    const double phase_s = std::fmod(t_s, 50.0);
    return phase_s < 5 ? 3 * phase_s : phase_s < 35 ? 15 : phase_s < 40 ? 3 * (40 - phase_s) : 0;
}

double from_slow_to_fast(double t_s) {
    return 6 + 0.4 * t_s;
}

Vehicle car() {
    return *built_in_vehicle("generic");
}

LiveConfig filter_config(double length_m = 20) {
    auto config = live_config(Method::kf);
    config.length_m = length_m;
    return config;
}

/// How long after the rear axle had left each row's end it was told, s of the log.
std::vector<double> lags_of(const TripLog& trip, const LiveConfig& config) {
    std::vector<double> lags_s;
    told_live(trip, car(), config, [&](const LiveTrace& live, const std::vector<LiveRow>& told) {
        for (const auto& row : told) {
            lags_s.push_back(live.now_s() - row.left_s);
        }
    });
    return lags_s;
}

/// The same trip without the samples between two times.
TripLog with_silence(const TripLog& trip, double from_s, double to_s) {
    TripLog kept;
    for (std::size_t i = 0; i < trip.acc.t_s.size(); ++i) {
        if (trip.acc.t_s[i] <= from_s || trip.acc.t_s[i] >= to_s) {
            kept.acc.t_s.push_back(trip.acc.t_s[i]);
            kept.acc.x.push_back(trip.acc.x[i]);
            kept.acc.y.push_back(trip.acc.y[i]);
            kept.acc.z.push_back(trip.acc.z[i]);
        }
    }
    kept.speed = trip.speed;
    kept.meta = trip.meta;
    return kept;
}

std::uint8_t validity_of(const LiveRow& row) {
    return row.mean.validity;
}

} // namespace

TEST(LiveTrace, TellsEveryRowWithinTwoSecondsOfTheRearAxle) {
    const auto lags_s = lags_of(humming_trip(60, steady), filter_config());
    EXPECT_THAT(lags_s, SizeIs(Gt(50U)));
    EXPECT_THAT(lags_s, Each(Le(max_lag_s)));
}

TEST(LiveTrace, TellsInTimeWhileTheSpeedChanges) {
    EXPECT_THAT(lags_of(humming_trip(60, from_slow_to_fast), filter_config()), Each(Le(max_lag_s)));
}

TEST(LiveTrace, TellsShortRowsInTime) {
    EXPECT_THAT(lags_of(humming_trip(30, steady), filter_config(1)), Each(Le(max_lag_s)));
}

TEST(LiveTrace, TellsLongRowsInTime) {
    const auto lags_s = lags_of(humming_trip(60, steady), filter_config(250));
    EXPECT_THAT(lags_s, SizeIs(4));
    EXPECT_THAT(lags_s, Each(Le(max_lag_s)));
}

TEST(LiveTrace, WaitsForASecondOfWhatComesLater) {
    EXPECT_THAT(lags_of(humming_trip(60, steady), filter_config()), Each(::testing::Ge(1.0)));
}

TEST(LiveTrace, SaysAtOnceWhatItWouldSayOfTheTripSoFar) {
    const auto trip = humming_trip(40, steady);
    std::vector<LiveRow> whole;
    told_live(trip, car(), filter_config(), [&](const LiveTrace&, const std::vector<LiveRow>& t) {
        whole.insert(whole.end(), t.begin(), t.end());
    });
    auto cut = trip;
    cut.acc.t_s.resize(1500); // half a minute
    cut.speed.t_s.resize(300);
    std::vector<LiveRow> part;
    told_live(cut, car(), filter_config(), [&](const LiveTrace&, const std::vector<LiveRow>& t) {
        part.insert(part.end(), t.begin(), t.end());
    });
    ASSERT_GT(part.size(), 20U);
    for (std::size_t i = 0; i < part.size(); ++i) {
        EXPECT_EQ(part[i].mean.hri_mm_per_m, whole[i].mean.hri_mm_per_m);
    }
}

/// The filter's state settles within a fraction of the window, and its zero-phase filters ring for
/// less than the second that is waited for. What is left is the mean of a window, which is not that
/// of the trip: 2 % where a window is full, 10 % in the first ten seconds.
TEST(LiveTrace, SaysWhatTheWholeTripSays) {
    const auto trip = humming_trip(60, steady);
    const auto config = filter_config();
    const auto offline = offline_trace(trip, car(), config);
    const auto rows = told_live(trip, car(), config);
    ASSERT_GT(rows.size(), 50U); // 1.2 km in rows of 20 m
    int estimated = 0;
    for (const auto& row : rows) {
        const auto mean = mean_over(offline.trace, row.from_m, row.to_m, car());
        EXPECT_EQ(validity_of(row), mean.validity) << row.from_m;
        if (mean.validity == validity::ok && row.to_m < 1150) {
            ++estimated;
            EXPECT_NEAR(
                *row.mean.hri_mm_per_m / *mean.hri_mm_per_m, 1, row.from_m < 200 ? 0.1 : 0.02)
                << row.from_m;
        }
    }
    EXPECT_GT(estimated, 40);
}

TEST(LiveTrace, TellsAsManyRowsAsTheWholeTrip) {
    // 1200 m less the last fifth of a second without a speed.
    EXPECT_THAT(told_live(humming_trip(60, steady), car(), filter_config()), SizeIs(59));
}

TEST(LiveTrace, NamesStopsAndStarts) {
    const auto trip = humming_trip(150, stopping);
    const auto config = filter_config();
    const auto offline = offline_trace(trip, car(), config);
    std::size_t slow = 0;
    std::size_t start_up = 0;
    for (const auto& row : told_live(trip, car(), config)) {
        const auto mean = mean_over(offline.trace, row.from_m, row.to_m, car());
        EXPECT_EQ(name_of_validity(row.mean.validity), name_of_validity(mean.validity))
            << row.from_m;
        slow += (row.mean.validity & validity::too_slow) != 0 ? 1 : 0;
        start_up += (row.mean.validity & validity::start_up) != 0 ? 1 : 0;
    }
    EXPECT_GE(slow, 3U); // one or more at each stop
    EXPECT_GE(start_up, 6U);
}

TEST(LiveTrace, NamesAGapOfTheVibration) {
    const auto rows =
        told_live(with_silence(humming_trip(60, steady), 20, 24), car(), filter_config());
    // From 400 to 480 m nothing was felt.
    EXPECT_EQ(name_of_validity(validity_of(rows.at(21))), "gap");
    EXPECT_EQ(name_of_validity(validity_of(rows.at(19))), "ok");
    EXPECT_EQ(name_of_validity(validity_of(rows.at(25))), "start_up");
    EXPECT_EQ(name_of_validity(validity_of(rows.at(30))), "ok");
}

TEST(LiveTrace, TellsOfAGapInTimeWhileSpeedsGoOn) {
    EXPECT_THAT(lags_of(with_silence(humming_trip(60, steady), 30, 40), filter_config()),
                Each(Le(max_lag_s)));
}

TEST(LiveTrace, KeepsSamplesOfAFewMinutesOnly) {
    std::size_t most = 0;
    told_live(humming_trip(240, [](double) { return 4.0; }),
              car(),
              filter_config(),
              [&](const LiveTrace& live, const std::vector<LiveRow>&) {
                  most = std::max(most, live.recent().acc.t_s.size());
              });
    EXPECT_LE(most, 90U * 50); // 75 s, and what gathers in between
}

TEST(LiveTrace, PutsAPlaceToEveryRow) {
    auto trip = humming_trip(60, steady);
    trip.meta.gnss_latency_stated = true;
    trip.meta.gnss_latency_s = 1;
    const GeoPoint start{48, 11};
    const auto north_deg = [](double travel_m) { return 48 + travel_m / 111194.9; };
    for (int i = 0; i < 60; ++i) {
        // The stamp is a second late.
        trip.fixes.push_back({.t_s = i + 1.0,
                              .at = {north_deg(20.0 * i), start.lon_deg},
                              .speed_mps = 20,
                              .course_deg = 0,
                              .accuracy_m = 2});
    }
    const auto rows = told_live(trip, car(), filter_config());
    ASSERT_GT(rows.size(), 50U); // 1.2 km in rows of 20 m
    for (std::size_t i = 3; i < rows.size(); ++i) {
        ASSERT_TRUE(rows[i].at.has_value()) << rows[i].from_m;
        // A tenth of a metre for the odometer's first knot and the earth's shape.
        EXPECT_NEAR((rows[i].at->lat_deg - north_deg(rows[i].from_m + 10)) * 111194.9, 0, 0.2);
    }
}

} // namespace macadam::testing
