#include "app/pipeline/pipeline.hpp"

#include "mapping/network/build_network.hpp"
#include "support/roads/drive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace macadam {
namespace {

using testing::Drive;

/// A drive of 1,200 m on a two-way road to the east, which begins 200 m before and ends 200 m
/// behind it. Metres count from the drive's western end; the road is rough from 500 to 600 m.
class OneRoad : public ::testing::Test {
protected:
    static constexpr double length_m = 1200;
    static constexpr double before_m = 200;

    RoadNetwork roads() const {
        const Drive along{.length_m = length_m};
        Way way{.id = 7, .name = "", .highway = "primary", .node_ids = {}, .line = {}};
        for (int i = 0; i <= 16; ++i) {
            way.node_ids.push_back(i + 1);
            way.line.push_back(testing::place_of(along, 100.0 * i - before_m));
        }
        return build_network({way});
    }

    static bool is_rough(double x_m) { return x_m >= 500 && x_m < 600; }

    /// The headline by segment index of a drive to the east, or back to the west.
    std::map<std::uint32_t, double>
    driven(bool east, double latency_s = 0.2, double antenna_behind_m = 0) const {
        const auto road = testing::patched_road(
            [east](double x_m) { return is_rough(east ? x_m : length_m - x_m); }, 4);
        Drive drive{.length_m = length_m, .gnss_latency_s = latency_s};
        if (!east) {
            drive.start = testing::place_of(drive, length_m);
            drive.course_deg = 270;
        }
        const auto& car = *built_in_vehicle("golden-car");
        auto trip = testing::drive_over(road, drive, car);
        trip.meta.gnss_antenna_pos_m = {antenna_behind_m, 0, 0};
        const auto result = passes_of(trip, car, roads(), {});
        std::map<std::uint32_t, double> iri;
        for (const auto& pass : result.passes) {
            EXPECT_EQ(pass.segment.forward, east);
            iri[pass.segment.index] = pass.iri_um / 1000.0;
        }
        return iri;
    }

    static double middle_m(std::uint32_t index) { return 20.0 * index + 10 - before_m; }

    /// Middle of the roughness along the road, by its excess over the smooth level.
    static double centre_m(const std::map<std::uint32_t, double>& iri) {
        double sum = 0;
        double moment = 0;
        const double smooth = iri.begin()->second;
        for (const auto& [index, value] : iri) {
            const double excess = std::max(0.0, value - 1.5 * smooth);
            sum += excess;
            moment += excess * middle_m(index);
        }
        return moment / sum;
    }
};

TEST_F(OneRoad, ShowsTheRoughPatchInTheSegmentsWhereItLies) {
    const auto iri = driven(true);
    int on_patch = 0, beside = 0;
    for (const auto& [index, value] : iri) {
        if (middle_m(index) > 520 && middle_m(index) < 580) {
            ++on_patch;
            EXPECT_GT(value, 3 * iri.begin()->second) << index;
        }
        // The golden car still sways some metres behind the patch.
        if (middle_m(index) < 480 || middle_m(index) > 660) {
            ++beside;
            EXPECT_LT(value, 1.5 * iri.begin()->second) << index;
        }
    }
    EXPECT_GT(on_patch, 0);
    EXPECT_GT(beside, 10);
}

TEST_F(OneRoad, HoldsTheSameMetreInTheSameSegmentWhicheverWayItIsDriven) {
    // The sway behind the patch shifts the centre some metres along, each time in driving
    // direction.
    EXPECT_NEAR(centre_m(driven(true)), centre_m(driven(false)), 16);
}

TEST_F(OneRoad, TakesTheLatencyOfTheReceiverOff) {
    EXPECT_NEAR(centre_m(driven(true, 0)), centre_m(driven(true, 1.0)), 2);
}

TEST_F(OneRoad, PutsTheCarAheadOfAnAntennaThatSitsBehind) {
    // The fixes are the same; said to be of a roof 20 m back, they put everything a segment
    // farther.
    EXPECT_NEAR(centre_m(driven(true, 0.2, 20)) - centre_m(driven(true)), 20, 1);
    EXPECT_NEAR(centre_m(driven(false, 0.2, 20)) - centre_m(driven(false)), -20, 1);
}

/// A phone's recording that was paused for 300 m of the way.
TEST_F(OneRoad, IsNotDrivenWhereTheRecordingWasPaused) {
    const auto& car = *built_in_vehicle("golden-car");
    auto trip = testing::drive_over(
        testing::patched_road(is_rough, 4), {.length_m = length_m, .wheel_speed = false}, car);
    const auto whole_m = passes_of(trip, car, roads(), {}).distance_m;
    const auto is_paused = [](double t_s) { return t_s > 20 && t_s < 35; }; // at 20 m/s
    std::erase_if(trip.fixes, [&](const GnssFix& fix) { return is_paused(fix.t_s); });
    TriaxialSamples felt;
    for (std::size_t i = 0; i < trip.acc.t_s.size(); ++i) {
        if (!is_paused(trip.acc.t_s[i])) {
            felt.t_s.push_back(trip.acc.t_s[i]);
            felt.x.push_back(trip.acc.x[i]);
            felt.y.push_back(trip.acc.y[i]);
            felt.z.push_back(trip.acc.z[i]);
        }
    }
    trip.acc = felt;
    trip.rows.assign(felt.t_s.size(), row_content::acc);
    trip.rows.insert(trip.rows.end(), trip.fixes.size(), row_content::fix);
    // The samples on both sides of the pause are up to 0.1 s from it.
    EXPECT_NEAR(passes_of(trip, car, roads(), {}).distance_m, whole_m - 300, 5);
}

TEST_F(OneRoad, AccountsForEveryRowOfTheTrip) {
    const auto& car = *built_in_vehicle("golden-car");
    const auto trip =
        testing::drive_over(testing::patched_road(is_rough, 4), {.length_m = length_m}, car);
    const auto rows = passes_of(trip, car, roads(), {}).rows;
    EXPECT_EQ(rows.read, trip.rows.size());
    EXPECT_EQ(rows.read, rows.used + rows.rejected);
    EXPECT_GT(rows.used, trip.rows.size() * 9 / 10);
}

} // namespace
} // namespace macadam
