#include "storage/surveys/section_file.hpp"

#include "support/files/files.hpp"

#include <gmock/gmock.h>

using namespace macadam;
using namespace macadam::testing;
using ::testing::EndsWith;
using ::testing::IsEmpty;
using ::testing::SizeIs;

namespace {

std::vector<SectionReference> read_track(const std::string& points) {
    return read_sections(
        written(test_folder(),
                "valley road.gpx",
                R"(<gpx version="1.1"><trk><trkseg>)" + points + "</trkseg></trk></gpx>"));
}

} // namespace

TEST(SectionFile, TakesTheLineOfATrackUnderItsName) {
    const auto sections =
        read_track(R"(<trkpt lat="45" lon="4"><time>2026-03-01T00:00:00Z</time></trkpt>)"
                   R"(<trkpt lat="45.001" lon="4"><time>2026-03-01T00:00:05Z</time></trkpt>)");
    ASSERT_THAT(sections, SizeIs(1));
    EXPECT_EQ(sections[0].name, "valley road");
    EXPECT_THAT(sections[0].route, IsEmpty());
    EXPECT_THAT(sections[0].line, SizeIs(2));
}

TEST(SectionFile, RefusesATrackOfWhichOnePlaceCanBeRead) {
    EXPECT_THAT(refusal_of([] {
                    read_track(
                        R"(<trkpt lat="45" lon="4"><time>2026-03-01T00:00:00Z</time></trkpt>)"
                        R"(<trkpt lat="9e9" lon="4"><time>2026-03-01T00:00:05Z</time></trkpt>)");
                }),
                EndsWith("valley road.gpx: the track has 1 place with a time that can be read, "
                         "expected at least 2"));
}

TEST(SectionFile, WithALineThatJumpsFarIsRefusedRatherThanReadInPart) {
    const auto file = written(
        test_folder(),
        "a.geojson",
        R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":)"
        R"({"type":"LineString","coordinates":[[4,45],[4.001,45]]}},{"type":"Feature",)"
        R"("properties":{},"geometry":{"type":"LineString","coordinates":[[4,45],[5,45]]}}]})");
    EXPECT_THAT(refusal_of([&] { read_sections(file); }),
                EndsWith("a.geojson: skipped: 1 way with points more than 50 km apart; sections "
                         "are read completely or not at all: add points to it, or remove it"));
}
