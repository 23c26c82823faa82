#include "estimator/roughness/roughness_mean.hpp"
#include "mapping/passes/track_difference.hpp"
#include "mapping/passes/trip_cutting.hpp"

#include "support/roads/road_art.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <random>
#include <utility>
#include <vector>

namespace macadam {
namespace {

using ::testing::Each;
using ::testing::Field;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const Vehicle& car() {
    return *built_in_vehicle("golden-car");
}

/// A hundred metres of road, 5 segments each way.
testing::RoadArt straight() {
    return testing::road_art("A---------B", 10, {"AB"});
}

IriRun empty_run() {
    IriRun run{};
    run.cell_m = 0.25;
    return run;
}

IriTrace trace_of(IriRun run) {
    IriTrace trace;
    trace.runs.push_back(std::move(run));
    return trace;
}

/// Roughness along travel [0, length_m), with nothing lost to a lead-in.
IriTrace trace_of(double length_m,
                  const std::function<float(double travel_m)>& left,
                  const std::function<float(double travel_m)>& right) {
    auto run = empty_run();
    for (double at_m = 0.125; at_m < length_m; at_m += run.cell_m) {
        run.left_mm_per_m.push_back(left(at_m));
        run.right_mm_per_m.push_back(right(at_m));
        run.centre_mm_per_m.push_back(0.9F * (left(at_m) + right(at_m)) / 2);
        run.speed_mps.push_back(15);
    }
    return trace_of(std::move(run));
}

IriTrace even_trace(double length_m, float iri) {
    const auto even = [iri](double) { return iri; };
    return trace_of(length_m, even, even);
}

/// Driven at 10 m/s.
MatchedInterval piece(EdgeId edge,
                      double from_travel_m,
                      double from_offset_m,
                      double length_m,
                      double confidence = 1) {
    return {IntervalKind::road,
            edge,
            from_travel_m,
            from_travel_m + length_m,
            from_offset_m,
            from_offset_m + length_m,
            from_travel_m / 10,
            (from_travel_m + length_m) / 10,
            confidence,
            ""};
}

MatchedInterval silence(double from_travel_m, double length_m) {
    auto gap = piece(EdgeId{0}, from_travel_m, 0, length_m, 0);
    gap.kind = IntervalKind::gap;
    return gap;
}

std::vector<Pass>
passes_of(const IriTrace& roughness, const MatchedTrace& matched, const testing::RoadArt& art) {
    const auto cut = cut_trip(roughness, matched, art.roads, car(), {});
    std::vector<Pass> passes;
    std::ranges::transform(cut.passes, std::back_inserter(passes), &DrivenPass::pass);
    return passes;
}

constexpr auto there = EdgeId{0};
constexpr auto back = EdgeId{1};

TEST(Passes, PutTheRoughnessOfTheTripIntoTheSegmentsItDrove) {
    const auto art = straight();
    // Each 20 m rougher than the last: 1, 2, ... mm/m; the right track always 1 more.
    const auto step = [](double at_m) {
        return static_cast<float>(1 + std::floor((at_m - 50) / 20));
    };
    const auto trace = trace_of(150, step, [&](double at_m) { return step(at_m) + 1; });
    const auto length = length_m(art.roads, there);
    const auto passes = passes_of(trace, {piece(there, 50, 0, length)}, art);
    ASSERT_THAT(passes, SizeIs(5));
    for (int i = 0; i < 5; ++i) {
        const auto& pass = passes[static_cast<std::size_t>(i)];
        EXPECT_EQ(pass.segment, (SegmentKey{1, true, static_cast<std::uint32_t>(i)}));
        // The road is a few mm off 100 m, and cells of 0.25 m fall to one side of a border.
        EXPECT_NEAR(*pass.iri_left_um, 1000 * (1 + i), 20);
        EXPECT_NEAR(*pass.iri_right_um, 1000 * (2 + i), 20);
        EXPECT_NEAR(pass.iri_um, 1000 * (1.5 + i), 20);
        EXPECT_NEAR(static_cast<double>(pass.t_ms), 1000 * (6 + 2 * i), 10);
        EXPECT_NEAR(pass.covered_mm, 20000, 300);
        EXPECT_EQ(pass.speed_mmps, 15000);
        EXPECT_EQ(pass.confidence_ppm, 1'000'000);
        EXPECT_FALSE(pass.centre_only);
    }
}

TEST(Passes, OfTheOtherDirectionCountDown) {
    const auto art = straight();
    const auto passes =
        passes_of(even_trace(100, 2), {piece(back, 0, 0, length_m(art.roads, back))}, art);
    ASSERT_THAT(passes, SizeIs(5));
    EXPECT_EQ(passes.front().segment, (SegmentKey{1, false, 4}));
    EXPECT_EQ(passes.back().segment, (SegmentKey{1, false, 0}));
}

TEST(Passes, OfPiecesOfOneTraversalAddUp) {
    const auto art = straight();
    const auto trace = trace_of(
        40,
        [](double at_m) { return at_m < 25 ? 1.F : 3.F; },
        [](double at_m) { return at_m < 25 ? 1.F : 3.F; });
    const auto whole = passes_of(trace, {piece(there, 0, 0, 40)}, art);
    const auto pieces = passes_of(trace, {piece(there, 0, 0, 25), piece(there, 25, 25, 15)}, art);
    ASSERT_THAT(pieces, SizeIs(2));
    EXPECT_EQ(pieces[1].iri_um, whole[1].iri_um);
    EXPECT_NEAR(pieces[1].iri_um, 2500, 30); // 5 m of 1 and 15 m of 3; a cell on either side
}

TEST(Passes, GoOnAfterAShortSilence) {
    const auto art = straight();
    const auto passes = passes_of(
        even_trace(40, 2), {piece(there, 0, 0, 28), silence(28, 4), piece(there, 32, 32, 8)}, art);
    ASSERT_THAT(passes, SizeIs(2));
    EXPECT_NEAR(passes[1].covered_mm, 16000, 300);
}

TEST(Passes, CountEachReturn) {
    const auto art = straight();
    const double length = length_m(art.roads, there);
    const auto passes = passes_of(even_trace(400, 2),
                                  {piece(there, 0, 0, length),
                                   piece(back, length, 0, length),
                                   piece(there, 2 * length, 0, length)},
                                  art);
    ASSERT_THAT(passes, SizeIs(15));
    EXPECT_EQ(passes[2].occurrence, 0U);
    EXPECT_EQ(passes[7].occurrence, 0U); // the other direction is another segment
    EXPECT_EQ(passes[12].occurrence, 1U);
    EXPECT_EQ(passes[12].segment, passes[2].segment);
}

TEST(Passes, AreLeftOutWhereLessThanHalfOfTheSegmentIsCovered) {
    const auto art = straight();
    EXPECT_THAT(passes_of(even_trace(100, 2), {piece(there, 0, 0, 29)}, art), SizeIs(1));
    EXPECT_THAT(passes_of(even_trace(100, 2), {piece(there, 0, 0, 31)}, art), SizeIs(2));
}

TEST(Passes, AreLeftOutWhereTheMatchIsInDoubt) {
    const auto art = straight();
    EXPECT_THAT(passes_of(even_trace(100, 2), {piece(there, 0, 0, 100, 0.19)}, art), IsEmpty());
    EXPECT_THAT(passes_of(even_trace(100, 2), {piece(there, 0, 0, 100, 0.21)}, art), SizeIs(5));
}

TEST(Passes, AreLeftOutWhereNothingWasReadOfTheRoad) {
    const auto art = straight();
    EXPECT_THAT(passes_of({}, {piece(there, 0, 0, 100)}, art), IsEmpty());
    EXPECT_THAT(passes_of(even_trace(100, 2), {silence(0, 100)}, art), IsEmpty());
}

TEST(Passes, SayWhatTheCentreAloneTellsOfBothTracks) {
    const auto art = straight();
    auto run = empty_run();
    run.centre_mm_per_m.assign(400, 1.82F);
    run.speed_mps.assign(400, 15);
    const auto trace = trace_of(std::move(run));
    const auto passes = passes_of(trace, {piece(there, 0, 0, 99)}, art);
    ASSERT_THAT(passes, SizeIs(5));
    EXPECT_THAT(passes, Each(Field(&Pass::centre_only, true)));
    EXPECT_THAT(passes, Each(Field(&Pass::iri_left_um, std::nullopt)));
    EXPECT_EQ(passes[0].iri_centre_um, 1820);
    EXPECT_EQ(passes[0].iri_um, 2000); // 1.82 / 0.91
    EXPECT_TRUE(passes[0].validity & validity::indicative);
    const auto mean = mean_over(trace, 0, passes[0].covered_mm / 1000.0, car());
    const double relative = std::hypot(mean.sd_mm_per_m / 1.82, 0.055 / 0.91);
    EXPECT_NEAR(passes[0].sd_um, 2000 * relative, 1);
}

/// Run over two independent random walks: their mean has an HRI of 2, and half of their difference
/// is `times` as high from `from_m` on.
IriTrace over_two_tracks(double length_m, double leaning, double from_m, double times) {
    std::mt19937 random{5};
    std::normal_distribution<float> step{0, 1e-3F};
    auto run = empty_run();
    run.profile.step_m = run.cell_m;
    float mean = 0;
    float half = 0;
    for (double at_m = 0; at_m < length_m; at_m += run.cell_m) {
        mean += step(random);
        half += static_cast<float>(leaning * (at_m < from_m ? 1 : times)) * step(random);
        run.profile.left_m.push_back(mean + half);
        run.profile.right_m.push_back(mean - half);
        run.profile.centre_m.push_back(mean);
        run.profile.left_error_m.push_back(0);
        run.profile.right_error_m.push_back(0);
        run.centre_mm_per_m.push_back(2);
        run.speed_mps.push_back(15);
    }
    return trace_of(std::move(run));
}

TEST(HriRatio, FallsWhereTheTracksDifferMoreThanElsewhereOnTheTrip) {
    const auto tracks = track_difference_of(over_two_tracks(8000, 0.5, 7500, 1.3), car());
    ASSERT_TRUE(tracks);
    EXPECT_NEAR(ratio_over(tracks, 100, 7400).hri_over_mri, 0.91, 0.01);
    // r^2 of 1.69 times the usual, of which 0.6 is believed: 1/sqrt(1 + 0.2076 * 1.414) = 0.879
    EXPECT_NEAR(ratio_over(tracks, 7600, 7990).hri_over_mri, 0.879, 0.02);
    EXPECT_LT(ratio_over(tracks, 100, 7400).sd, sd_hri_over_mri);
}

TEST(HriRatio, DoesNotDependOnHowMuchACarLeans) {
    const auto tracks = track_difference_of(over_two_tracks(4000, 0.5, 2000, 1.2), car());
    const auto leaning = track_difference_of(over_two_tracks(4000, 0.7, 2000, 1.2), car());
    ASSERT_TRUE(tracks && leaning);
    for (const double from_m : {100.0, 1000.0, 3000.0}) {
        EXPECT_NEAR(ratio_over(tracks, from_m, from_m + 20).hri_over_mri,
                    ratio_over(leaning, from_m, from_m + 20).hri_over_mri,
                    1e-3); // elevations are single precision
    }
}

/// 1/sqrt(1 + 0.7^2) = 0.819, of whose distance from 0.91 two thirds are believed.
TEST(HriRatio, FollowsTheTripsOwnTracksUnderStatedAxles) {
    auto with_axles = car();
    with_axles.axles = Axles{.wheelbase_m = 2.7, .cg_to_front_m = 1.3};
    const auto trace = over_two_tracks(6000, 0.7, 6000, 1);
    const auto tracks = track_difference_of(trace, with_axles);
    ASSERT_TRUE(tracks);
    EXPECT_NEAR(tracks->trip_ratio, 0.849, 0.01);
    EXPECT_NEAR(ratio_over(tracks, 100, 5900).hri_over_mri, 0.849, 0.01);
    EXPECT_EQ(track_difference_of(trace, car())->trip_ratio, hri_over_mri);
}

TEST(HriRatio, IsTheUsualOneWhereTheDifferenceIsUnknown) {
    EXPECT_FALSE(track_difference_of(even_trace(5000, 2), car()));
    EXPECT_FALSE(track_difference_of(over_two_tracks(900, 0.5, 900, 1), car()));
    EXPECT_EQ(ratio_over(std::nullopt, 0, 20).hri_over_mri, hri_over_mri);
    const auto tracks = track_difference_of(over_two_tracks(2000, 0.5, 2000, 1), car());
    EXPECT_EQ(ratio_over(tracks, 3000, 3020).hri_over_mri, hri_over_mri);
    EXPECT_EQ(ratio_over(tracks, 3000, 3020).sd, sd_hri_over_mri);
}

} // namespace
} // namespace macadam
