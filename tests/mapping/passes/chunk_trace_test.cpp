#include "mapping/passes/chunk_trace.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

TEST(RoughnessCode, IsRightToOneInSixtyOrAHundredthOfAMillimetre) {
    for (double mm_per_m = 0; mm_per_m < 79; mm_per_m += 0.0037) {
        const auto um = um_of(code_of(mm_per_m));
        ASSERT_TRUE(um);
        EXPECT_LE(std::abs(*um / 1000.0 - mm_per_m), std::max(0.010001, mm_per_m / 64)) << mm_per_m;
    }
}

TEST(RoughnessCode, IsTheNearestOfAll) {
    for (double mm_per_m = 0; mm_per_m < 79; mm_per_m += 0.0731) {
        double nearest = 1e9;
        for (int code = 0; code < no_roughness; ++code) {
            nearest = std::min(
                nearest, std::abs(*um_of(static_cast<RoughnessCode>(code)) / 1000.0 - mm_per_m));
        }
        EXPECT_NEAR(std::abs(*um_of(code_of(mm_per_m)) / 1000.0 - mm_per_m), nearest, 1e-9);
    }
}

TEST(RoughnessCode, RisesWithWhatItStandsForAndComesBack) {
    for (int code = 0; code < no_roughness; ++code) {
        const auto um = um_of(static_cast<RoughnessCode>(code));
        EXPECT_EQ(code_of(*um / 1000.0), code);
        if (code > 0) {
            EXPECT_GT(*um, *um_of(static_cast<RoughnessCode>(code - 1)));
        }
    }
}

TEST(RoughnessCode, HoldsWhatNoRoadReachesAtTheMost) {
    EXPECT_EQ(um_of(code_of(1e6)), 79360);
    EXPECT_EQ(um_of(code_of(std::numeric_limits<double>::infinity())), 79360);
    EXPECT_EQ(um_of(no_roughness), std::nullopt);
}

TEST(Chunks, AreHalfAKilometreOfWholeSegments) {
    EXPECT_EQ(chunk_of({7, true, 24}, 20), (ChunkKey{7, true, 0}));
    EXPECT_EQ(chunk_of({7, true, 25}, 20), (ChunkKey{7, true, 1}));
    EXPECT_EQ(chunk_of({7, false, 60}, 20), (ChunkKey{7, false, 2}));
    EXPECT_EQ(chunk_of({7, true, 9}, 100), (ChunkKey{7, true, 1}));
    EXPECT_EQ(chunk_of({7, true, 9}, 1000), (ChunkKey{7, true, 9})); // at least one
}

} // namespace
} // namespace macadam
