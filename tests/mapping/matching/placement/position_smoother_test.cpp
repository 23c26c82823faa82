#include "mapping/matching/placement/position_smoother.hpp"
#include "mapping/network/build_network.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace macadam {
namespace {

using std::numbers::pi;

/// One way through places of a plane, driven from end to end.
struct Course {
    LocalFrame frame{{48.0, 11.0}};
    RoadNetwork roads;
    SmoothedPath line;
};

Course course_through(const std::vector<PointEn>& points) {
    Course course;
    Way way{7, "", "", Oneway::no, {}, {}};
    for (const auto& point : points) {
        way.node_ids.push_back(static_cast<std::int64_t>(way.node_ids.size()));
        way.line.push_back(course.frame.to_geo(point));
    }
    course.roads = build_network({way});
    CandidateIndex plane{course.roads, course.frame};
    const EdgeId edge = edge_of(LinkId{0}, true);
    const RoadPath path{{{edge, 0, length_m(course.roads, edge), 0, 1}}, {}, {}, 0, 0};
    course.line = driven_line(path, course.roads, plane);
    return course;
}

Course corner() {
    return course_through({{0, 0}, {400, 0}, {400, 400}}); // east, then north
}

Course winding() {
    std::vector<PointEn> points;
    for (int i = 0; i <= 300; ++i) {
        points.push_back({20.0 * i, 150 * std::sin(i / 9.0)});
    }
    return course_through(points);
}

// ------------------------------------------------------------------------------- driven line

TEST(SmoothedPath, CutsARightAngleAsManyMetresAsItsRoundingTells) {
    const auto course = corner();
    // The direction turns with the share of the kernel that is past the corner; three boxes of 18 m
    // (nine points 2 m apart) are nearly normal.
    const double sd_m = std::sqrt(3 * (18.0 * 18.0 - 4) / 12);
    double cut_m = 0;
    for (double u_m = -100; u_m < 100; u_m += 0.01) {
        const double past = 0.5 * std::erfc(-u_m / sd_m / std::numbers::sqrt2);
        cut_m += 0.01 * (1 - std::hypot(past, 1 - past));
    }
    EXPECT_NEAR(course.line.driven_m.back(), 800 - cut_m, 0.3);
    EXPECT_NEAR(course.line.turned_rad.back()[0], pi / 2, 1e-3);
    EXPECT_EQ(course.line.turned_rad.back()[1], 0);
}

TEST(SmoothedPath, KeepsAStraightRoadAsItIs) {
    const auto course = course_through({{0, 0}, {300, 400}});
    EXPECT_NEAR(course.line.driven_m.back(), 500, 0.01);
    const auto place = place_at(course.line, 250);
    EXPECT_NEAR(place.at.east_m, 150, 0.01);
    EXPECT_NEAR(place.at.north_m, 200, 0.01);
    EXPECT_NEAR(along_m_at(course.line, 250), 250, 0.01);
    EXPECT_NEAR(mean_heading_rad(course.line, 250, 10), std::atan2(400, 300), 1e-4);
}

TEST(SmoothedPath, GoesStraightOnBeyondItsEnds) {
    const auto course = corner();
    const double end_m = course.line.driven_m.back();
    EXPECT_NEAR(place_at(course.line, -30).at.east_m, -30, 0.01);
    EXPECT_NEAR(place_at(course.line, end_m + 30).at.north_m, 430, 0.01);
    EXPECT_NEAR(along_m_at(course.line, end_m + 30), 830, 0.01);
    EXPECT_NEAR(driven_m_at(course.line, -30), -30, 0.01);
}

TEST(SmoothedPath, FindsBackThePlaceOfTheMapsLine) {
    const auto course = winding();
    for (double along_m = 5; along_m < 6000; along_m += 37) {
        EXPECT_NEAR(along_m_at(course.line, driven_m_at(course.line, along_m)), along_m, 1e-6);
    }
}

// ---------------------------------------------------------------------------------- smoother

struct Errors {
    double travel_scale = 1; ///< travel over the truth
    double latency_s = 0;
    double right_m = 0; ///< the car's lane
    PointEn fix_m{0, 0};
    double slow_sd_m = 0; ///< Gauss-Markov over 30 s
    bool gyro = true;
};

struct Drive {
    std::vector<Epoch> epochs;
    std::vector<double> truth_m; ///< driven
};

constexpr double half_m = 8;

/// Once a second from place to place, slower in the middle of each 20 s.
Drive drive_along(const SmoothedPath& line, const Errors& errors, unsigned seed = 1) {
    std::mt19937_64 random{seed};
    std::normal_distribution<double> normal;
    const auto place_m = [](double t_s) {
        return 12 * t_s - 20 * std::sin(t_s / 20 * 2 * pi) / pi;
    };
    const double keep = std::exp(-1 / 30.0);
    PointEn slow{errors.slow_sd_m * normal(random), errors.slow_sd_m * normal(random)};
    Drive drive;
    double travel_m = 0;
    double before_rad = 0;
    for (double t_s = 0; place_m(t_s) < line.driven_m.back(); t_s += 1) {
        const double truth_m = place_m(t_s);
        const auto here = place_at(line, truth_m);
        const double turned = here.turned_rad[0];
        if (!drive.truth_m.empty()) { // the outer lane is longer
            travel_m += errors.travel_scale *
                        (truth_m - drive.truth_m.back() + errors.right_m * (turned - before_rad));
        }
        before_rad = turned;
        const auto seen = place_at(line, place_m(t_s - errors.latency_s));
        slow = {keep * slow.east_m + std::sqrt(1 - keep * keep) * errors.slow_sd_m * normal(random),
                keep * slow.north_m +
                    std::sqrt(1 - keep * keep) * errors.slow_sd_m * normal(random)};
        drive.epochs.push_back(
            {.t_s = t_s,
             .travel_m = travel_m,
             .speed_mps = place_m(t_s + 0.5) - place_m(t_s - 0.5),
             .measured = true,
             .fix = PointEn{seen.at.east_m + errors.right_m * seen.ahead.north_m +
                                errors.fix_m.east_m + slow.east_m,
                            seen.at.north_m - errors.right_m * seen.ahead.east_m +
                                errors.fix_m.north_m + slow.north_m},
             .fix_sd_m = 5,
             .gyro_rad = errors.gyro ? std::optional{mean_heading_rad(line, truth_m, half_m) + 0.4}
                                     : std::nullopt,
             .heading_variance = 1e-6});
        drive.truth_m.push_back(truth_m);
    }
    return drive;
}

std::vector<PathPosition>
places_of(const SmoothedPath& line, const Drive& drive, double latency_sd_s, double off_m = 6) {
    auto nominal_m = drive.truth_m; // as a lattice might have put it
    for (auto& driven_m : nominal_m) {
        driven_m += off_m;
    }
    return smoothed_places(
        line,
        drive.epochs,
        nominal_m,
        {.latency_sd_s = latency_sd_s, .scale_sd = 0.01, .heading_half_m = half_m});
}

double worst_m(const std::vector<PathPosition>& places, const Drive& drive) {
    double worst = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
        worst = std::max(worst, std::abs(places[k].driven_m - drive.truth_m[k]));
    }
    return worst;
}

