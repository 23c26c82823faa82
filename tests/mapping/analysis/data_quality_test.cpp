#include "mapping/analysis/data_quality.hpp"

#include <gtest/gtest.h>

namespace macadam {
namespace {

MeasuredSegment segment(double length_m, bool centre_only, std::uint8_t flags) {
    MeasuredSegment segment{};
    segment.from_m = 100;
    segment.to_m = 100 + length_m;
    segment.centre_only = centre_only;
    segment.validity = flags;
    return segment;
}

TEST(DataQuality, PartsWhatIsMeasuredByWhatWasFelt) {
    using namespace validity; // NOLINT(google-build-using-namespace): flags
    const auto q = data_quality(std::vector{segment(20, false, ok),
                                            segment(30, true, indicative),
                                            segment(40, true, indicative | lateral_alone),
                                            segment(50, true, indicative | gap)});
    EXPECT_EQ(q.measured.segments, 4U);
    EXPECT_EQ(q.measured.length_m, 140);
    EXPECT_EQ(q.both_tracks.length_m, 20);
    EXPECT_EQ(q.inferred.segments, 2U);
    EXPECT_EQ(q.inferred.length_m, 80);
    EXPECT_EQ(q.lateral_alone.length_m, 40);
    EXPECT_EQ(q.gap.length_m, 50);
    EXPECT_EQ(q.too_slow.segments, 0U);
}

} // namespace
} // namespace macadam
