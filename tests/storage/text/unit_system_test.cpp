#include "storage/text/unit_system.hpp"

#include "storage/text/column_meanings.hpp"

#include <gmock/gmock.h>

namespace macadam {
namespace {

struct Row {
    double iri, from_m;
    std::int64_t size_mm;
};

const Columns<Row> columns{
    {"iri", as::iri(3), [](auto& r) { return r.iri; }, {"IRI", " {:>6}", 2}},
    {"", as::numbers_in("mm/m"), [](auto&) { return " 1.50 -  2.68"; }, {"90 %", " {:>13}"}},
    {"from_m", as::metres(2), [](auto& r) { return r.from_m; }, {"from m", " {:>9}", 1}},
    {"size_mm", as::real(0, "mm"), [](auto& r) { return r.size_mm; }, {"mm", " {:>4}"}},
    {"km", as::real(3, "km"), [](auto&) { return 1.609344; }},
    {"parts",
     as::json_only(as::numbers_in("m", as::raw)),
     [](auto&) { return R"([{"way_id":12,"from_m":100.00}])"; }},
    {"passes", as::integer, [](auto&) { return 3; }},
};

TEST(UnitSystem, ConvertsValuesAndSaysTheUnitInTheNameOfTheColumn) {
    const auto us = in_units(columns, UnitSystem::us);
    const Row row{2, 30.48, 254};
    EXPECT_EQ(csv_header(us), "iri_in_per_mi,from_ft,size_in,mi,passes\n");
    EXPECT_EQ(csv_line(us, row), "126.7,100.00,10.00,1.000,3\n"); // 2 mm/m = 126.72 in/mi
    EXPECT_EQ(json_object(us, row).text(),
              R"({"iri_in_per_mi":126.7,"from_ft":100.00,"size_in":10.00,"mi":1.000,)"
              R"("parts":[{"way_id":12,"from_ft":328.08}],"passes":3})");
}

TEST(UnitSystem, ConvertsTablesForPeopleWithTheirHeadings) {
    const auto us = in_units(columns, UnitSystem::us);
    EXPECT_EQ(us[0].shown.heading, "IRI");
    EXPECT_EQ(us[0].shown.decimals, 0);
    EXPECT_EQ(plain_text(us[1].type, us[1].value({})), "   95 -   170"); // classes of 23 CFR 490
    EXPECT_EQ(us[2].shown.heading, "from ft");
    EXPECT_EQ(us[3].shown.heading, "in");
}

TEST(UnitSystem, LeavesSiAsItIs) {
    const auto si = in_units(columns, UnitSystem::si);
    EXPECT_EQ(csv_header(si), csv_header(columns));
    EXPECT_EQ(csv_line(si, Row{2, 3, 4}), csv_line(columns, Row{2, 3, 4}));
}

TEST(UnitSystem, HasWordsForLengthsAndRoughness) {
    EXPECT_EQ(length_words(100, UnitSystem::si), "100 m");
    EXPECT_EQ(length_words(100, UnitSystem::us), "328 ft");
    EXPECT_EQ(iri_words(2.683, UnitSystem::si), "2.68 mm/m");
    EXPECT_EQ(iri_words(2.683, UnitSystem::us), "170 in/mi");
}

TEST(ColumnMeanings, AreTheSameInEveryUnit) {
    EXPECT_FALSE(meaning_of_column("iri").empty());
    EXPECT_EQ(meaning_of_column("iri_in_per_mi"), meaning_of_column("iri"));
    EXPECT_EQ(meaning_of_column("from_ft"), meaning_of_column("from_m"));
    EXPECT_EQ(meaning_of_column("way_from_m"), "begin of each part along its way");
    EXPECT_EQ(meaning_of_column("flux"), "");
}

} // namespace
} // namespace macadam
