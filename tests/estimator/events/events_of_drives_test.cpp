// Events of simulated cars, which are not what their files say, held beside the holes of the road.

#include "estimator/events/event_detection.hpp"
#include "estimator/reference_data.hpp"
#include "estimator/simulation/road_features.hpp"
#include "estimator/smoother/driven_road.hpp"
#include "estimator/smoother/smoothed_iri.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace macadam::testing {
namespace {

constexpr double length_m = 1500;
constexpr double begin_m = 25; // the first metres of a profile give no events, nor the last
constexpr double near_m = 2;
constexpr double deep_mm = 25;

/// Hole under one wheel track.
struct Hole {
    double at_m, depth_mm;
    WheelTrack track;
};

/// Road with the holes in it.
struct RoadWithHoles {
    RoadUnderWheels road;
    std::vector<Hole> holes;
};

RoadUnderWheels under_wheels(const WheelPaths& paths) {
    return {.step_m = paths.step_m,
            .left_m = {paths.left_m.begin(), paths.left_m.end()},
            .right_m = {paths.right_m.begin(), paths.right_m.end()}};
}

/// Adds the holes of one track, from its depths below the road without holes.
void add_holes(const std::vector<double>& plain_m,
               const std::vector<double>& holed_m,
               double step_m,
               WheelTrack track,
               std::vector<Hole>& holes) {
    for (std::size_t i = 0; i < plain_m.size(); ++i) {
        const std::size_t first = i;
        double depth_m = 0;
        for (; i < plain_m.size() && plain_m[i] - holed_m[i] > 1e-6; ++i) {
            depth_m = std::max(depth_m, plain_m[i] - holed_m[i]);
        }
        if (depth_m > 0) {
            holes.push_back(
                {step_m * static_cast<double>(first + i - 1) / 2, 1000 * depth_m, track});
        }
    }
}

RoadWithHoles road_with_holes(const RoadRecipe& recipe, double holes_per_km, std::uint64_t seed) {
    const auto plain = make_surface(recipe, length_m, seed);
    const auto holed = with_features(plain, {.potholes_per_km = holes_per_km}, seed + 100);
    const auto before = wheel_paths(plain);
    const auto after = wheel_paths(holed);
    RoadWithHoles road{under_wheels(after), {}};
    add_holes(before.left_m, after.left_m, after.step_m, WheelTrack::left, road.holes);
    add_holes(before.right_m, after.right_m, after.step_m, WheelTrack::right, road.holes);
    return road;
}

/// A car with friction, uneven dampers and wheels that are out of round, and its speed.
struct Drive {
    Axles axles;
    double speed_kmh;
};
constexpr Drive drives[] = {
    {{.wheelbase_m = 2.7, .cg_to_front_m = 1.2}, 30},
    {{.wheelbase_m = 2.45, .cg_to_front_m = 1.1, .dynamic_index = 0.95}, 60},
    {{.wheelbase_m = 2.9, .cg_to_front_m = 1.45, .dynamic_index = 1.05}, 90},
};

EstimatedProfile
profile_of(const RoadUnderWheels& road, const Drive& drive, const Sensors& sensors = {}) {
    const auto vehicle = two_axle_car(drive.axles, 0.3);
    CarRecipe car;
    car.vehicle = vehicle;
    // The rates that the pipeline takes of a log of 100 Hz: 2.6 samples a metre, at least 48 Hz.
    const double rate_hz = drive.speed_kmh > 66 ? 100 : 50;
    const auto stretch = with_sensors(
        stretch_over(road,
                     {.road = {},
                      .car = car,
                      .imu = {.rate_hz = rate_hz, .noise_mps2 = 0.05, .noise_radps = 0.002},
                      .length_m = length_m,
                      .speed_kmh = drive.speed_kmh}),
        sensors);
    EstimatorConfig config;
    config.method = Method::smoother;
    config.profile = true;
    return smoothed_iri(stretch, car_in(stretch, {.vehicle = vehicle}, config), config).profile;
}

bool is_pothole_near(const RoadEvent& event, double at_m) {
    return event.kind == EventKind::pothole && std::abs(event.travel_m - at_m) <= near_m;
}

using Passes = std::vector<std::vector<RoadEvent>>;

/// Number of passes that saw a pothole there.
std::ptrdiff_t seen_by(const Passes& passes, double at_m) {
    return std::ranges::count_if(passes, [&](const auto& events) {
        return std::ranges::any_of(events,
                                   [&](const auto& event) { return is_pothole_near(event, at_m); });
    });
}

/// Counts of holes and of potholes that were reported.
struct Score {
    int deep = 0, found = 0, reported = 0, real = 0;
};

void add_score(Score& score, const RoadWithHoles& road, const Passes& passes) {
    constexpr std::ptrdiff_t most = 2; // of three passes
    for (const auto& hole : road.holes) {
        if (hole.depth_mm > deep_mm && hole.at_m > begin_m && hole.at_m < length_m - begin_m) {
            ++score.deep;
            score.found += seen_by(passes, hole.at_m) >= most ? 1 : 0;
        }
    }
    for (const auto& event : passes.front()) {
        if (event.kind == EventKind::pothole && seen_by(passes, event.travel_m) >= most) {
            ++score.reported;
            score.real += std::ranges::any_of(
                road.holes, [&](const Hole& hole) { return is_pothole_near(event, hole.at_m); });
        }
    }
}

Passes passes_over(const RoadUnderWheels& road) {
    Passes passes;
    for (const auto& drive : drives) {
        passes.push_back(detect_events(profile_of(road, drive)));
    }
    return passes;
}

/// Returns whether no other hole could be taken for this one.
bool is_alone(const Hole& hole, const std::vector<Hole>& holes) {
    constexpr double apart_m = 5;
    return std::ranges::count_if(holes, [&](const Hole& other) {
               return std::abs(other.at_m - hole.at_m) < apart_m;
           }) == 1;
}

double share(int part, int all) {
    return static_cast<double>(part) / all;
}

/// The laser profile of tests/data/sorel, once and once more backwards, under both wheels.
RoadUnderWheels measured_road() {
    const auto profile = sorel_even();
    const double step_m = profile.station_m[1] - profile.station_m[0];
    const auto count = static_cast<std::ptrdiff_t>(profile.elevation_m.size());
    RoadUnderWheels road;
    for (double s_m = 0; s_m < length_m; s_m += road.step_m) {
        const auto at = static_cast<std::ptrdiff_t>(s_m / step_m) % (2 * (count - 1));
        const auto height_m = [&](std::ptrdiff_t i) {
            const auto folded = i < count ? i : 2 * (count - 1) - i;
            return profile.elevation_m[static_cast<std::size_t>(folded)] -
                   profile.elevation_m.front();
        };
        const double part = std::fmod(s_m, step_m) / step_m;
        road.left_m.push_back(
            static_cast<float>((1 - part) * height_m(at) + part * height_m(at + 1)));
    }
    road.right_m = road.left_m;
    return road;
}

/// Largest departure of the road from a straightedge of 3 m whose middle is near a place, mm.
double departure_mm(const RoadUnderWheels& road, double at_m) {
    constexpr double half_m = 1.5;
    const auto height_m = [&](double s_m) {
        return static_cast<double>(
            road.left_m[static_cast<std::size_t>(std::lround(s_m / road.step_m))]);
    };
    double most = 0;
    for (double s_m = at_m - near_m; s_m <= at_m + near_m; s_m += road.step_m) {
        most = std::max(
            most, std::abs(height_m(s_m) - (height_m(s_m - half_m) + height_m(s_m + half_m)) / 2));
    }
    return 1000 * most;
}

} // namespace

