// Logs without the acceleration that the estimate rests on.

#include "app/pipeline/pipeline.hpp"
#include "estimator/motion/trip_motion.hpp"

#include "estimator/common/error.hpp"
#include "mapping/network/build_network.hpp"
#include "support/roads/drive.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace macadam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

const Vehicle& car() {
    return *built_in_vehicle("audi-a6-etron");
}

/// A drive whose car sways as it heaves, so that both accelerations are there.
TripLog swaying_drive() {
    auto trip = drive_over(patched_road([](double) { return false; }, 1), {}, car());
    std::ranges::transform(
        trip.acc.z, trip.acc.y.begin(), [](float up) { return (up - 9.80665F) / 4; });
    return trip;
}

/// The same without vertical acceleration from `from_s` on.
TripLog flat_drive(double from_s = 0) {
    auto trip = swaying_drive();
    for (std::size_t i = 0; i < trip.acc.t_s.size(); ++i) {
        trip.acc.z[i] = trip.acc.t_s[i] >= from_s ? unknown : trip.acc.z[i];
    }
    return trip;
}

RoadNetwork road_under_the_drive() {
    Way way{.id = 7, .name = "", .highway = "primary", .node_ids = {}, .line = {}};
    for (int i = 0; i <= 12; ++i) {
        way.node_ids.push_back(i + 1);
        way.line.push_back(place_of({}, 100.0 * i - 100));
    }
    return build_network({way});
}

TripResult result_of(const TripLog& trip, Channels channels) {
    PipelineConfig config;
    config.estimator.channels = channels;
    config.estimator.tracks = false;
    return passes_of(trip, car(), road_under_the_drive(), config);
}

std::string refusal_of(const TripLog& trip, Channels channels) {
    try {
        result_of(trip, channels);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

std::string all_of(const std::vector<std::string>& warnings) {
    std::string text;
    for (const auto& warning : warnings) {
        text += warning + "\n";
    }
    return text;
}

bool is_lateral(const Pass& pass) {
    return (pass.validity & validity::lateral_alone) != 0;
}

TEST(MissingVertical, IsReplacedByTheLateralOneWithALoudNote) {
    const auto result = result_of(flat_drive(), Channels::automatic);
    EXPECT_THAT(result.passes, Not(IsEmpty()));
    EXPECT_THAT(all_of(result.warnings),
                HasSubstr("no vertical acceleration: estimated from lateral acceleration only, "
                          "which is far less accurate"));
}

TEST(MissingVertical, IsToldByEveryPassThatHadToDoWithout) {
    const auto result = result_of(flat_drive(), Channels::automatic);
    EXPECT_TRUE(std::ranges::all_of(result.passes, is_lateral));
    EXPECT_EQ(name_of_validity(result.passes.back().validity), "indicative");
}

TEST(MissingVertical, IsNotSaidOfALogThatHasIt) {
    const auto result = result_of(swaying_drive(), Channels::automatic);
    EXPECT_THAT(result.passes, Not(IsEmpty()));
    EXPECT_TRUE(std::ranges::none_of(result.passes, is_lateral));
    EXPECT_THAT(all_of(result.warnings), Not(HasSubstr("lateral")));
}

TEST(MissingVertical, IsRefusedWhereItIsAskedFor) {
    for (const auto channels : {Channels::vertical, Channels::both}) {
        EXPECT_EQ(refusal_of(flat_drive(), channels),
                  "contains no vertical acceleration, expected acc_z_mps2");
    }
}

TEST(MissingLateral, IsRefusedWhereItIsAskedFor) {
    auto trip = swaying_drive();
    std::ranges::fill(trip.acc.y, unknown);
    EXPECT_EQ(refusal_of(trip, Channels::lateral),
              "contains no lateral acceleration, expected acc_y_mps2");
}

TEST(MissingVibration, IsRefusedWithoutAWordOnItsRate) {
    auto trip = swaying_drive();
    trip.acc = {};
    std::erase_if(trip.rows, [](std::uint8_t row) { return row != row_content::fix; });
    trip.speed = {};
    EXPECT_EQ(refusal_of(trip, Channels::automatic),
              "contains neither vertical nor lateral acceleration, expected acc_z_mps2");
}

/// From 25 s on the vertical axis is silent: those samples stand in no estimate.
TEST(MissingVertical, OfAPartLeavesItsRowsUnused) {
    auto trip = flat_drive(25);
    for (auto* const stream : {&trip.acc.x, &trip.acc.y, &trip.acc.z}) { // cut there by a hole
        stream->erase(stream->begin() + 2500, stream->begin() + 2550);
    }
    trip.acc.t_s.erase(trip.acc.t_s.begin() + 2500, trip.acc.t_s.begin() + 2550);
    PipelineConfig config;
    config.estimator.channels = Channels::vertical;
    const auto trace = trace_of(trip, motion_of(trip), car(), config);
    EXPECT_EQ(trace.roughness.runs.size(), 1U);
    for (std::size_t i = 0; i < trip.acc.z.size(); ++i) {
        EXPECT_EQ(trace.use.acc[i] == 0, !std::isnan(trip.acc.z[i])) << i;
    }
}

} // namespace
} // namespace macadam::testing
