// Tables of known roughness: surveys and control sections.

#include "storage/surveys/control_reader.hpp"
#include "storage/surveys/reference_reader.hpp"

#include "support/files/files.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>

using namespace macadam;
using namespace macadam::testing;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Optional;
using ::testing::SizeIs;

namespace {

ReferenceSurvey read_rows(const std::string& text, double mm_per_m_of_one = 1) {
    return read_reference(written(test_folder(), "survey.csv", text), mm_per_m_of_one);
}

std::string refusal_of_rows(const std::string& text) {
    return refusal_of([&] { read_rows(text); });
}

std::vector<ControlSection> read_sections_in(const std::string& text) {
    return read_control_sections(written(test_folder(), "control.csv", text), small_country());
}

std::string refusal_of_sections(const std::string& rows) {
    return refusal_of(
        [&] { read_sections_in("name,way_id,direction,from_m,to_m,iri,iri_sd,date\n" + rows); });
}

} // namespace

TEST(ReferenceReader, ReadsRowsByWays) {
    const auto survey = read_rows("segment,way_id,direction,from_m,to_m,iri_left,iri_right,mri\n"
                                  "1+0000,1,forward,0,20,1.5,2.5,2\n"
                                  "1-0001,1,backward,20,40,,,3\n"
                                  "-,1,,60,40,,,3\n"
                                  "-,,,60,40,,,3\n");
    EXPECT_EQ(survey.places, ReferenceLocation::on_ways);
    ASSERT_THAT(survey.rows, SizeIs(4));
    EXPECT_EQ(survey.rows[0].way, (WayPart{1, true, 0, 20}));
    EXPECT_THAT(survey.rows[0].values.left_mm_per_m, Optional(1.5));
    EXPECT_EQ(survey.rows[1].way, (WayPart{1, false, 20, 40}));
    EXPECT_EQ(survey.rows[2].way, (WayPart{1, false, 40, 60})); // stations fall
    EXPECT_FALSE(survey.rows[3].placed);
}

TEST(ReferenceReader, ReadsRowsByTheirEnds) {
    const auto survey = read_rows("begin_lat_deg,begin_lon_deg,end_lat_deg,end_lon_deg,iri\n"
                                  "45,4,45.0002,4,2\n");
    EXPECT_EQ(survey.places, ReferenceLocation::ends);
    EXPECT_EQ(survey.rows[0].end, (GeoPoint{45.0002, 4}));
}

TEST(ReferenceReader, ReadsMiddlesWithHeadingsInInchesAMile) {
    const auto survey = read_rows(
        "lat_deg,lon_deg,length_m,heading_deg,mri\n45,4,50,270,63.36\n45,4,50,,63.36\n", 1 / 63.36);
    EXPECT_EQ(survey.places, ReferenceLocation::middles);
    EXPECT_THAT(survey.rows[0].heading_deg, Optional(270.0));
    EXPECT_THAT(survey.rows[0].values.length_m, Optional(50.0));
    EXPECT_NEAR(*survey.rows[0].values.mri_mm_per_m, 1, 1e-12);
    EXPECT_FALSE(survey.rows[1].placed); // no heading where the file has headings
}

TEST(ReferenceReader, RefusesHeadersThatSayTooLittle) {
    EXPECT_THAT(refusal_of_rows("way_id,from_m,mri\n1,0,2\n"),
                EndsWith("survey.csv:1: the header does not locate its rows, expected way_id, "
                         "from_m and to_m; or begin_lat_deg, begin_lon_deg, end_lat_deg and "
                         "end_lon_deg; or lat_deg and lon_deg"));
    EXPECT_THAT(refusal_of_rows("lat_deg,lon_deg,iri_left\n45,4,2\n"),
                EndsWith("survey.csv:1: the header has no IRI of both tracks, expected mri, iri, "
                         "hri, or iri_left and iri_right"));
    EXPECT_THAT(refusal_of_rows("lat_deg,lon_deg,heading_deg,mri\n45,4,90,2\n"),
                EndsWith("survey.csv:1: the header has heading_deg but no length of the rows, "
                         "expected length_m, or from_m and to_m"));
    EXPECT_THAT(refusal_of_rows("lat_deg,lon_deg,mri\n"),
                EndsWith("survey.csv: has no rows, expected at least one"));
}