/// A smooth and a poor road; two passes of three decide.
TEST(EventsOfDrives, FindPotholesDeeperThan25MmFromThreePasses) {
    Score score;
    for (const double iri : {1.5, 4.0}) {
        const auto road = road_with_holes({.iri_mm_per_m = iri}, 15, 7);
        add_score(score, road, passes_over(road.road));
    }
    std::printf("recall %d of %d, precision %d of %d\n",
                score.found,
                score.deep,
                score.real,
                score.reported);
    ASSERT_GE(score.deep, 20);
    ASSERT_GE(score.reported, 20);
    EXPECT_GE(share(score.found, score.deep), 0.9);
    EXPECT_GE(share(score.real, score.reported), 0.9);
}

TEST(EventsOfDrives, TellPlaceTrackAndDepthWithItsUncertainty) {
    const auto road = road_with_holes({.iri_mm_per_m = 2}, 15, 3);
    int found = 0;
    int in_track = 0;
    int within = 0;
    double worst_m = 0;
    for (const auto& events : passes_over(road.road)) {
        for (const auto& hole : road.holes) {
            const auto event = std::ranges::find_if(
                events, [&](const auto& one) { return is_pothole_near(one, hole.at_m); });
            if (hole.depth_mm > deep_mm && is_alone(hole, road.holes) && event != events.end()) {
                ++found;
                in_track += event->track == hole.track ? 1 : 0;
                within += std::abs(event->size_mm - hole.depth_mm) < 1.645 * event->sd_mm ? 1 : 0;
                worst_m = std::max(worst_m, std::abs(event->travel_m - hole.at_m));
            }
        }
    }
    std::printf("of %d: %d in their track, %d within the 90 %% interval, at most %.2f m off\n",
                found,
                in_track,
                within,
                worst_m);
    ASSERT_GT(found, 15);
    EXPECT_GE(share(in_track, found), 0.9);
    EXPECT_GE(share(within, found), 0.75);
    EXPECT_LE(worst_m, 1);
}

