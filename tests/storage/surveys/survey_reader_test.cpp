#include "storage/surveys/survey_reader.hpp"

#include "support/files/files.hpp"

#include <gmock/gmock.h>

using namespace macadam;
using namespace macadam::testing;
using ::testing::EndsWith;
using ::testing::Optional;
using ::testing::SizeIs;

namespace {

std::vector<SurveyRow> read_rows(const std::string& text, double mm_per_m_of_one = 1) {
    return read_survey(written(test_folder(), "survey.csv", text), mm_per_m_of_one);
}

std::string refusal_of_rows(const std::string& text) {
    return refusal_of([&] { read_rows(text); });
}

const std::string one_row = "48.1,11.1,2\n";

} // namespace

TEST(SurveyReader, ReadsWhatItsColumnsSayInAnyOrder) {
    const auto rows =
        read_rows("\xEF\xBB\xBFroad,mri,lon_deg, lat_deg ,to_m,from_m,iri_left,iri_right,hri\r\n"
                  "\"E4, north\",2.5,11.25,48.5,40,20,2,3,2.25\r\n"
                  "\n"
                  "E4,,11.26,48.6,20,40,,,\n");
    ASSERT_THAT(rows, SizeIs(2));
    EXPECT_EQ(rows[0].line, 2U);
    EXPECT_EQ(rows[0].at, (GeoPoint{48.5, 11.25}));
    EXPECT_THAT(rows[0].length_m, Optional(20.0));
    EXPECT_EQ(rows[0].iri_mm_per_m, std::nullopt);
    EXPECT_THAT(rows[0].left_mm_per_m, Optional(2.0));
    EXPECT_THAT(rows[0].right_mm_per_m, Optional(3.0));
    EXPECT_THAT(rows[0].mri_mm_per_m, Optional(2.5));
    EXPECT_THAT(rows[0].hri_mm_per_m, Optional(2.25));
    EXPECT_EQ(rows[1].line, 4U);
    EXPECT_THAT(rows[1].length_m, Optional(20.0)) << "driven against its stations";
    EXPECT_EQ(rows[1].mri_mm_per_m, std::nullopt);
}

/// 63.36 inches a mile are 1 mm/m.
TEST(SurveyReader, TakesInchesAMile) {
    const auto rows = read_rows("lat_deg,lon_deg,iri\n48,11,126.72\n48.1,11,0\n", 1 / 63.36);
    ASSERT_THAT(rows, SizeIs(2));
    EXPECT_NEAR(*rows[0].iri_mm_per_m, 2, 1e-12);
    EXPECT_EQ(rows[0].length_m, std::nullopt);
}

TEST(SurveyReader, LeavesOutRowsWithoutAPlace) {
    EXPECT_THAT(read_rows("lat_deg,lon_deg,iri\n" + one_row + ",11,2\n48,,3\n" + one_row),
                SizeIs(2));
}

TEST(SurveyReader, RefusesAHeaderThatSaysTooLittle) {
    EXPECT_THAT(refusal_of_rows("lat,lon,iri\n"),
                EndsWith("survey.csv:1: 'lat,lon,iri', expected a header with lat_deg, lon_deg and "
                         "one of iri, mri, hri, iri_left, iri_right"));
    EXPECT_THAT(refusal_of_rows("lat_deg,lon_deg,rut\n"), EndsWith("iri_left, iri_right"));
    EXPECT_THAT(refusal_of_rows(""), EndsWith("iri_left, iri_right"));
    EXPECT_THAT(
        refusal_of_rows("lat_deg,lon_deg,iri,to_m\n"),
        EndsWith("survey.csv:1: the header has only 'to_m', expected both from_m and to_m"));
    EXPECT_THAT(refusal_of_rows("lat_deg,lon_deg,iri,iri\n"),
                EndsWith("survey.csv:1: column 'iri' occurs twice, expected once"));
}

TEST(SurveyReader, RefusesCellsThatAreNotWhatTheirColumnSays) {
    const auto refusal = [](const std::string& row) {
        return refusal_of_rows("lat_deg,lon_deg,iri,from_m,to_m\n" + row + "\n");
    };
    EXPECT_THAT(refusal("91,11,2,0,20"),
                EndsWith("survey.csv:2: lat_deg is '91', expected -90 to 90"));
    EXPECT_THAT(refusal("48,east,2,0,20"),
                EndsWith("survey.csv:2: lon_deg is 'east', expected -180 to 180"));
    EXPECT_THAT(refusal("48,11,-1,0,20"),
                EndsWith("survey.csv:2: iri is '-1', expected an IRI, or empty"));
    EXPECT_THAT(refusal("48,11,nan,0,20"),
                EndsWith("survey.csv:2: iri is 'nan', expected an IRI, or empty"));
    EXPECT_THAT(
        refusal("48,11,2,20,20"),
        EndsWith("survey.csv:2: to_m is '20', expected a station 0.1 to 2000 m from from_m"));
    EXPECT_THAT(refusal("48,11,2,0"),
                EndsWith("survey.csv:2: '48,11,2,0' has 4 cells, expected 5"));
}

TEST(SurveyReader, RefusesWhatIsNoLine) {
    EXPECT_THAT(refusal_of_rows("lat_deg,lon_deg,iri\n" + one_row),
                EndsWith("survey.csv: has one row with a position, expected at least two"));
    EXPECT_THAT(refusal_of_rows("lat_deg,lon_deg,iri\n"),
                EndsWith("survey.csv: has no row with a position, expected at least two"));
}
