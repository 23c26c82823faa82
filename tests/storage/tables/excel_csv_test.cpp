#include "storage/tables/excel_csv.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

namespace macadam {
namespace {

constexpr std::string_view csv = "segment,name,iri,way_from_m,passes\n"
                                 "1+0001,\"Main, \"\"old\"\" street\",2.450,1.00;20.50,3\n"
                                 "1-0001,A;B,-0.125,,0\n";

TEST(ExcelCsv, HasTheSeparatorAndDecimalMarkOfTheCountry) {
    EXPECT_EQ(ExcelCsv{excel_dialect("de_AT.UTF-8")}(csv),
              "\xEF\xBB\xBFsegment;name;iri;way_from_m;passes\n"
              "1+0001;\"Main, \"\"old\"\" street\";2,450;\"1,00;20,50\";3\n"
              "1-0001;\"A;B\";-0,125;;0\n");
    EXPECT_EQ(ExcelCsv{excel_dialect("en_US")}(csv), "\xEF\xBB\xBF" + std::string{csv});
}

TEST(ExcelCsv, DoesNotDependOnThePiecesOfTheText) {
    ExcelCsv whole{excel_dialect("fr")}, pieces{excel_dialect("fr")};
    std::string text;
    for (const char c : csv) {
        text += pieces({&c, 1});
    }
    EXPECT_EQ(text, whole(csv));
}

TEST(ExcelCsv, KnowsCountriesThatDifferFromTheirLanguage) {
    const auto dialect = [](std::string_view locale) {
        const auto [separator, mark] = excel_dialect(locale);
        return std::string{separator, mark};
    };
    EXPECT_EQ(dialect("de_CH"), ";.");
    EXPECT_EQ(dialect("de-CH"), ";.");
    EXPECT_EQ(dialect("es"), ";,");
    EXPECT_EQ(dialect("es_MX.UTF-8"), ",.");
    EXPECT_EQ(dialect("C"), ",.");
    EXPECT_EQ(dialect("C.UTF-8"), ",.");
    EXPECT_EQ(dialect("tr-TR"), ";,");
}

TEST(ExcelCsv, RefusesALanguageThatItDoesNotKnow) {
    EXPECT_THROW(excel_dialect("tlh"), std::invalid_argument);
    EXPECT_THROW(excel_dialect(""), std::invalid_argument);
}

} // namespace
} // namespace macadam
