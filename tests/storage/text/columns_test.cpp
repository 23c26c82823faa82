#include "storage/text/columns.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace macadam {
namespace {

struct Road {
    std::string name;
    std::optional<double> iri;
    int passes = 0;
    bool open = true;
};

const Columns<Road> columns{
    {"name", as::text, [](auto& road) { return road.name; }},
    {"iri", as::iri(2), [](auto& road) { return road.iri; }},
    {"", as::text, [](auto&) { return "for people only"; }, {"shown", "{}"}},
    {"passes", as::integer, [](auto& road) { return road.passes; }},
    {"open", as::truth, [](auto& road) { return road.open; }},
    {"parts", as::json_only(as::raw), [](auto&) { return "[1,2]"; }},
    {"list", as::csv_only(as::raw), [](auto&) { return "-1;2"; }},
};

TEST(Columns, FeedCsvAndJsonFromOneList) {
    const Road road{.name = "Main \"St\"", .iri = 2.345, .passes = 3};
    EXPECT_EQ(csv_header(columns), "name,iri,passes,open,list\n");
    EXPECT_EQ(csv_line(columns, road), "\"Main \"\"St\"\"\",2.35,3,true,-1;2\n");
    EXPECT_EQ(json_object(columns, road).text(),
              R"({"name":"Main \"St\"","iri":2.35,"passes":3,"open":true,"parts":[1,2]})");
}

TEST(Columns, LeaveUnknownValuesEmptyInCsvAndNullInJson) {
    for (const auto& iri : {std::optional<double>{},
                            std::optional{std::numeric_limits<double>::quiet_NaN()},
                            std::optional{std::numeric_limits<double>::infinity()}}) {
        const Road road{.name = "", .iri = iri};
        EXPECT_EQ(csv_line(columns, road), ",,0,true,-1;2\n");
        EXPECT_EQ(json_object(columns, road).text(),
                  R"({"name":"","iri":null,"passes":0,"open":true,"parts":[1,2]})");
    }
}

TEST(Columns, QuoteTextThatASpreadsheetWouldRunButNoNumber) {
    EXPECT_EQ(csv_cell(as::text, "=1+1"), "\"'=1+1\"");
    EXPECT_EQ(csv_cell(as::real(1), -1.0), "-1.0");
    EXPECT_EQ(csv_cell(as::raw, "-1;-2"), "-1;-2");
}

TEST(Columns, WriteNoMinusBeforeZeroInJson) {
    EXPECT_EQ(json_rows(Columns<double>{{"lag_m", as::metres(2), [](auto& m) { return m; }}},
                        std::vector{-0.001, -0.01}),
              R"([{"lag_m":0.00},{"lag_m":-0.01}])");
}

TEST(Columns, WriteTheShortestFormOfANumberWithoutFixedDecimals) {
    EXPECT_EQ(plain_text(as::shortest, 2.5), "2.5");
    EXPECT_EQ(plain_text(as::shortest, 3.0), "3");
}

TEST(Columns, AreAttributesOfOtherProgramsFilesUnlessOnlyCsvOrATableHasThem) {
    std::vector<std::string_view> names;
    for (const auto& column : attributes_of(columns)) {
        names.push_back(column.name);
    }
    EXPECT_EQ(names, (std::vector<std::string_view>{"name", "iri", "passes", "open", "parts"}));
}

} // namespace
} // namespace macadam
