#include "storage/trips/positions/gpx_reader.hpp"

#include "storage/trips/trip_reader.hpp"
#include "support/files/files.hpp"
#include "support/roads/walked_trips.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <string>

namespace macadam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

const std::string head = "<?xml version=\"1.0\"?>\n<gpx version=\"1.1\" "
                         "xmlns=\"http://www.topografix.com/GPX/1/1\">\n";

std::string point(double lat_deg, double lon_deg, const std::string& inside = "") {
    return "<trkpt lat=\"" + std::to_string(lat_deg) + "\" lon=\"" + std::to_string(lon_deg) +
           "\">" + inside + "</trkpt>\n";
}

std::string at(const std::string& time) {
    return "<time>" + time + "</time>";
}

std::string track(const std::string& points) {
    return "<trk><trkseg>\n" + points + "</trkseg></trk>\n";
}

TripLog read(const std::string& body) {
    return read_trip(
        {.file = written(test_folder(), "tour.gpx", head + body + "</gpx>\n"), .member = {}},
        needs_of_match());
}

std::string refusal(const std::string& content) {
    const auto file = written(test_folder(), "tour.gpx", content);
    return refusal_of([&] { read_trip({.file = file, .member = {}}, needs_of_match()); });
}

TEST(Gpx, GivesPlacesAndTimes) {
    const auto trip = read(track(point(47, 8, at("2020-05-01T10:00:00Z")) +
                                 point(47.001, 8, at("2020-05-01T10:00:05.5Z"))));
    ASSERT_THAT(trip.fixes, SizeIs(2));
    EXPECT_EQ(trip.fixes[1].at, (GeoPoint{47.001, 8}));
    EXPECT_DOUBLE_EQ(trip.fixes[0].t_s, 0);
    EXPECT_DOUBLE_EQ(trip.fixes[1].t_s, 5.5);
    EXPECT_EQ(trip.meta.t0_utc_s, 1588327200); // date -d 2020-05-01T10:00:00Z +%s
    EXPECT_EQ(trip.meta.trip_id, "tour");
    EXPECT_EQ(trip.meta.other.count(times_key), 0U);
}

TEST(Gpx, GivesSpeedCourseAndAccuracyFromExtensionsOrNot) {
    const auto trip = read(
        track(point(47, 8, at("2020-05-01T10:00:00Z") + "<speed>12.5</speed><course>90</course>") +
              point(47,
                    8.001,
                    at("2020-05-01T10:00:05Z") +
                        "<extensions><x:TrackPointExtension><x:speed> 13 </x:speed><x:course>91"
                        "</x:course><x:hr>120</x:hr></x:TrackPointExtension><accuracy>4</accuracy>"
                        "</extensions>")));
    ASSERT_THAT(trip.fixes, SizeIs(2));
    EXPECT_FLOAT_EQ(trip.fixes[0].speed_mps, 12.5F);
    EXPECT_FLOAT_EQ(trip.fixes[1].speed_mps, 13);
    EXPECT_FLOAT_EQ(trip.fixes[1].course_deg, 91);
    EXPECT_FLOAT_EQ(trip.fixes[1].accuracy_m, 4);
    EXPECT_TRUE(std::isnan(trip.fixes[0].accuracy_m));
}

TEST(Gpx, ReadsTimesOfAnyZone) {
    const auto trip = read(track(point(47, 8, at("2020-05-01T12:00:00+02:00")) +
                                 point(47, 8.001, at("2020-05-01T10:00:05")) +
                                 point(47, 8.002, at("2020-05-01T04:30:10-05:30"))));
    ASSERT_THAT(trip.fixes, SizeIs(3));
    EXPECT_DOUBLE_EQ(trip.fixes[1].t_s, 5);
    EXPECT_DOUBLE_EQ(trip.fixes[2].t_s, 10);
}

TEST(Gpx, PutsSegmentsInTheOrderOfTheirTimes) {
    const auto trip = read(track(point(47, 9, at("2020-05-02T10:00:00Z")) +
                                 point(47, 9.001, at("2020-05-02T10:00:05Z"))) +
                           track(point(47, 8, at("2020-05-01T10:00:00Z")) +
                                 point(47, 8.001, at("2020-05-01T10:00:05Z"))));
    ASSERT_THAT(trip.fixes, SizeIs(4));
    EXPECT_EQ(trip.fixes[0].at.lon_deg, 8);
    EXPECT_DOUBLE_EQ(trip.fixes[2].t_s, 86400);
}

TEST(Gpx, MakesUpTimesWhereThereAreNone) {
    const auto trip = read(track(point(47, 8) + point(47.0009, 8)) + // 100.06 m
                           track(point(47.0009, 8.01) + point(47.0009, 8.01)));
    ASSERT_THAT(trip.fixes, SizeIs(3)); // the last says the same once more
    EXPECT_EQ(trip.meta.other.at(times_key), "made up at 10 m/s");
    EXPECT_FALSE(trip.meta.t0_utc_s);
    EXPECT_NEAR(trip.fixes[1].t_s, 10.0, 0.05);
    EXPECT_GT(trip.fixes[2].t_s, trip.fixes[1].t_s + 60);
}

TEST(Gpx, MakesUpTimesThatStandStill) {
    const auto time = at("2015-01-01T11:35:02Z");
    const auto trip =
        read(track(point(47, 8, time) + point(47, 8.001, time) + point(47, 8.002, time)));
    EXPECT_THAT(trip.fixes, SizeIs(3));
    EXPECT_EQ(trip.meta.other.count(times_key), 1U);
}

