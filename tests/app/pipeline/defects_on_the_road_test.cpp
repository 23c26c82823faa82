// What real logs do wrong, as far as it shows only when a car drives; see
// tests/storage/trips/foreign/defects_test.cpp for the rest.

#include "app/pipeline/pipeline.hpp"
#include "app/pipeline/trip_preparation.hpp"
#include "estimator/motion/trip_motion.hpp"

#include "estimator/common/error.hpp"
#include "estimator/motion/make_odometer.hpp"
#include "estimator/roughness/roughness_mean.hpp"
#include "support/roads/drive.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

namespace macadam::testing {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
constexpr double m_per_deg_lat = 111180; // at 47.7 degrees; good to 1e-4

const Vehicle& car() {
    return *built_in_vehicle("golden-car");
}

TripLog even_drive(const Drive& drive = {}) {
    return drive_over(patched_road([](double) { return false; }, 1), drive, car());
}

GnssFix fix(double t_s, double north_m, float speed_mps = unknown) {
    return {t_s, {47.7 + north_m / m_per_deg_lat, 17.6}, speed_mps, unknown, 5};
}

/// The trip with only those samples of vibration and speed whose number `is_kept`.
template <typename Kept>
TripLog only(TripLog trip, Kept is_kept) {
    TripLog rest = trip;
    rest.acc = {};
    rest.speed = {};
    for (std::size_t i = 0; i < trip.acc.t_s.size(); ++i) {
        if (is_kept(i)) {
            rest.acc.t_s.push_back(trip.acc.t_s[i]);
            rest.acc.x.push_back(trip.acc.x[i]);
            rest.acc.y.push_back(trip.acc.y[i]);
            rest.acc.z.push_back(trip.acc.z[i]);
        }
    }
    for (std::size_t i = 0; i < trip.speed.t_s.size(); ++i) {
        if (is_kept(i)) {
            rest.speed.t_s.push_back(trip.speed.t_s[i]);
            rest.speed.speed_mps.push_back(trip.speed.speed_mps[i]);
        }
    }
    return rest;
}

TripTrace traced(const TripLog& trip) {
    return trace_of(trip, motion_of(trip), car(), {});
}

double iri_between(const TripTrace& trace, double from_m, double to_m) {
    return mean_over(trace.roughness, from_m, to_m, car()).hri_mm_per_m.value_or(NAN);
}

TEST(Defect01Holes, AreNotBridged) {
    const auto whole = even_drive();
    const auto holed =
        only(whole, [&](std::size_t i) { return whole.acc.t_s[i] < 20 || whole.acc.t_s[i] > 30; });
    const auto trace = traced(holed);
    ASSERT_EQ(trace.roughness.runs.size(), 2U);
    EXPECT_TRUE(std::isnan(iri_between(trace, 420, 580))); // 20 m/s: the hole is 400 to 600 m
    EXPECT_FALSE(std::isnan(iri_between(trace, 200, 380)));
    EXPECT_FALSE(std::isnan(iri_between(trace, 700, 900)));
}

TEST(Defect05IrregularSpacing, GivesWhatEvenSpacingGives) {
    const auto fine = even_drive({.rate_hz = 1000});
    std::mt19937 random{5};
    std::size_t next = 0;
    const auto irregular = only(fine, [&](std::size_t i) { // 1 to 25 ms apart
        if (i < next) {
            return false;
        }
        next = i + 1 + (random() % 10 == 0 ? random() % 25 : random() % 9);
        return true;
    });
    const auto even = only(fine, [](std::size_t i) { return i % 5 == 0; });
    const double iri = iri_between(traced(even), 200, 900);
    // Cubics through such steps lose little of the waves above 2 m.
    EXPECT_NEAR(iri_between(traced(irregular), 200, 900), iri, 0.05 * iri);
}

TEST(Defect08Latency, OfTheReceiverIsFound) {
    TripLog trip;
    const auto speed = [](double t_s) {
        return 15 + 5 * std::sin(t_s / 7) + 3 * std::sin(t_s / 3);
    };
    for (int i = 0; i < 6000; ++i) {
        trip.speed.t_s.push_back(i * 0.05);
        trip.speed.speed_mps.push_back(static_cast<float>(speed(i * 0.05)));
    }
    for (int i = 3; i < 300; ++i) {
        trip.fixes.push_back(fix(i, 15.0 * i, static_cast<float>(speed(i - 1.1))));
    }
    EXPECT_NEAR(prepared(trip).trip.meta.gnss_latency_s, 1.1, 0.1);
}

/// Half a second of positions 60 m off, as beside a high wall, while the wheels turn steadily.
TEST(Defect10PositionJumps, NeitherLengthenTheTripNorCutIt) {
    auto trip = even_drive();
    std::size_t strays = 0;
    for (auto& one : trip.fixes) {
        if (one.t_s >= 30 && one.t_s < 30.5) {
            one.at.lat_deg += 60 / m_per_deg_lat;
            ++strays;
        }
    }
    ASSERT_EQ(strays, 5U);
    const auto trace = traced(trip);
    EXPECT_NEAR(trace.odometer.whole_m(), traced(even_drive()).odometer.whole_m(), 0.1);
    EXPECT_EQ(trace.roughness.runs.size(), 1U);
}

TEST(Defect10PositionJumps, OfKilometresAddNoTravelWithoutWheels) {
    TripLog trip;
    for (int i = 0; i <= 60; ++i) {
        trip.fixes.push_back(fix(i, 12.0 * i + (i == 30 || i == 31 ? 2400 : 0)));
    }
    const auto made = make_odometer(trip, {});
    EXPECT_NEAR(made.odometer.whole_m(), 720, 15);
    EXPECT_EQ(made.fixes.at(30), code(RowReason::implausible));
    EXPECT_EQ(made.fixes.at(31), code(RowReason::implausible));
}

TEST(Defect13SpeedBias, IsTakenOffByTheReceiver) {
    auto trip = even_drive();
    for (auto& speed : trip.speed.speed_mps) {
        speed *= 0.97F;
    }
    const auto trace = traced(trip);
    EXPECT_NEAR(trace.odometer.scale(), 1 / 0.97, 0.003);
    // 1000 m, and the 0.2 s before the first stamp of which the late receiver tells
    EXPECT_NEAR(trace.odometer.whole_m(), 1004, 2);
}

TEST(Defect14StopsAndReversing, GiveNoRoughness) {
    auto trip = even_drive();
    for (std::size_t i = 0; i < trip.speed.t_s.size(); ++i) {
        const double t_s = trip.speed.t_s[i];
        const double distance_s = std::abs(t_s - 30) - 5; // brakes from 22 s, stands from 25 to 35
        trip.speed.speed_mps[i] = static_cast<float>(
            std::clamp(20 * distance_s / 3, t_s > 28 && t_s < 32 ? -1.0 : 0.0, 20.0));
    }
    for (auto& one : trip.fixes) {
        one.at = {unknown, unknown};
        one.speed_mps = unknown;
    }
    const auto trace = traced(trip);
    EXPECT_EQ(trace.roughness.runs.size(), 2U);
    for (std::size_t i = 0; i < trip.acc.t_s.size(); ++i) {
        if (trip.acc.t_s[i] > 25 && trip.acc.t_s[i] < 35) {
            ASSERT_EQ(trace.use.acc[i], code(RowReason::too_slow)) << trip.acc.t_s[i];
        }
    }
}

TEST(Defect15PositionsAlone, TellTheWayAndNoSpeedWhereTheyAreRare) {
    TripLog trip;
    for (const double t_s : {0., 1., 3., 4., 6., 7., 9., 10., 71., 72., 73., 75.}) {
        trip.fixes.push_back(fix(t_s, 14 * t_s));
    }
    const auto odometer = make_odometer(trip, {}).odometer;
    EXPECT_NEAR(odometer.whole_m(), 1050, 5);
    EXPECT_NEAR(odometer.speed_mps(5), 14, 1.5);
    EXPECT_TRUE(std::isnan(odometer.speed_mps(40)));
}

TEST(Defect17PhoneMoved, LosesTheTimeInWhichItHungOtherwise) {
    auto trip = even_drive({.length_m = 4000});
    const double half_turn = std::numbers::pi / 3;
    for (std::size_t i = 0; i < trip.acc.t_s.size(); ++i) {
        if (trip.acc.t_s[i] >= 150) { // of 200 s
            trip.acc.x[i] = static_cast<float>(std::sin(half_turn) * double{trip.acc.z[i]});
            trip.acc.z[i] = static_cast<float>(std::cos(half_turn) * double{trip.acc.z[i]});
        }
    }
    const auto trace = traced(trip);
    EXPECT_THAT(trace.warnings, Contains(HasSubstr("the sensor moved during the trip")));
    EXPECT_EQ(trace.use.acc.back(), code(RowReason::sensor_moved));
    EXPECT_EQ(trace.use.acc[5000], 0);
    EXPECT_TRUE(std::isnan(iri_between(trace, 3700, 3900)));
}

TEST(Defect17PhoneMoved, IsNotSaidOfAPhoneAtRest) {
    EXPECT_THAT(traced(even_drive({.length_m = 4000})).warnings, Not(Contains(HasSubstr("moved"))));
}

TEST(Defect17PhoneMoved, ShowsInTheStrengthOfGravity) {
    auto trip = even_drive();
    for (auto& z : trip.acc.z) {
        z *= 0.85F;
    }
    EXPECT_THAT(traced(trip).warnings, Contains(HasSubstr("gravity measures 8.3")));
}

TEST(Defect20LowRates, AreRefusedBelow40HzAndWarnedOfBelow80) {
    try {
        traced(even_drive({.rate_hz = 10}));
        FAIL() << "took 10 Hz";
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(), "acceleration was sampled at 10.0 Hz, expected at least 40");
    }
    EXPECT_THAT(traced(even_drive({.rate_hz = 50})).warnings,
                Contains("acceleration was sampled at 50 Hz; short waves are missed below 80 Hz"));
}

} // namespace
} // namespace macadam::testing
