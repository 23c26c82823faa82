// The long test of workers: as worker_program_test.cpp, with many more kills.

#include "app/jobs/worker_world.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>

namespace macadam::testing {
namespace {

using namespace std::chrono_literals;

TEST(Workers, LoseNothingInThreeHundredKillsOverThreeThousandTrips) {
    WorkerWorld world;
    constexpr std::size_t trips = 3000, kills = 300;
    world.make_trips(trips);
    ASSERT_EQ(run_macadam(world.submit_words()).exit_status, 0);
    EXPECT_EQ(kill_workers(world, {.workers = 3, .kills = kills, .longest_life = 600ms}), kills);
    expect_all_imported(world, trips);
}

} // namespace
} // namespace macadam::testing
