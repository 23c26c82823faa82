#include "storage/exports/xlsx_workbook.hpp"

#include "support/files/files.hpp"
#include "support/files/xlsx_reader.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

namespace macadam::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const std::vector<XlsxColumn> columns{{"name", as::text},
                                      {"way_id", as::integer},
                                      {"iri", as::iri(3)},
                                      {"last_seen", as::day},
                                      {"class", as::text}};

std::filesystem::path example(const std::filesystem::path& file) {
    XlsxWorkbook book{file, {.title = "Roads", .comment = "© Mappers", .created_s = 0}};
    book.begin_sheet("segments", columns);
    book.add_row({"=1+1", std::int64_t{123456}, 2.4567, "2026-05-01", "poor"},
                 XlsxWorkbook::Fill{4, 0xd7191c});
    book.add_row({"A < \"B\" & \x01\xff Épée", std::int64_t{1} << 60, Cell{}, Cell{}, Cell{}});
    book.begin_sheet("columns", {{"column", as::text}});
    book.add_row({"iri"});
    book.commit();
    return file;
}

TEST(XlsxWorkbook, HoldsNumbersAndDaysAsSuchAndTextAsText) {
    const auto sheets = read_xlsx(example(test_folder() / "a.xlsx"));
    ASSERT_EQ(sheets.size(), 2U);
    EXPECT_EQ(sheets[0].name, "segments");
    EXPECT_EQ(sheets[1].name, "columns");
    const auto& rows = sheets[0].rows;
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_EQ(rows[0].at("C").text, "iri");
    const auto& first = rows[1];
    EXPECT_EQ(first.at("A").text, "=1+1"); // no formula
    EXPECT_FALSE(first.at("A").is_number);
    EXPECT_EQ(first.at("B").text, "123456");
    EXPECT_TRUE(first.at("B").is_number);
    EXPECT_EQ(first.at("C").text, "2.4567"); // shown as 2.457
    EXPECT_EQ(first.at("D").text, "46143");  // days since 1899-12-30
    EXPECT_TRUE(first.at("D").is_number);
    EXPECT_THAT(sheets[0].xml, Not(HasSubstr("<f>")));
}

TEST(XlsxWorkbook, IsPrintedWithAllColumnsOnAPage) {
    const auto xml = read_xlsx(example(test_folder() / "a.xlsx"))[0].xml;
    EXPECT_THAT(xml, AllOf(HasSubstr("orientation=\"landscape\""), HasSubstr("fitToHeight=\"0\"")));
}

TEST(XlsxWorkbook, LeavesUnknownCellsEmptyAndKeepsWhatNoNumberHolds) {
    const auto rows = read_xlsx(example(test_folder() / "a.xlsx"))[0].rows;
    const auto& second = rows[2];
    EXPECT_EQ(second.at("A").text, "A < \"B\" & \uFFFD\uFFFD Épée");
    EXPECT_EQ(second.at("B").text, "1152921504606846976"); // beyond the 15 digits of Excel
    EXPECT_FALSE(second.at("B").is_number);
    EXPECT_FALSE(second.contains("C"));
    EXPECT_FALSE(second.contains("D"));
}

TEST(XlsxWorkbook, HasAFrozenHeaderAFilterAndFormats) {
    const auto file = example(test_folder() / "a.xlsx");
    const auto sheets = read_xlsx(file);
    EXPECT_THAT(sheets[0].xml,
                AllOf(HasSubstr(R"(ySplit="1")"),
                      HasSubstr(R"(state="frozen")"),
                      HasSubstr(R"(<autoFilter ref="A1:E3"/>)")));
    const auto styles = part_of_xlsx(file, "xl/styles.xml");
    EXPECT_THAT(styles,
                AllOf(HasSubstr(R"(formatCode="0.000")"),
                      HasSubstr(R"(formatCode="yyyy-mm-dd")"),
                      HasSubstr("FFD7191C")));
    EXPECT_NE(sheets[0].rows[1].at("E").style, 0); // the fill
}

TEST(XlsxWorkbook, GivesTheSameBytesAtAnyTime) {
    const auto folder = test_folder();
    const auto bytes = [](const std::filesystem::path& file) {
        std::ifstream in{file, std::ios::binary};
        return std::string{std::istreambuf_iterator<char>{in}, {}};
    };
    EXPECT_TRUE(bytes(example(folder / "a.xlsx")) == bytes(example(folder / "b.xlsx")));
    EXPECT_THAT(part_of_xlsx(folder / "a.xlsx", "docProps/core.xml"),
                HasSubstr("1980-01-01T00:00:00Z"));
}

TEST(XlsxWorkbook, RefusesMoreRowsThanASheetHolds) {
    const auto folder = test_folder();
    const auto refusal = refusal_of([&] {
        XlsxWorkbook book{folder / "a.xlsx", {}};
        book.begin_sheet("numbers", {{"n", as::integer}});
        for (std::int64_t i = 0; i <= static_cast<std::int64_t>(XlsxWorkbook::max_rows); ++i) {
            book.add_row({i});
        }
    });
    EXPECT_THAT(refusal, HasSubstr("a.xlsx: a sheet of Excel holds 1048575 rows"));
    EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(XlsxWorkbook, DoesNotAppearWithoutCommitOrInAMissingFolder) {
    const auto folder = test_folder();
    {
        XlsxWorkbook book{folder / "a.xlsx", {}};
        book.begin_sheet("numbers", {{"n", as::integer}});
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder));
    EXPECT_THAT(refusal_of([&] {
                    XlsxWorkbook{folder / "none" / "a.xlsx", {}};
                }),
                HasSubstr("a.xlsx: cannot be written"));
}

} // namespace
} // namespace macadam::testing
