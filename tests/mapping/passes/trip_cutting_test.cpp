#include "mapping/passes/trip_cutting.hpp"

#include "support/roads/road_art.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>

namespace macadam {
namespace {

using ::testing::Each;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr auto there = EdgeId{0};
constexpr auto back = EdgeId{1};

const Vehicle& car() {
    return *built_in_vehicle("golden-car");
}

/// A thousand metres of road, two chunks each way.
const RoadNetwork& kilometre() {
    static const auto art = testing::road_art("A---------B", 100, {"AB"});
    return art.roads;
}

double kilometre_m() {
    return length_m(kilometre(), there);
}

/// Roughness along travel [0, length_m), with nothing lost to a lead-in.
IriTrace roughness(double length_m, const std::function<double(double travel_m)>& value) {
    IriRun run{};
    run.cell_m = 0.25;
    for (double at_m = 0.125; at_m < length_m; at_m += run.cell_m) {
        run.left_mm_per_m.push_back(static_cast<float>(value(at_m)));
        run.right_mm_per_m.push_back(static_cast<float>(3 * value(at_m)));
        run.centre_mm_per_m.push_back(static_cast<float>(1.8 * value(at_m)));
        run.speed_mps.push_back(15);
    }
    IriTrace trace;
    trace.runs.push_back(std::move(run));
    return trace;
}

double rising(double travel_m) {
    return 1 + travel_m / 500;
}

MatchedInterval
piece(EdgeId edge, double from_travel_m, double from_offset_m, double length_m, double sure = 1) {
    return {.kind = IntervalKind::road,
            .edge = edge,
            .from_travel_m = from_travel_m,
            .to_travel_m = from_travel_m + length_m,
            .from_offset_m = from_offset_m,
            .to_offset_m = from_offset_m + length_m,
            .t_enter_s = from_travel_m / 10,
            .t_leave_s = (from_travel_m + length_m) / 10,
            .confidence = sure,
            .reason = ""};
}

std::vector<RoughnessTrace> traces_of(const IriTrace& trace, const MatchedTrace& matched) {
    return cut_trip(trace, matched, kilometre(), car(), {}).traces;
}

double last_m(const RoughnessTrace& trace) {
    return trace.first_m + static_cast<double>(trace.iri.size());
}

TEST(ChunkTraces, ReadEachMetreWhereTheMatchPutsIt) {
    const auto traces = traces_of(roughness(2000, rising), {piece(there, 200, 0, kilometre_m())});
    ASSERT_THAT(traces, SizeIs(2));
    for (const auto& trace : traces) {
        for (std::size_t i = 0; i < trace.iri.size(); ++i) {
            const double travel_m = 200 + trace.first_m + static_cast<double>(i) + 0.5;
            // The mean of both tracks; a code is right to 1/64.
            EXPECT_NEAR(*um_of(trace.iri[i]) / 1000.0, 2 * rising(travel_m), 0.2);
            EXPECT_NEAR(*um_of(trace.left[i]) / 1000.0, rising(travel_m), 0.1);
        }
    }
}

TEST(ChunkTraces, GoOnTenMetresBeyondTheirChunkWithinTheMatch) {
    const auto traces = traces_of(roughness(2000, rising), {piece(there, 200, 0, kilometre_m())});
    ASSERT_THAT(traces, SizeIs(2));
    const double border_m = 25 * kilometre_m() / 50;
    EXPECT_EQ(traces[0].chunk, (ChunkKey{1, true, 0}));
    EXPECT_EQ(traces[0].first_m, 0); // where the match begins: nothing from before it is told
    EXPECT_NEAR(last_m(traces[0]), border_m + 10, 1);
    EXPECT_EQ(traces[1].chunk, (ChunkKey{1, true, 1}));
    EXPECT_NEAR(traces[1].first_m, border_m - 10, 1);
    EXPECT_NEAR(last_m(traces[1]), kilometre_m(), 1);
}

TEST(ChunkTraces, RiseInDrivingDirectionOnTheWayBack) {
    const auto traces = traces_of(roughness(2000, rising), {piece(back, 200, 0, kilometre_m())});
    ASSERT_THAT(traces, SizeIs(2));
    EXPECT_EQ(traces[0].chunk, (ChunkKey{1, false, 1}));
    EXPECT_NEAR(traces[0].first_m, -kilometre_m(), 1);
    EXPECT_LT(traces[0].iri.front(), traces[0].iri.back());
    EXPECT_EQ(traces[1].chunk, (ChunkKey{1, false, 0}));
    EXPECT_NEAR(last_m(traces[1]), 0, 1);
}

TEST(ChunkTraces, FollowTheMatchWhereItsRulerIsAnother) {
    auto stretched = piece(there, 0, 0, 400);
    stretched.to_travel_m = 404; // the odometer reads 1 % too much
    const auto bump = [](double travel_m) { return travel_m >= 303 && travel_m < 304 ? 9.0 : 1.0; };
    const auto traces = traces_of(roughness(2000, bump), {stretched});
    ASSERT_THAT(traces, SizeIs(1));
    EXPECT_EQ(std::ranges::max_element(traces[0].iri) - traces[0].iri.begin(), 300);
}

TEST(ChunkTraces, AreOnePerDriveAndPassesSayWhichIsTheirs) {
    const MatchedTrace matched{piece(there, 0, 0, 400),
                               piece(back, 400, kilometre_m() - 400, 400),
                               piece(there, 800, 0, 400)};
    const auto trace = roughness(2000, rising);
    const auto traces = traces_of(trace, matched);
    ASSERT_THAT(traces, SizeIs(3));
    EXPECT_EQ(traces[0].drive, 0U);
    EXPECT_EQ(traces[1].drive, 0U); // of the other direction's chunk
    EXPECT_EQ(traces[2].drive, 1U);
    const auto passes = cut_trip(trace, matched, kilometre(), car(), {}).passes;
    ASSERT_THAT(passes, SizeIs(60));
    for (std::size_t i = 0; i < passes.size(); ++i) {
        EXPECT_EQ(passes[i].pass.drive, i < 40 ? 0U : 1U);
    }
}

TEST(ChunkTraces, GoOnOverAShortSilenceAndEndAtALongOne) {
    const auto with_silence = [](double silence_m) {
        return traces_of(
            roughness(2000, rising),
            {piece(there, 0, 0, 100), piece(there, 100 + silence_m, 100 + silence_m, 100)});
    };
    EXPECT_THAT(with_silence(15), SizeIs(1));
    EXPECT_THAT(with_silence(30), SizeIs(2));
}

TEST(ChunkTraces, LeaveOutWhatIsNotSureOfItsRoad) {
    const MatchedTrace doubtful{piece(there, 0, 0, 100, 0.19)};
    EXPECT_THAT(traces_of(roughness(2000, rising), doubtful), IsEmpty());
    EXPECT_THAT(traces_of({}, {piece(there, 0, 0, 100)}), IsEmpty());
    EXPECT_THAT(traces_of(roughness(2000, rising), {}), IsEmpty());
}

TEST(ChunkTraces, AreAsSureOfTheirPlaceAsTheMatchWasOnTheMean) {
    const auto sd_mm = [](double first_sd_m, double last_sd_m) {
        MatchedTrace matched{piece(there, 0, 0, 100), piece(there, 100, 100, 300)};
        matched[0].offset_sd_m = first_sd_m;
        matched[1].offset_sd_m = last_sd_m;
        return traces_of(roughness(2000, rising), matched).at(0).place_sd_mm;
    };
    EXPECT_EQ(sd_mm(6, 2), 3000);       // by length
    EXPECT_EQ(sd_mm(1.34, 1.34), 1300); // whole decimetres
    EXPECT_EQ(sd_mm(0.01, 0.01), 300);  // nobody is so sure
    EXPECT_EQ(sd_mm(1e9, 1e9), 50'000);
    EXPECT_EQ(sd_mm(0, 0), 2500); // not stated: as usual
}

TEST(ChunkTraces, HoldPlacesWithoutRoughnessOpen) {
    auto trace = roughness(150, rising);
    auto later = roughness(100, rising).runs[0];
    later.start_travel_m = 180;
    trace.runs.push_back(later);
    const auto traces = traces_of(trace, {piece(there, 0, 0, 300)});
    ASSERT_THAT(traces, SizeIs(1));
    EXPECT_NEAR(last_m(traces[0]), 280, 1);
    EXPECT_EQ(traces[0].iri[100], code_of(2 * rising(100.5)));
    EXPECT_EQ(traces[0].iri[165], no_roughness);
}

// -------------------------------------------------------------------------------- moved passes

/// A chunk read at 1 mm/m until 100 m and 2.4 from there on; codes hold all of it exactly.
RoughnessTrace step_at_100_m() {
    RoughnessTrace trace{.chunk = {1, true, 0},
                         .drive = 0,
                         .first_m = -10,
                         .iri = {},
                         .left = {},
                         .place_sd_mm = 1000};
    for (int at_m = -10; at_m < 210; ++at_m) {
        trace.iri.push_back(code_of(at_m < 100 ? 1 : 2.4));
        trace.left.push_back(code_of(at_m < 100 ? 0.8 : 1.6));
    }
    return trace;
}

Pass pass_over_20_m(IriUm iri_um) {
    Pass pass{};
    pass.segment = {1, true, 4};
    pass.iri_um = iri_um;
    pass.sd_um = iri_um / 10;
    pass.iri_left_um = iri_um * 8 / 10;
    pass.iri_right_um = iri_um * 12 / 10;
    pass.iri_centre_um = iri_um * 9 / 10;
    pass.covered_mm = 20000;
    pass.speed_mmps = 15000;
    return pass;
}

TEST(MovedPasses, AreTheSameWithoutALag) {
    const auto pass = pass_over_20_m(1234);
    const auto same = moved(pass, 80, 100, step_at_100_m(), 0, 0);
    EXPECT_EQ(same.iri_um, 1234);
    EXPECT_EQ(same.iri_left_um, pass.iri_left_um);
    EXPECT_EQ(same.sd_um, pass.sd_um);
}

TEST(MovedPasses, ReadWhatLiesBehindTheLag) {
    const auto pass = moved(pass_over_20_m(1000), 80, 100, step_at_100_m(), 5, 5);
    EXPECT_EQ(pass.iri_um, 1350); // 15 m of 1 and 5 m of 2.4
    EXPECT_EQ(pass.iri_left_um, 1000);
    EXPECT_EQ(pass.iri_right_um, 1700); // the headline is the mean of both
    EXPECT_EQ(pass.iri_centre_um, 1215);
    EXPECT_EQ(pass.sd_um, 135); // the same share
    EXPECT_EQ(pass.covered_mm, 20000);
    EXPECT_EQ(pass.speed_mmps, 15000);
}

TEST(MovedPasses, ReadPartsOfMetres) {
    EXPECT_EQ(moved(pass_over_20_m(1000), 80, 100, step_at_100_m(), 0.5, 0.5).iri_um, 1035);
}

TEST(MovedPasses, AreStretchedWhereTheLagChanges) {
    const auto pass = moved(pass_over_20_m(1000), 80, 100, step_at_100_m(), 0, 5);
    EXPECT_EQ(pass.iri_um, 1280); // 20 m of 1 and 5 m of 2.4
}

TEST(MovedPasses, CoverNoMoreThanTheTripDid) {
    const auto pass = moved(pass_over_20_m(1000), -5, 15, step_at_100_m(), -9, -9);
    EXPECT_EQ(pass.covered_mm, 16000); // from -10 to 6 of -14 to 6
    EXPECT_EQ(pass.iri_um, 1000);
    const auto held = moved(pass_over_20_m(1234), 195, 215, step_at_100_m(), 8, 8);
    EXPECT_EQ(held.iri_um, 1234); // only 7 m of 203 to 223 were read
    EXPECT_EQ(held.covered_mm, 20000);
}

} // namespace
} // namespace macadam