TEST(ReferenceReader, RefusesCellsWithTheirLine) {
    EXPECT_THAT(refusal_of_rows("way_id,from_m,to_m,direction,mri\n1,0,20,,2\n1,20,40,north,2\n"),
                EndsWith("survey.csv:3: direction is 'north', expected forward, backward or "
                         "empty"));
    EXPECT_THAT(refusal_of_rows("way_id,from_m,to_m,mri\n1,20,20,2\n"),
                EndsWith("survey.csv:2: from_m is '20' and to_m '20', expected stations 0.1 to "
                         "2000 m apart"));
    EXPECT_THAT(refusal_of_rows("way_id,from_m,to_m,mri\n1,0,20,-2\n"),
                EndsWith("survey.csv:2: mri is '-2', expected an IRI, or empty"));
    EXPECT_THAT(refusal_of_rows("begin_lat_deg,begin_lon_deg,end_lat_deg,end_lon_deg,iri\n"
                                "45,4,46,4,2\n"),
                HasSubstr("survey.csv:2: begins and ends 111"));
}

TEST(ControlReader, ReadsSections) {
    const auto sections = read_sections_in("name,way_id,direction,from_m,to_m,iri,iri_sd,date\n"
                                           "\"north, new\",1,backward,160,40,1.5,0.1,2026-03-01\n"
                                           "south,1,forward,0,60,2,,\n");
    ASSERT_THAT(sections, SizeIs(2));
    EXPECT_EQ(sections[0].name, "north, new");
    EXPECT_FALSE(sections[0].forward);
    EXPECT_EQ(sections[0].from_m, 40);
    EXPECT_EQ(sections[0].to_m, 160);
    EXPECT_EQ(sections[0].sd_mm_per_m, 0.1);
    EXPECT_THAT(sections[0].utc_ms, Optional(1772323200000)); // 2026-03-01T00:00:00Z
    EXPECT_NEAR(sections[1].sd_mm_per_m, 0.06, 1e-12);        // 3 %, not told
    EXPECT_EQ(sections[1].utc_ms, std::nullopt);
}

TEST(ControlReader, RefusesWhatIsNoSectionOfTheNetwork) {
    EXPECT_THAT(refusal_of([] { read_sections_in("name,way_id,from_m,to_m,iri\n"); }),
                EndsWith("control.csv:1: the header has no column direction, expected name, "
                         "way_id, direction, from_m, to_m and iri"));
    EXPECT_THAT(refusal_of_sections("a,99,forward,0,60,2,,\n"),
                EndsWith("control.csv:2: the database has no way '99'"));
    EXPECT_THAT(refusal_of_sections("a,1,forward,0,9000,2,,\n"),
                HasSubstr("control.csv:2: extends from 0 to 9000 m, expected a part of the way"));
    EXPECT_THAT(refusal_of_sections("a,2,backward,0,20,2,,\n"),
                EndsWith("control.csv:2: direction is 'backward', which may not be driven there"));
    EXPECT_THAT(refusal_of_sections("a,1,forward,20,20,2,,\n"),
                EndsWith("control.csv:2: begins and ends at the same station, expected a "
                         "length above 0"));
    EXPECT_THAT(refusal_of_sections("a,1,,0,20,2,,\n"),
                EndsWith("control.csv:2: direction is empty, expected a value"));
    EXPECT_THAT(refusal_of_sections("a,1,forward,0,20,2,,soon\n"),
                EndsWith("control.csv:2: date is 'soon', expected a day such as 2026-03-01"));
    EXPECT_THAT(refusal_of_sections("a,1,forward,0,20,2,,\na,1,forward,20,40,2,,\n"),
                EndsWith("control.csv:3: section 'a' occurs twice, expected once"));
}
