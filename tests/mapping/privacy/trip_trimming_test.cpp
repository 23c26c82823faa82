#include "mapping/privacy/trip_trimming.hpp"

#include "estimator/common/geo.hpp"
#include "mapping/privacy/kept_passes.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace macadam {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr GeoPoint home{47.5, 19.0};
constexpr double speed_mps = 10;
constexpr double lat_m = 111'180; // metres per degree there, about
constexpr double lon_m = 75'300;

GeoPoint at(double east_m, double north_m) {
    return {home.lat_deg + north_m / lat_m, home.lon_deg + east_m / lon_m};
}

/// A drive at constant speed along a line, with a fix and a knot each second.
struct RecordedDrive {
    TripLog trip;
    Odometer::Knots knots;

    void go(double length_m, const std::function<GeoPoint(double)>& place) {
        const double begin_m = knots.travel_m.empty() ? 0 : knots.travel_m.back();
        for (double gone_m = 0; gone_m <= length_m; gone_m += speed_mps) {
            add(gone_m == 0 && !knots.t_s.empty() ? 0 : 1, begin_m + gone_m, place(gone_m));
        }
    }
    void stand(double seconds) {
        for (double s = 0; s < seconds; ++s) {
            add(1, knots.travel_m.back(), trip.fixes.back().at);
        }
    }
    void be_silent(double seconds) { t_s += seconds; }

    std::vector<TravelSpan> kept(double drawn = 0.5) const {
        return kept_parts(trip,
                          Odometer{knots},
                          {.min_m = 300,
                           .random_m = 200,
                           .hides_places = true,
                           .draw = [=](const std::string&, std::size_t) { return drawn; }});
    }

private:
    void add(double step_s, double travel_m, const GeoPoint& place) {
        if (step_s == 0) {
            return;
        }
        t_s += step_s;
        knots.t_s.push_back(t_s);
        knots.travel_m.push_back(travel_m);
        knots.speed_mps.push_back(static_cast<float>(speed_mps));
        knots.reversing.push_back(0);
        trip.fixes.push_back({t_s, place, 10, 0, 3});
    }
    double t_s = 0;
};

GeoPoint straight(double gone_m) {
    return at(gone_m, 0);
}

TEST(TripTrimming, LeavesOutTheDrawnLengthAtBothEnds) {
    RecordedDrive drive;
    drive.trip.meta.gnss_latency_s = 0;
    drive.go(2000, straight);
    const auto parts = drive.kept(0.5);
    ASSERT_THAT(parts, SizeIs(1));
    EXPECT_NEAR(parts[0].from_m, 410, 11);
    EXPECT_NEAR(parts[0].to_m, 1590, 11);
}

TEST(TripTrimming, NeverTellsLessThanThreeHundredMetres) {
    RecordedDrive drive;
    drive.go(2000, straight);
    EXPECT_GE(drive.kept(0)[0].from_m, 300);
    EXPECT_LE(drive.kept(0.999)[0].from_m, 520);
}

TEST(TripTrimming, CountsByAirWhereTheRoadWinds) {
    RecordedDrive drive;
    drive.go(1200, [](double gone_m) { // to and fro before the house: 60 m there, 60 m back
        const double along = std::fmod(gone_m, 120);
        return at(along < 60 ? along : 120 - along, 0);
    });
    const auto from_m = 1200.0;
    drive.go(2000, straight);
    const auto parts = drive.kept(0);
    ASSERT_THAT(parts, SizeIs(1));
    EXPECT_GE(parts[0].from_m, from_m + 295);
}

TEST(TripTrimming, LeavesOutBothSidesOfALongStop) {
    RecordedDrive drive;
    drive.go(2000, straight);
    drive.stand(400);
    drive.go(2000, [](double gone_m) { return at(2000 + gone_m, 0); });
    const auto parts = drive.kept(0);
    ASSERT_THAT(parts, SizeIs(2));
    EXPECT_LE(parts[0].to_m, 1710);
    EXPECT_GE(parts[1].from_m, 2290);
}

TEST(TripTrimming, TakesALongSilenceForAStop) {
    RecordedDrive drive;
    drive.go(2000, straight);
    drive.be_silent(600);
    drive.go(2000, [](double gone_m) { return at(2000 + gone_m, 0); });
    EXPECT_THAT(drive.kept(), SizeIs(2));
}

TEST(TripTrimming, LeavesShortStopsAlone) {
    RecordedDrive drive;
    drive.go(2000, straight);
    drive.stand(200);
    drive.go(2000, [](double gone_m) { return at(2000 + gone_m, 0); });
    EXPECT_THAT(drive.kept(), SizeIs(1));
}

TEST(TripTrimming, KeepsNothingOfAShortTrip) {
    RecordedDrive drive;
    drive.go(550, straight);
    EXPECT_THAT(drive.kept(), IsEmpty());
}

TEST(TripTrimming, KeepsNothingOfATripThatStaysNearItsBegin) {
    RecordedDrive drive;
    drive.go(6000, [](double gone_m) {
        return at(100 * std::cos(gone_m / 100), 100 * std::sin(gone_m / 100));
    });
    EXPECT_THAT(drive.kept(), IsEmpty());
}

TEST(TripTrimming, IgnoresAFixThatJumpsAway) {
    RecordedDrive drive;
    drive.go(2000, straight);
    drive.trip.fixes[3].at = at(5000, 0);
    EXPECT_GE(drive.kept(0)[0].from_m, 300);
}

TEST(TripTrimming, LeavesAllWhereNothingIsAskedFor) {
    RecordedDrive drive;
    drive.go(2000, straight);
    const auto parts = kept_parts(drive.trip, Odometer{drive.knots}, {});
    ASSERT_THAT(parts, SizeIs(1));
    EXPECT_EQ(parts[0].from_m, 0);
}

// -------------------------------------------------------------------------- after the fact

std::vector<PassedSegment> passes_along(int count, std::int64_t pause_ms = 0) {
    std::vector<PassedSegment> passed;
    for (int i = 0; i < count; ++i) {
        passed.push_back({2000 * i + (i >= count / 2 ? pause_ms : 0),
                          20,
                          at(20.0 * i, 0),
                          at(20.0 * (i + 1), 0)});
    }
    return passed;
}

TEST(KeptPasses, LieBeyondTheDrawnLengthFromTheFirstAndTheLast) {
    const auto kept = kept_passes(passes_along(100), [](std::size_t) { return 300.0; });
    EXPECT_EQ(std::ranges::count(kept, true), 70);
    EXPECT_FALSE(kept[14]);
    EXPECT_TRUE(kept[16]);
    EXPECT_FALSE(kept[86]);
}

TEST(KeptPasses, LieFarFromPausesToo) {
    const auto kept = kept_passes(passes_along(100, 400'000), [](std::size_t) { return 300.0; });
    EXPECT_EQ(std::ranges::count(kept, true), 40);
    EXPECT_FALSE(kept[50]);
}

} // namespace
} // namespace macadam
