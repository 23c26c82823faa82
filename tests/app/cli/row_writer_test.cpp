#include "app/cli/row_writer.hpp"

#include <gtest/gtest.h>

namespace macadam {
namespace {

struct Road {
    std::string name;
    std::optional<double> iri;
};

const Columns<Road> columns{
    {"name", as::text, [](auto& road) { return road.name; }, {"road", "{:<6.6}"}},
    {"iri", as::iri(3), [](auto& road) { return road.iri; }, {"IRI", " {:>5}", 1}},
    {"", as::text, [](auto& road) { return road.iri ? "5" : ""; }, {"passes", " {:>6}"}},
};
const std::vector<Road> roads{{"Main\x1b", 2.25}, {"Long Street", {}}};

TEST(RowWriter, LaysOutATableUnderItsHeadings) {
    EXPECT_EQ(rows_text(columns, roads, "table"),
              "road     IRI passes\n"
              "Main\\x   2.2      5\n" // escaped, cut to its column
              "Long S     -\n");       // cells that are empty at the end are left out
}

TEST(RowWriter, WritesCsvAndJson) {
    EXPECT_EQ(rows_text(columns, roads, "csv"), "name,iri\nMain\x1b,2.250\nLong Street,\n");
    EXPECT_EQ(
        rows_text(columns, roads, "json"),
        "[{\"name\":\"Main\\u001b\",\"iri\":2.250},{\"name\":\"Long Street\",\"iri\":null}]\n");
}

TEST(RowWriter, MakesAFeatureOfEachRow) {
    EXPECT_EQ(rows_text(columns, roads, "geojson", [](const Road& road) { return road.name; }),
              "{\"type\":\"FeatureCollection\",\"features\":[Main\x1b,Long Street]}\n");
}

TEST(RowWriter, HandsItsRowsToACaptureOfThisThread) {
    ResultCapture capture{true};
    EXPECT_EQ(rows_text(columns, roads, "csv", [](const Road& road) { return road.name; }), "");
    const auto table = capture.take().table.value();
    ASSERT_EQ(table.columns.size(), 2U); // the columns of files
    EXPECT_EQ(table.columns[0].texts, (std::vector<std::string>{"Main\x1b", "Long Street"}));
    EXPECT_EQ(table.columns[1].type.unit, "mm/m");
    EXPECT_EQ(table.columns[1].reals.front(), 2.25);
    EXPECT_EQ(table.columns[1].is_known, (std::vector<bool>{true, false}));
    EXPECT_EQ(table.features.size(), 2U);
}

TEST(RowWriter, WritesCompleteFilesWithoutRowsButNoHeadings) {
    const auto written = [](const char* format) {
        std::string text;
        RowWriter<Road> writer{format, columns, [&](std::string_view more) { text += more; }};
        writer.finish();
        EXPECT_EQ(writer.count(), 0U);
        return text;
    };
    EXPECT_EQ(written("table"), "");
    EXPECT_EQ(written("csv"), "name,iri\n");
    EXPECT_EQ(written("json"), "[]\n");
    EXPECT_EQ(written("geojson"), "{\"type\":\"FeatureCollection\",\"features\":[]}\n");
}

} // namespace
} // namespace macadam
