#include "mapping/fusion/utc_month.hpp"
#include "mapping/privacy/drive_ends.hpp"
#include "mapping/privacy/network_blocks.hpp"
#include "mapping/privacy/published_state.hpp"
#include "mapping/privacy/release_batches.hpp"
#include "support/roads/road_art.hpp"

#include <gmock/gmock.h>

#include <set>

namespace macadam {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::int64_t january_ms = 1'767'225'600'000; // 2026-01-01
constexpr std::int64_t day_ms = 86'400'000;
constexpr std::int64_t february_ms = january_ms + 31 * day_ms;
constexpr std::int64_t march_ms = february_ms + 28 * day_ms;

// --------------------------------------------------------------------------------------- months

TEST(Months, BeginOnTheirFirstDay) {
    EXPECT_EQ(month_begin_ms(january_ms), january_ms);
    EXPECT_EQ(month_begin_ms(february_ms - 1), january_ms);
    EXPECT_EQ(next_month_ms(january_ms + 5 * day_ms), february_ms);
    EXPECT_EQ(next_month_ms(february_ms), march_ms);
    EXPECT_EQ(month_begin_ms(1'709'164'800'000), 1'706'745'600'000); // 2024-02-29
    EXPECT_EQ(next_month_ms(1'709'164'800'000), 1'709'251'200'000);
    EXPECT_EQ(month_begin_ms(-1), -2'678'400'000); // 1969-12-31
    EXPECT_EQ(next_month_ms(-1), 0);
}

// --------------------------------------------------------------------------------------- release

PendingPass pass_of(std::int64_t car, std::int64_t month_ms, bool is_new = true) {
    return {.vehicle = car, .utc_ms = month_ms + 3 * day_ms, .is_new = is_new, .has_aged = false};
}

std::vector<PendingPass> passes_of_cars(int cars, std::int64_t month_ms) {
    std::vector<PendingPass> passes;
    for (int car = 0; car < cars; ++car) {
        passes.push_back(pass_of(car, month_ms));
    }
    return passes;
}

TEST(Release, NeedsFiveCars) {
    const auto four = release(passes_of_cars(4, january_ms), {});
    EXPECT_THAT(four.batches, IsEmpty());
    EXPECT_THAT(four.left, SizeIs(4));
    EXPECT_THAT(release(passes_of_cars(5, january_ms), {}).batches, SizeIs(1));
}

TEST(Release, DoesNotTakeManyPassesOfOneCarForManyCars) {
    std::vector<PendingPass> passes(100, pass_of(1, january_ms));
    EXPECT_THAT(release(passes, {}).batches, IsEmpty());
}

TEST(Release, GivesEachMonthABatchOfItsOwnWhereEnoughCarsDrove) {
    auto passes = passes_of_cars(6, january_ms);
    for (const auto& pass : passes_of_cars(5, february_ms)) {
        passes.push_back(pass);
    }
    const auto released = release(passes, {});
    ASSERT_THAT(released.batches, SizeIs(2));
    EXPECT_EQ(released.batches[0].from_ms, january_ms);
    EXPECT_EQ(released.batches[0].until_ms, february_ms);
    EXPECT_EQ(released.batches[1].from_ms, february_ms);
    EXPECT_THAT(released.left, IsEmpty());
}

TEST(Release, JoinsMonthsUntilTheyAreOfFiveCars) {
    std::vector<PendingPass> passes;
    for (int car = 0; car < 5; ++car) {
        passes.push_back(pass_of(car, car < 3 ? january_ms : february_ms));
    }
    const auto released = release(passes, {});
    ASSERT_THAT(released.batches, SizeIs(1));
    EXPECT_EQ(released.batches[0].from_ms, january_ms);
    EXPECT_EQ(released.batches[0].until_ms, march_ms);
    EXPECT_THAT(released.batches[0].passes, ElementsAre(0, 1, 2, 3, 4));
}

TEST(Release, KeepsTheRestPending) { // or the whole less its months would tell of one car
    auto passes = passes_of_cars(5, january_ms);
    passes.push_back(pass_of(7, february_ms));
    const auto released = release(passes, {});
    ASSERT_THAT(released.batches, SizeIs(1));
    EXPECT_THAT(released.batches[0].passes, SizeIs(5));
    EXPECT_THAT(released.left, ElementsAre(5));
}

TEST(Release, PutsPassesWithoutADateIntoTheFirstBatch) {
    auto passes = passes_of_cars(5, january_ms);
    passes[2].utc_ms.reset();
    const auto released = release(passes, {});
    ASSERT_THAT(released.batches, SizeIs(1));
    EXPECT_EQ(released.batches[0].from_ms, january_ms);
}

TEST(Release, LetsNoSingleNewCarMakeAFigureAppear) {
    auto passes = passes_of_cars(5, january_ms);
    for (auto& pass : passes) {
        pass.is_new = pass.vehicle == 4;
    }
    EXPECT_THAT(release(passes, {}).batches, IsEmpty());
    passes[3].is_new = true;
    EXPECT_THAT(release(passes, {}).batches, SizeIs(1));
}

TEST(Release, CountsACarOnceThatMayHaveTwoNames) {
    const auto passes = passes_of_cars(8, january_ms);
    EXPECT_THAT(release(passes, {.last_of_key = {3}}).batches, IsEmpty()); // four and four
    EXPECT_THAT(release(passes, {.last_of_key = {4}}).batches, SizeIs(1));
}

TEST(Release, TellsOfWhatHasAgedWhoeverIsNew) {
    auto passes = passes_of_cars(5, january_ms);
    for (auto& pass : passes) {
        pass.is_new = false;
        pass.has_aged = true;
    }
    EXPECT_THAT(release(passes, {}).batches, SizeIs(1));
}

// ---------------------------------------------------------------------------------------- blocks

TEST(DriveEnds, AreTheFirstAndTheLastBlock) {
    const std::vector<BlockVisit> visits{
        {0, 1}, {1000, 1}, {2000, 2}, {3000, 3}, {4000, 4}, {5000, 4}};
    EXPECT_THAT(in_end_blocks(visits), ElementsAre(true, true, false, false, true, true));
}

TEST(DriveEnds, AreAtLongPausesToo) {
    const std::vector<BlockVisit> visits{
        {0, 1}, {1000, 2}, {2000, 3}, {400'000, 4}, {401'000, 5}, {402'000, 6}};
    EXPECT_THAT(in_end_blocks(visits), ElementsAre(true, false, true, true, false, true));
}

TEST(DriveEnds, AreAllOfADriveOverOneBlock) {
    EXPECT_THAT(in_end_blocks(std::vector<BlockVisit>{{0, 7}, {1000, 7}}), Each(true));
}

TEST(NetworkBlocks, EndAtJunctionsAndAfterFiveHundredMetres) {
    const auto roads = testing::road_art(R"(
        A---------B---------C
                  |
                  D
    )",
                                         100,
                                         {"ABC", "BD"})
                           .roads;
    const NetworkBlocks blocks{roads};
    const auto count = [&](bool forward) {
        std::set<std::uint64_t> of_way;
        for (std::uint32_t index = 0; index < 100; ++index) {
            of_way.insert(blocks.block_of({1, forward, index}));
        }
        return of_way.size();
    };
    EXPECT_EQ(count(true), 4U); // A-B and B-C, 1000 m each
    EXPECT_EQ(count(false), 4U);
    EXPECT_NE(blocks.block_of({1, true, 49}), blocks.block_of({1, true, 50}));
    EXPECT_NE(blocks.block_of({1, true, 0}), blocks.block_of({1, false, 0}));
    EXPECT_EQ(blocks.block_of({1, true, 1000}), 0U);
    EXPECT_EQ(blocks.block_of({9, true, 0}), 0U);
}

// ----------------------------------------------------------------------------------------- state

TEST(PublishedState, RoundsCountsDown) {
    EXPECT_EQ(published_count(4), 0);
    EXPECT_EQ(published_count(5), 5);
    EXPECT_EQ(published_count(9), 5);
    EXPECT_EQ(published_count(10), 10);
    EXPECT_EQ(published_count(49), 20);
    EXPECT_EQ(published_count(2'147'483'647), 2'000'000'000);
}

FusionInput reading(std::int64_t car, std::int64_t utc_ms) {
    return {.pass = {}, .trip_sha256 = "", .vehicle = car, .utc_ms = utc_ms};
}

TEST(PublishedState, TellsMonthsAndAChangeOnlyOfManyCars) {
    std::vector<FusionInput> passes;
    for (int car = 0; car < 5; ++car) {
        passes.push_back(reading(car, january_ms + car * day_ms));
    }
    SegmentState state{};
    state.iri_um = 2345;
    state.sd_um = 201;
    state.low_um = 2014;
    state.high_um = 2676;
    state.passes = 7;
    state.vehicles = 6;
    state.first_seen_ms = january_ms + 3 * day_ms;
    state.change = RoadChange{february_ms + day_ms, -812};
    auto coarse = published(state, passes, {});
    EXPECT_EQ(coarse.iri_um, 2350);
    EXPECT_EQ(coarse.sd_um, 250);
    EXPECT_EQ(coarse.low_um, 2000);
    EXPECT_EQ(coarse.high_um, 2700);
    EXPECT_EQ(coarse.passes, 5);
    EXPECT_EQ(coarse.first_seen_ms, january_ms);
    EXPECT_EQ(coarse.change, std::nullopt);
    for (int car = 0; car < 5; ++car) {
        passes.push_back(reading(car, february_ms + 2 * day_ms));
    }
    coarse = published(state, passes, {});
    ASSERT_TRUE(coarse.change);
    EXPECT_EQ(coarse.change->utc_ms, february_ms);
    EXPECT_EQ(coarse.change->um, -810);
}

} // namespace
} // namespace macadam
