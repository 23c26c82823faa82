#include "mapping/analysis/data_quality.hpp"

#include <gtest/gtest.h>

namespace macadam {
namespace {

SegmentRecord record(double length_m, bool centre_only, std::uint8_t flags) {
    SegmentRecord record{};
    record.segment.from_m = 100;
    record.segment.to_m = 100 + length_m;
    record.state.emplace();
    record.state->centre_only = centre_only;
    record.state->validity = flags;
    return record;
}

TEST(DataQuality, PartsWhatIsMeasuredByWhatWasFelt) {
    using namespace validity; // NOLINT(google-build-using-namespace): flags
    const auto q = data_quality(std::vector{record(20, false, ok),
                                            record(30, true, indicative),
                                            record(40, true, indicative | lateral_alone),
                                            record(50, true, indicative | gap)});
    EXPECT_EQ(q.measured.segments, 4U);
    EXPECT_EQ(q.measured.length_m, 140);
    EXPECT_EQ(q.both_tracks.length_m, 20);
    EXPECT_EQ(q.inferred.segments, 2U);
    EXPECT_EQ(q.inferred.length_m, 80);
    EXPECT_EQ(q.lateral_alone.length_m, 40);
    EXPECT_EQ(q.gap.length_m, 50);
    EXPECT_EQ(q.too_slow.segments, 0U);
}

TEST(DataQuality, PassesOverWhatIsNotMeasured) {
    EXPECT_EQ(data_quality(std::vector{SegmentRecord{}}).measured.segments, 0U);
}

} // namespace
} // namespace macadam
