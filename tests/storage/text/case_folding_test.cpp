#include "storage/text/case_folding.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace macadam {
namespace {

TEST(FoldCase, MakesOneOfNamesThatDifferInCaseAlone) {
    // Pairs as Unicode's CaseFolding.txt has them, one or more of each alphabet.
    const std::vector<std::pair<std::string, std::string>> pairs{
        {"MAIN STREET", "main street"},
        {"RUE DE L'ÉPÉE", "rue de l'épée"},
        {"HAUPTSTRASSE", "Hauptstraße"},
        {"HAUPTSTRAẞE", "hauptstraße"},
        {"ŁÓDŹ ŻÓŁĆ", "łódź żółć"},
        {"ŐRSÉG ŰR", "őrség űr"},
        {"ŸÑÇÅ", "ÿñçå"},
        {"ΛΕΩΦΌΡΟΣ ΏΧΡΑ", "λεωφόρος ώχρα"},
        {"УЛИЦА ЁЖИКА ЇЖАК", "улица ёжика їжак"},
        {"ՓՈՂՈՑ", "փողոց"},
        {"ĐƯỜNG ƠN", "đường ơn"},
        {"ƏLİ", "əlİ"}};
    for (const auto& [upper, lower] : pairs) {
        EXPECT_EQ(case_folded(upper), case_folded(lower)) << upper;
    }
}

TEST(FoldCase, KeepsAccentsAndSignsApart) {
    EXPECT_NE(case_folded("e"), case_folded("é"));
    EXPECT_NE(case_folded("×"), case_folded("÷")); // they stand among the capital letters
    EXPECT_EQ(case_folded("北京路 12%_\n"), "北京路 12%_\n");
}

TEST(FoldCase, LeavesWhatIsNoUtf8AsItIs) {
    for (const std::string bytes : {"\xff\xfe", "\xc3", "a\x80z", "\xed\xa0\x80", "\xc1\x81"}) {
        EXPECT_EQ(case_folded(bytes), bytes);
    }
}

TEST(FoldCase, ChangesNothingTheSecondTime) {
    std::string letters;
    for (int first = 0xc3; first <= 0xdf; ++first) {
        for (int last = 0x80; last <= 0xbf; ++last) {
            letters += {static_cast<char>(first), static_cast<char>(last)};
        }
    }
    EXPECT_EQ(case_folded(case_folded(letters)), case_folded(letters));
    EXPECT_NE(case_folded(letters), letters);
}

} // namespace
} // namespace macadam
