// In which order the chunks that wait on a server have their turn.

#include "storage/store/server/importer/marked_chunks.hpp"

#include "support/files/files.hpp"
#include "support/roads/engine_world.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace macadam::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class MarkedChunksOnServer : public ::testing::Test {
protected:
    /// Marks a chunk for three trips.
    void mark(std::int64_t chunk, std::int64_t since_ms) {
        server_.rows(
            "INSERT INTO macadam.chunk_dirty (chunk, trip, since_ms)"
            " SELECT $1::bigint, trip, $2::bigint + trip FROM generate_series(1, 3) AS trip",
            {std::to_string(chunk), std::to_string(since_ms)});
    }

    void unmark(const std::vector<std::int64_t>& chunks) {
        for (const auto chunk : chunks) {
            server_.rows("DELETE FROM macadam.chunk_dirty WHERE chunk = $1",
                         {std::to_string(chunk)});
        }
    }

    EngineDatabase database_{Engine::postgresql, test_folder()};
    ServerConnection server_{database_.name()};
};

TEST_F(MarkedChunksOnServer, ComeOldestFirstWhereFewWait) {
    MarkedChunks marked{server_, 10};
    EXPECT_THAT(marked.next(), IsEmpty());
    mark(11, 500);
    mark(21, 300);
    mark(31, 400);
    marked.begin_round();
    EXPECT_THAT(marked.next(), ElementsAre(21, 31, 11));
    EXPECT_THAT(marked.next(), ElementsAre(21, 31, 11)); // nobody said that they are done
    unmark({21, 31, 11});
    marked.advance();
    EXPECT_THAT(marked.next(), IsEmpty());
}

TEST_F(MarkedChunksOnServer, HaveEachOneTurnInARoundWhereManyWait) {
    for (std::int64_t chunk = 1; chunk <= 7; ++chunk) {
        mark(chunk, 1000 - chunk);
    }
    MarkedChunks marked{server_, 3};
    marked.begin_round();
    EXPECT_THAT(marked.next(), ElementsAre(3, 2, 1));
    marked.advance();
    mark(100, 1); // comes during the round
    EXPECT_THAT(marked.next(), ElementsAre(6, 5, 4));
    marked.advance();
    EXPECT_THAT(marked.next(), ElementsAre(100, 7));
    marked.advance();
    EXPECT_THAT(marked.next(), IsEmpty()); // though all are still marked
    marked.begin_round();
    EXPECT_THAT(marked.next(), ElementsAre(3, 2, 1));
}

TEST_F(MarkedChunksOnServer, GoOnWhereARoundWasLeft) {
    for (std::int64_t chunk = 1; chunk <= 5; ++chunk) {
        mark(chunk, chunk);
    }
    MarkedChunks marked{server_, 2};
    marked.begin_round();
    EXPECT_THAT(marked.next(), ElementsAre(1, 2));
    marked.advance();
    EXPECT_THAT(marked.next(), ElementsAre(3, 4)); // and somebody stops it
    marked.begin_round();
    EXPECT_THAT(marked.next(), ElementsAre(3, 4));
    marked.advance();
    EXPECT_THAT(marked.next(), ElementsAre(5));
    marked.advance();
    EXPECT_THAT(marked.next(), ElementsAre(1, 2));
    marked.advance();
    EXPECT_THAT(marked.next(), IsEmpty());
    marked.begin_round();
    EXPECT_THAT(marked.next(), ElementsAre(1, 2));
}

} // namespace
} // namespace macadam::testing
