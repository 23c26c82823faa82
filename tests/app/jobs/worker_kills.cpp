// The long test of workers: as worker_program_test.cpp, with many more kills.

#include "app/jobs/worker_world.hpp"

#include <gtest/gtest.h>

#include <cstddef>

namespace macadam::testing {
namespace {

TEST(Workers, LoseNothingInThreeHundredKillsOverThreeThousandTrips) {
    WorkerWorld world;
    constexpr std::size_t trips = 3000, kills = 300;
    world.make_trips(trips);
    ASSERT_EQ(run_macadam(world.submit_words()).exit_status, 0);
    kill_workers(world, {.workers = 3, .kills = kills, .trips = trips});
    expect_all_imported(world, trips);
}

} // namespace
} // namespace macadam::testing