TEST(EventsOfDrives, AreNoneOnRoadsWithoutDefects) {
    for (const double iri : {1.0, 6.0}) {
        const auto road = road_with_holes({.iri_mm_per_m = iri}, 0, 5);
        const auto passes = passes_over(road.road);
        ASSERT_FALSE(passes.empty());
        for (const auto& events : passes) {
            EXPECT_THAT(events, ::testing::IsEmpty());
        }
    }
}

/// This road has raised patches and steps of 10 to 20 mm, which are reported, and no holes. An
/// event is an alarm if a straightedge of 3 m departs by less than half its size, and every pothole
/// is one.
TEST(EventsOfDrives, AlarmFalselyLessThanEveryFiveKilometresOnAMeasuredRoad) {
    const auto road = measured_road();
    int alarms = 0;
    std::size_t count = 0;
    for (const auto& drive : drives) {
        for (const auto& event : detect_events(profile_of(road, drive))) {
            ++count;
            const bool is_alarm = event.kind == EventKind::pothole ||
                                  departure_mm(road, event.travel_m) < event.size_mm / 2;
            alarms += is_alarm ? 1 : 0;
        }
    }
    const double driven_km = length_m / 1000 * std::size(drives);
    std::printf("%d false alarms in %.0f km, %zu events\n", alarms, driven_km, count);
    ASSERT_GT(count, 0U);
    EXPECT_LT(alarms / driven_km, 0.2);
}

/// With the sensors of `import`, where two passes of three decide, as in a database.
TEST(EventsOfDrives, OfVerticalAndPitchAgreeOnNoHoleOnTheMeasuredRoad) {
    const auto road = measured_road();
    Passes passes;
    for (const auto& drive : drives) {
        passes.push_back(detect_events(profile_of(road, drive, {true, false, false, true})));
    }
    int alarms = 0;
    std::size_t count = 0;
    for (const auto& events : passes) {
        count += events.size();
        alarms += static_cast<int>(std::ranges::count_if(events, [&](const auto& event) {
            return event.kind == EventKind::pothole && seen_by(passes, event.travel_m) >= 2;
        }));
    }
    std::printf("%d reports of a hole that passes agree on, of %zu events\n", alarms, count);
    ASSERT_GT(count, 0U);
    EXPECT_LT(alarms / (length_m / 1000), 0.2);
}

/// The mean of both tracks shows half the depth of a hole in one of them.
TEST(EventsOfDrives, OfAVerticalSensorAloneKnowNoTrack) {
    const auto road = road_with_holes({.iri_mm_per_m = 1.5}, 15, 3);
    const auto events =
        detect_events(profile_of(road.road, drives[1], {true, false, false, false}));
    ASSERT_FALSE(events.empty());
    for (const auto& event : events) {
        EXPECT_EQ(event.track, WheelTrack::unknown);
    }
}

} // namespace macadam::testing
