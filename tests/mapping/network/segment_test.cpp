#include "mapping/network/segment.hpp"

#include "estimator/common/error.hpp"
#include "mapping/style/iri_class.hpp"
#include "support/roads/road_art.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::ThrowsMessage;

TEST(SegmentKey, IsWrittenWithItsDirectionAsTheSign) {
    EXPECT_EQ(name_of({123456, true, 7}), "123456+0007");
    EXPECT_EQ(name_of({123456, false, 12345}), "123456-12345");
}

TEST(SegmentKey, ReadsWhatItWrites) {
    for (const auto& key : {SegmentKey{1, true, 0}, {-5, false, 3}, {9'000'000'000, true, 99999}}) {
        EXPECT_EQ(parse_segment_key(name_of(key)), key);
    }
}

TEST(SegmentKey, RefusesWhatIsNone) {
    for (const auto* text : {"", "123", "+0001", "12+001", "12+0001x", "a+0001", "1+99999999999"}) {
        EXPECT_THAT([&] { parse_segment_key(text); },
                    ThrowsMessage<InputError>(HasSubstr("expected a key such as 123456+0007")))
            << text;
    }
}

TEST(SegmentKey, StandsForwardBeforeBackward) {
    std::vector<SegmentKey> keys{{2, true, 0}, {1, false, 0}, {1, true, 1}, {1, true, 0}};
    std::sort(keys.begin(), keys.end());
    EXPECT_THAT(keys,
                ElementsAre(SegmentKey{1, true, 0},
                            SegmentKey{1, true, 1},
                            SegmentKey{1, false, 0},
                            SegmentKey{2, true, 0}));
}

TEST(Segments, CutAnEdgeIntoEqualPartsWithoutHoles) {
    const auto art = testing::road_art("A---------B", 10, {"AB"}); // 100 m
    const auto segments = segments_of(art.roads, edge_of(LinkId{0}, true));
    ASSERT_THAT(segments, SizeIs(5));
    for (std::size_t i = 0; i < segments.size(); ++i) {
        EXPECT_EQ(segments[i].key, (SegmentKey{1, true, static_cast<std::uint32_t>(i)}));
        EXPECT_NEAR(segments[i].to_m - segments[i].from_m, 20, 0.01);
        if (i > 0) {
            EXPECT_EQ(segments[i].from_m, segments[i - 1].to_m);
            EXPECT_EQ(segments[i].line.front(), segments[i - 1].line.back());
        }
    }
}

TEST(Segments, KeepThePointsOfTheirRoad) {
    const auto art = testing::road_art(R"(
        A--B
           |
           C
    )",
                                       6,
                                       {"ABC"}); // 18 m, then 24 m: two parts of 21 m
    const auto segments = segments_of(art.roads, edge_of(LinkId{0}, true));
    ASSERT_THAT(segments, SizeIs(2));
    EXPECT_THAT(segments[0].line, SizeIs(3));
    EXPECT_EQ(segments[0].line[1], art.places.at('B'));
    EXPECT_THAT(segments[1].line, SizeIs(2));
}

TEST(Segments, RunBackwardOnTheSameRoadWithTheSameReference) {
    const auto art = testing::road_art("A-------------B", 5, {"AB"});
    const auto there = segments_of(art.roads, edge_of(LinkId{0}, true));
    auto back = segments_of(art.roads, edge_of(LinkId{0}, false));
    ASSERT_EQ(back.size(), there.size());
    EXPECT_EQ(back.front().line.front(), art.places.at('B'));
    std::reverse(back.begin(), back.end());
    for (std::size_t i = 0; i < there.size(); ++i) {
        std::reverse(back[i].line.begin(), back[i].line.end());
        EXPECT_EQ(back[i].key, (SegmentKey{1, false, there[i].key.index}));
        EXPECT_EQ(back[i].line, there[i].line);
        EXPECT_EQ(back[i].from_m, there[i].from_m);
        EXPECT_EQ(back[i].to_m, there[i].to_m);
    }
}

TEST(IriClass, OfFhwaPutsBothBordersIntoFair) {
    const auto& fhwa = *class_table("fhwa");
    const auto class_at = [&](double in_per_mi) {
        return fhwa.classes[class_index(fhwa, in_per_mi / in_per_mi_of_mm_per_m)].name;
    };
    EXPECT_EQ(class_at(0), "good");
    EXPECT_EQ(class_at(std::nextafter(95, 0)), "good");
    EXPECT_EQ(class_at(95), "fair");
    EXPECT_EQ(class_at(170), "fair");
    EXPECT_EQ(class_at(170.001), "poor");
    EXPECT_EQ(class_at(1e6), "poor");
    // The same borders in mm/m, rounded: 1.499369 and 2.683081.
    EXPECT_EQ(class_at(1.4993 * in_per_mi_of_mm_per_m), "good");
    EXPECT_EQ(class_at(1.4994 * in_per_mi_of_mm_per_m), "fair");
    EXPECT_EQ(class_at(2.6830 * in_per_mi_of_mm_per_m), "fair");
    EXPECT_EQ(class_at(2.6831 * in_per_mi_of_mm_per_m), "poor");
}

TEST(IriClass, TablesRiseAndEndWithoutLimit) {
    for (const auto& table : class_tables()) {
        EXPECT_EQ(class_table(table.name), &table);
        EXPECT_TRUE(std::isinf(table.classes.back().to_mm_per_m));
        EXPECT_TRUE(std::is_sorted(
            table.classes.begin(), table.classes.end(), [](const auto& a, const auto& b) {
                return a.to_mm_per_m < b.to_mm_per_m;
            }));
    }
    EXPECT_EQ(class_table("nonsense"), nullptr);
}

} // namespace
} // namespace macadam