TEST(PlaceSmoother, FindsTheScaleOfTheOdometer) {
    const auto course = course_through({{0, 0}, {3000, 0}});
    const auto drive = drive_along(course.line, {.travel_scale = 1 / 1.01}); // 30 m in all
    // Fixes may err by 5 m for all that is known, the scale by 1 %: a little of it stays.
    EXPECT_LT(worst_m(places_of(course.line, drive, 0.02), drive), 1);
}

TEST(PlaceSmoother, PlacesTheCarByOneTurnThoughTheReceiverIsTenMetresOff) {
    const auto course = corner();
    const auto drive = drive_along(course.line, {.fix_m = {-7, -7}});
    const auto places = places_of(course.line, drive, 0.02);
    const double corner_m = driven_m_at(course.line, 400);
    int near_corner = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
        if (std::abs(drive.truth_m[k] - corner_m) < 30) {
            ++near_corner;
            EXPECT_NEAR(places[k].driven_m, drive.truth_m[k], 1) << drive.truth_m[k];
        }
    }
    EXPECT_GT(near_corner, 0);
}

TEST(PlaceSmoother, FindsAnUnknownLatencyByTurnsAndByChangesOfSpeed) {
    const auto course = winding();
    for (const bool gyro : {true, false}) {
        const auto drive = drive_along(course.line, {.latency_s = 1.3, .gyro = gyro});
        // 1.3 s are 16 m; a metre is 0.08 s.
        EXPECT_LT(worst_m(places_of(course.line, drive, 1, -10), drive), 1) << gyro;
    }
}

