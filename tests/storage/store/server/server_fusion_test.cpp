// Fusion on a PostgreSQL server beside others that hold chunks.

#include "storage/store/server/importer/server_fusion.hpp"

#include "storage/postgres/server_connection.hpp"
#include "support/files/files.hpp"
#include "support/roads/crowd_drives.hpp"
#include "support/roads/engine_world.hpp"
#include "support/roads/store_world.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <future>
#include <stop_token>
#include <thread>

namespace macadam::testing {
namespace {

/// Trip over many roads that waits for its fusion.
class ServerFusions : public ::testing::Test {
protected:
    ServerFusions() {
        const CrowdDrive drive{1, 1, january_ms, 2000, false, road_count};
        const auto record = drive.record();
        const auto passes = drive.passes();
        const NewTrip trip{&record, passes, {}, false, {}};
        open_.trips->add_trips({&trip, 1});
        all_ = open_.trips->waiting();
    }

    std::size_t fuse(BusyChunks busy, const Progress& progress = {}) {
        FusionRecord fused;
        return open_.trips->refresh(progress, fused, busy);
    }

    /// Has another connection hold the first chunk, as one that stands still while it fuses.
    void hold_a_chunk() {
        holder_.begin(false);
        holder_.rows("SELECT pg_advisory_xact_lock(min(chunk)) FROM macadam.chunk_dirty");
    }

    std::int64_t waiting_chunks() {
        return watch_.number("SELECT count(DISTINCT chunk) FROM macadam.chunk_dirty");
    }

    static constexpr int road_count = 80; // chunks, more than are fused in one transaction
    EngineDatabase database_{
        Engine::postgresql, test_folder(), roads_in_a_row(road_count), settings()};
    ImportStore open_ = database_.import();
    ServerConnection holder_{database_.name()};
    ServerConnection watch_{database_.name()};
    std::size_t all_ = 0; ///< segments
};

TEST_F(ServerFusions, LeaveTheRestToTheNextCallWhenTheyAreStopped) {
    std::stop_source enough;
    const auto first = fuse(BusyChunks::await,
                            {.report = [&](std::size_t, std::size_t) { enough.request_stop(); },
                             .stop = enough.get_token()});
    EXPECT_GT(first, 0U);
    EXPECT_GT(open_.trips->waiting(), 0U);
    EXPECT_EQ(first + open_.trips->waiting(), all_);
    EXPECT_EQ(first + fuse(BusyChunks::await), all_);
    EXPECT_EQ(open_.trips->waiting(), 0U);
}

TEST_F(ServerFusions, LeaveAChunkThatAnotherHoldsToTheNextCall) {
    hold_a_chunk();
    const auto first = fuse(BusyChunks::leave);
    EXPECT_EQ(waiting_chunks(), 1);
    EXPECT_EQ(first + open_.trips->waiting(), all_);
    EXPECT_EQ(fuse(BusyChunks::leave), 0U);
    holder_.roll_back();
    EXPECT_EQ(first + fuse(BusyChunks::leave), all_);
    EXPECT_EQ(waiting_chunks(), 0);
}

TEST_F(ServerFusions, OfAllEndOnceAlsoAChunkThatAnotherHeldIsFused) {
    hold_a_chunk();
    auto fusing = std::async(std::launch::async, [&] { return fuse(BusyChunks::await); });
    while (waiting_chunks() > 1) { // the others are fused meanwhile
        std::this_thread::sleep_for(std::chrono::milliseconds{10});
    }
    EXPECT_EQ(fusing.wait_for(std::chrono::milliseconds{300}), std::future_status::timeout);
    holder_.roll_back();
    EXPECT_EQ(fusing.get(), all_);
    EXPECT_EQ(waiting_chunks(), 0);
}

TEST_F(ServerFusions, OfAllAreStoppedWhileAnotherHoldsAChunk) {
    hold_a_chunk();
    std::stop_source enough;
    auto fusing = std::async(std::launch::async, [&] {
        return fuse(BusyChunks::await, {.report = {}, .stop = enough.get_token()});
    });
    while (waiting_chunks() > 1) {
        std::this_thread::sleep_for(std::chrono::milliseconds{10});
    }
    enough.request_stop();
    EXPECT_LT(fusing.get(), all_);
    EXPECT_EQ(waiting_chunks(), 1);
}

} // namespace
} // namespace macadam::testing
