#include "drive_score.hpp"
#include "off_network.hpp"
#include "simulated_world.hpp"
#include "support/program/places.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

namespace macadam::bench {
namespace {

const DrivenNetwork& small_town() {
    static const auto network = driven_network(std::filesystem::path{testing::source_folder()} /
                                                   "sample_data/fleet/network.osm.pbf",
                                               1,
                                               3);
    return network;
}

const Drive& drive() {
    return small_town().drives.front();
}

Recording recording() {
    return recorded(small_town(), 0, {.sensors = with_all});
}

/// Travel as it was.
Odometer true_odometer() {
    constexpr std::size_t each = 10;
    const auto& motion = drive().motion;
    Odometer::Knots knots;
    for (std::size_t i = 0; i < motion.travel_m.size(); i += each) {
        knots.t_s.push_back(static_cast<double>(i) * motion.step_s);
        knots.travel_m.push_back(motion.travel_m[i]);
        knots.speed_mps.push_back(static_cast<float>(motion.speed_mps[i]));
        knots.reversing.push_back(0);
    }
    return Odometer{std::move(knots)};
}

/// The truth as a matcher would say it, so many metres too far along the route, in pieces of about
/// 2 m.
Matched told(double ahead_m, double confidence = 1) {
    constexpr double piece_m = 2;
    Matched matched{.latency_s = recording().latency_s, .odometer = true_odometer(), .trace = {}};
    for (std::size_t k = 0; k < drive().route.size(); ++k) {
        const double from_m = drive().start_m[k];
        const double to_m = drive().start_m[k + 1];
        const auto pieces = std::ceil((to_m - from_m) / piece_m);
        const auto travel_at = [&](double route_m) {
            return matched.odometer.travel_m(t_s_at(drive(), route_m - ahead_m));
        };
        for (double i = 0; i < pieces; ++i) {
            const double a_m = (to_m - from_m) * i / pieces;
            const double b_m = (to_m - from_m) * (i + 1) / pieces;
            MatchedInterval piece{};
            piece.kind = IntervalKind::road;
            piece.edge = drive().route[k];
            piece.from_travel_m = travel_at(from_m + a_m);
            piece.to_travel_m = travel_at(from_m + b_m);
            piece.from_offset_m = a_m;
            piece.to_offset_m = b_m;
            piece.confidence = confidence;
            matched.trace.push_back(piece);
        }
    }
    return matched;
}

Matched with_every_edge_reversed(Matched matched) {
    for (auto& piece : matched.trace) {
        piece.edge = reversed(piece.edge);
    }
    return matched;
}

TEST(DriveScore, FindsNoFaultWithTheTruth) {
    const auto score = score_of(drive(), recording(), told(0));
    EXPECT_GT(score.length_m, 5000);
    EXPECT_EQ(score.right_m, score.length_m);
    EXPECT_EQ(score.wrong_m + score.off_network_m + score.gap_m, 0);
    // Pieces of 2 m that are straight in travel bend by centimetres where the car brakes.
    EXPECT_LT(absolute_quantile(score.error_m, 0.99), 0.2);
    EXPECT_LT(score.route.mismatch(),
              0.02); // the trip's ends before the first and after the last fix
}

TEST(DriveScore, SaysByHowMuchPlacesAreAhead) {
    const auto score = score_of(drive(), recording(), told(4));
    EXPECT_NEAR(quantile(score.error_m, 0.5), 4, 0.1);
    EXPECT_GT(quantile(score.error_m, 0.05), 0); // at corners several places are true
}

TEST(DriveScore, CallsAPlaceBeyondAJunctionRightOnlyNearIt) {
    const auto near = score_of(drive(), recording(), told(9));
    EXPECT_GT(near.right_m, 0.99 * near.length_m);
    EXPECT_LT(near.same_edge_m, 0.97 * near.length_m);
    const auto far = score_of(drive(), recording(), told(30));
    EXPECT_LT(far.right_m, 0.95 * far.length_m);
}

TEST(DriveScore, CallsTheWrongDirectionWrong) {
    const auto score = score_of(drive(), recording(), with_every_edge_reversed(told(0)));
    // But for roads that the drive took both ways.
    EXPECT_GT(score.wrong_m, 0.6 * score.length_m);
    EXPECT_EQ(score.empty, 0U);
}

TEST(DriveScore, CountsADriveWithoutRoadsAsEmpty) {
    auto nothing = told(0);
    nothing.trace.clear();
    const auto score = score_of(drive(), recording(), nothing);
    EXPECT_EQ(score.empty, 1U);
    EXPECT_EQ(score.gap_m, score.length_m);
    EXPECT_DOUBLE_EQ(score.route.mismatch(), 1);
}

TEST(DriveScore, HoldsConfidenceAgainstWhatIsRight) {
    const auto modest = score_of(drive(), recording(), told(0, 0.75));
    EXPECT_NEAR(calibration_error(modest), 0.25, 1e-9);
    EXPECT_EQ(modest.sure_m, 0);
    const auto sure = score_of(drive(), recording(), with_every_edge_reversed(told(0, 0.99)));
    EXPECT_EQ(sure.sure_m, sure.length_m);
    EXPECT_EQ(sure.sure_wrong_m, sure.wrong_m);
}

TEST(DriveScore, OfTwoDrivesIsTheirSum) {
    const auto one = score_of(drive(), recording(), told(0));
    const auto both = together(one, score_of(drive(), recording(), told(30)));
    EXPECT_EQ(both.drives, 2U);
    EXPECT_EQ(both.length_m, 2 * one.length_m);
    EXPECT_NEAR(quantile(both.error_m, 0.75), 30, 0.2);
}

TEST(SimulatedDrive, IsWhereItsRouteIsAbreast) {
    for (double t_s = 20; t_s < 400; t_s += 7) {
        const auto place = true_place_at(drive(), t_s);
        EXPECT_LE(place.from_m, route_m_at(drive(), t_s));
        EXPECT_GE(place.to_m, route_m_at(drive(), t_s));
        std::size_t edge = 0;
        while (drive().start_m[edge + 1] < place.from_m) {
            ++edge;
        }
        const auto on_map =
            place_on(small_town().roads, drive().route[edge], place.from_m - drive().start_m[edge]);
        const auto car = drive().path.plane.to_geo(place_at_time(drive(), t_s).at);
        EXPECT_LT(distance_m(on_map, car), 12); // lane 2.5 m, and a corner cut or swung out of
    }
}

/// Mean rate of a gyro between two times.
double mean_rate(const TriaxialSamples& gyro, double from_s, double to_s) {
    double sum = 0;
    double count = 0;
    for (std::size_t i = 0; i < gyro.t_s.size(); ++i) {
        const bool inside = from_s < gyro.t_s[i] && gyro.t_s[i] <= to_s;
        sum += inside ? gyro.z[i] : 0;
        count += inside ? 1 : 0;
    }
    return sum / count;
}

TEST(SimulatedDrive, TurnsAsItsGyroSays) {
    // Less the bias while the car stands before it departs, which wanders on by 0.0005 rad/s: 0.05
    // rad in 100 s. The path's headings are those of steps of 1 m, up to 0.1 rad in a turn.
    const auto gyro = recording().trip.gyro;
    const auto heading_rad = [&](double t_s) {
        const auto heading = place_at_time(drive(), t_s).heading;
        return std::atan2(heading.north_m, heading.east_m);
    };
    for (const double from_s : {60.0, 160.0, 260.0}) {
        const double to_s = from_s + 100;
        const double turned_rad =
            (to_s - from_s) * (mean_rate(gyro, from_s, to_s) - mean_rate(gyro, 0, 5));
        const double off_rad = std::remainder(
            turned_rad - (heading_rad(to_s) - heading_rad(from_s)), 2 * std::numbers::pi);
        EXPECT_LT(std::abs(off_rad), 0.25);
    }
}

TEST(SimulatedDrive, LogsTheSameErrorsWhateverElseIsLogged) {
    const auto bare = recorded(small_town(), 0, {});
    const auto full = recording();
    ASSERT_EQ(bare.trip.fixes.size(), full.trip.fixes.size());
    for (std::size_t i = 0; i < bare.trip.fixes.size(); ++i) {
        EXPECT_EQ(bare.trip.fixes[i].at, full.trip.fixes[i].at);
        EXPECT_TRUE(std::isnan(bare.trip.fixes[i].course_deg));
    }
    EXPECT_EQ(bare.latency_s, full.latency_s);
    EXPECT_TRUE(bare.trip.speed.t_s.empty());
    EXPECT_TRUE(bare.trip.gyro.t_s.empty());
}

TEST(SimulatedDrive, ErrsByTheSigmaOfItsReceiver) {
    const auto noisy = recorded(small_town(), 0, {.sigma_m = 10});
    std::vector<float> off_m;
    for (const auto& fix : noisy.trip.fixes) {
        const auto car =
            drive().path.plane.to_geo(place_at_time(drive(), fix.t_s - noisy.latency_s).at);
        off_m.push_back(static_cast<float>(distance_m(fix.at, car)));
    }
    // The middle of a Rayleigh distribution of sigma 10 m is 11.8 m; some 25 independent errors.
    EXPECT_NEAR(quantile(off_m, 0.5), 11.8, 5);
}

TEST(OffNetwork, IsNoticedWhereMostOfTheMapIsMissing) {
    const auto score =
        off_network_score(std::span{&small_town(), 1}, {.sensors = with_all}, 0.5, 1);
    EXPECT_GT(score.deleted_m, 0.45 * score.length_m);
    EXPECT_LE(score.noticed_m + score.false_road_m, score.deleted_m);
    EXPECT_LE(score.beside_false_m, score.beside_m);
    EXPECT_GT(score.recall(), 0.5);
}

} // namespace
} // namespace macadam::bench