TEST(Gpx, LeavesAPointWithABadNumberOut) {
    const auto trip = read(track(
        point(47, 8, at("2020-05-01T10:00:00Z")) + "<trkpt lat=\"north\" lon=\"8\"/>" +
        "<trkpt lon=\"8\"><time>2020-05-01T10:00:02Z</time></trkpt>" +
        point(97, 8, at("2020-05-01T10:00:03Z")) + point(47.001, 8, at("2020-05-01T10:00:05Z"))));
    EXPECT_THAT(trip.fixes, SizeIs(2));
    ASSERT_THAT(trip.rows, SizeIs(5));
    EXPECT_EQ(trip.rows[1], code(RowReason::bad_number));
    EXPECT_EQ(trip.rows[2], code(RowReason::out_of_range));
    EXPECT_EQ(trip.rows[3], code(RowReason::out_of_range));
}

TEST(Gpx, DoesNotTakeWayPointsOrRoutesForATrack) {
    const auto trip = read("<wpt lat=\"1\" lon=\"1\"/><rte><rtept lat=\"2\" lon=\"2\"/></rte>" +
                           track(point(47, 8) + point(47, 8.001)));
    EXPECT_THAT(trip.fixes, SizeIs(2));
}

TEST(Gpx, TakesNoTrackFromWithinAPoint) {
    const auto inner = "<trkseg><trkpt lat=\"1\" lon=\"1\"/></trkseg>" + at("2020-05-01T10:00:00Z");
    const auto trip =
        read(track(point(47, 8, inner) + point(47, 8.001, at("2020-05-01T10:00:05Z"))));
    ASSERT_THAT(trip.fixes, SizeIs(2));
    EXPECT_EQ(trip.fixes[0].at.lat_deg, 47);
}

TEST(Gpx, WithoutATrackIsRefusedWithWhatItHolds) {
    EXPECT_THAT(refusal(head + "<wpt lat=\"1\" lon=\"1\"/><rte/>\n</gpx>"),
                HasSubstr("tour.gpx:4: contains 1 route, 1 way point only, expected a track "
                          "(trk) with points (trkpt)"));
    EXPECT_THAT(refusal(head + "<trk><trkseg/><trkseg/></trk></gpx>"),
                HasSubstr("contains 1 track, 2 segments only"));
    EXPECT_THAT(refusal(head + "</gpx>"), HasSubstr("contains nothing"));
}

TEST(Gpx, OfAnotherRootIsRefused) {
    EXPECT_THAT(refusal("<?xml version=\"1.0\"?>\n\n<osm/>"),
                HasSubstr("tour.gpx:3: 'osm' is the root, expected a GPX file"));
}

TEST(Gpx, ThatIsNoXmlIsRefusedAtItsLine) {
    EXPECT_THAT(refusal("t_s,lat_deg\n"), HasSubstr("tour.gpx:1: "));
    EXPECT_THAT(refusal(""), HasSubstr("tour.gpx:1: no element found, expected a GPX file"));
    EXPECT_THAT(refusal(head + "<trk>\n<trkseg>" + point(47, 8)), HasSubstr("tour.gpx:5: "));
}

/// Each entity is ten of the one before it: a few lines that would become a gigabyte.
TEST(Gpx, ThatDeclaresEntitiesIsRefused) {
    std::string bomb = "<?xml version=\"1.0\"?>\n<!DOCTYPE gpx [<!ENTITY a0 \"aaaaaaaaaa\">\n";
    for (int i = 1; i < 10; ++i) {
        bomb += "<!ENTITY a" + std::to_string(i) + " \"";
        for (int k = 0; k < 10; ++k) {
            bomb += "&a" + std::to_string(i - 1) + ";";
        }
        bomb += "\">\n";
    }
    EXPECT_THAT(refusal(bomb + "]><gpx><name>&a9;</name></gpx>"),
                HasSubstr("tour.gpx:2: declares the entity 'a0', expected a file without any"));
}

TEST(Gpx, ThatIsTooDeepIsRefused) {
    std::string deep = "<gpx>";
    for (int i = 0; i < 100000; ++i) {
        deep += "<a>";
    }
    EXPECT_THAT(refusal(deep), HasSubstr("more than 64 elements deep"));
}

TEST(Gpx, KeepsNoLongTexts) {
    const auto trip = read("<metadata><desc>" + std::string(1 << 20, 'x') + "</desc></metadata>" +
                           track(point(47, 8) + point(47, 8.001)));
    EXPECT_THAT(trip.fixes, SizeIs(2));
}

TEST(Gpx, HasNoVibration) {
    const auto file = written(
        test_folder(), "tour.gpx", head + track(point(47, 8) + point(47, 8.001)) + "</gpx>");
    EXPECT_THAT(refusal_of([&] { read_trip({.file = file, .member = {}}, needs_of_trace()); }),
                HasSubstr("tour.gpx: is a GPX track, which has positions only, expected also "
                          "vertical acceleration"));
}

TEST(Gpx, IsFoundInAFolderByThoseWhoNeedPositionsAlone) {
    const auto folder = test_folder();
    written(folder, "a/tour.gpx", "");
    written(folder, "b.trip.csv", "");
    EXPECT_THAT(find_tracks(folder).trips, SizeIs(2));
    EXPECT_THAT(find_trips(folder).trips, SizeIs(1));
}

} // namespace
} // namespace macadam::testing