TEST(PlaceSmoother, KnowsThatTheOuterLaneIsLonger) {
    const auto course = winding(); // over a wave the turns cancel; half of one is 2.2 m of lane
    const auto drive = drive_along(course.line, {.right_m = 3, .slow_sd_m = 0});
    EXPECT_LT(worst_m(places_of(course.line, drive, 0.02), drive), 0.5);
}

TEST(PlaceSmoother, TellsItsErrorsHonestly) {
    const auto course = winding();
    double squares = 0;
    std::size_t count = 0;
    for (unsigned seed = 1; seed <= 8; ++seed) {
        const auto drive =
            drive_along(course.line, {.travel_scale = 1.004, .slow_sd_m = 5, .gyro = false}, seed);
        const auto places = places_of(course.line, drive, 0.02);
        for (std::size_t k = 0; k < places.size(); ++k) {
            const double sds = (places[k].driven_m - drive.truth_m[k]) / places[k].sd_m;
            squares += sds * sds;
            ++count;
        }
    }
    // The model leaves room for maps and lanes that are worse than these: sds may be too large,
    // hardly too small. Eight drives of some ten independent errors each: 10 %.
    const double normalised = std::sqrt(squares / static_cast<double>(count));
    EXPECT_GT(normalised, 0.4);
    EXPECT_LT(normalised, 1.1);
}

TEST(PlaceSmoother, DoesNotFollowAJump) {
    const auto course = winding();
    auto drive = drive_along(course.line, {});
    drive.epochs[100].fix->east_m += 60;
    drive.epochs[101].fix->east_m += 60;
    EXPECT_LT(worst_m(places_of(course.line, drive, 0.02), drive), 1);
}

TEST(PlaceSmoother, CarriesThePlaceThroughAnOutage) {
    const auto course = winding();
    auto drive = drive_along(course.line, {.travel_scale = 1.005});
    const double seen_sd_m = places_of(course.line, drive, 0.02)[230].sd_m;
    for (std::size_t k = 200; k < 260; ++k) {
        drive.epochs[k].fix.reset();
    }
    const auto places = places_of(course.line, drive, 0.02);
    EXPECT_LT(worst_m(places, drive), 1.5);
    EXPECT_GT(places[230].sd_m, seen_sd_m);
}

TEST(PlaceSmoother, NeverGoesBackWhateverItIsGiven) {
    const auto course = winding();
    std::mt19937_64 random{5};
    std::uniform_real_distribution<double> anywhere{-3000, 9000};
    for (int trial = 0; trial < 4; ++trial) {
        auto drive = drive_along(course.line, {});
        double travel_m = 0;
        double t_s = 0;
        for (auto& epoch : drive.epochs) {
            epoch.travel_m = travel_m += random() % 5 == 0 ? 0 : static_cast<double>(random() % 40);
            epoch.t_s = t_s += random() % 100 == 0 ? 1000 : 1;
            epoch.measured = random() % 2 == 0;
            epoch.fix = PointEn{anywhere(random), anywhere(random)};
            epoch.gyro_rad = anywhere(random);
        }
        std::ranges::generate(drive.truth_m, [&] { return anywhere(random); });
        const auto places = places_of(course.line, drive, 1);
        ASSERT_EQ(places.size(), drive.epochs.size());
        for (std::size_t k = 0; k < places.size(); ++k) {
            ASSERT_TRUE(std::isfinite(places[k].driven_m) && std::isfinite(places[k].sd_m));
            ASSERT_GE(places[k].driven_m, k > 0 ? places[k - 1].driven_m : -1e9);
        }
    }
}

} // namespace
} // namespace macadam
