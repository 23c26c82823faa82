#include "render/report/words/messages.hpp"

#include "render/report/report.hpp"
#include "support/program/html_text.hpp"
#include "support/roads/sample_report.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace macadam {
namespace {

using ::testing::AllOf;
using testing::between;
using testing::changed_town;
using ::testing::Gt;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;
using testing::town;

/// What people read of a page: its text, with what stands in for figures and pictures.
std::string text_of(const std::string& html) {
    auto body = html.substr(html.find("<body"));
    body.resize(std::min(body.find("<script>"), body.size()));
    std::string text;
    for (const auto* const attribute : {" aria-label=\"", " alt=\""}) {
        for (const auto& words : between(body, attribute, "\"")) {
            text += words + '\n';
        }
    }
    bool in_tag = false;
    for (const char c : body) {
        text += in_tag || c == '<' || c == '>' ? "" : std::string{c};
        in_tag = c == '<' || (in_tag && c != '>');
    }
    return testing::with_plain_spaces(std::move(text));
}

TEST(ReportUnit, OfInchesLeavesNoMillimetreAnywhere) {
    auto report = changed_town();
    report.wording.unit = IriUnit::in_per_mi;
    const auto text = text_of(report_html(report));
    for (const auto* const metric : {"mm/m", "m/km", "2.50", "2.68", "4.56"}) {
        EXPECT_THAT(text, Not(HasSubstr(metric)));
    }
    EXPECT_THAT(text, HasSubstr("158 in/mi")); // 2.5 mm/m times 63.36
    EXPECT_THAT(text, HasSubstr("95 – 170"));  // FHWA's own borders
    EXPECT_THAT(text, HasSubstr("IRI 289"));   // 4.56, of a stretch
    EXPECT_THAT(text, HasSubstr("IRI +95"));   // 1.5, of a change
    EXPECT_THAT(text, HasSubstr("IRI of a segment, in/mi"));
}

TEST(ReportUnit, OfMillimetresSaysInchesBesideThem) {
    EXPECT_THAT(text_of(report_html(town())),
                AllOf(HasSubstr("2.50 mm/m"), HasSubstr("158 in/mi")));
}

TEST(ReportChange, SaysHowManyWouldBeCalledByChance) {
    const auto text = text_of(report_html(changed_town()));
    EXPECT_THAT(text, HasSubstr("Change since 2026-03-15"));
    EXPECT_THAT(text, HasSubstr("200 segments. Tested one by one, 23 of them"));
    EXPECT_THAT(text, HasSubstr("about 10 would")); // 5 % of 200
    EXPECT_THAT(text, HasSubstr("at most about 5.0 %"));
    EXPECT_THAT(text, HasSubstr("IRI +1.50 (+1.17 to +1.83), from 2.00 to 3.50 over 140 m"));
    EXPECT_THAT(text, HasSubstr("false discovery rate of 5.0 %"));
}

TEST(ReportChange, IsNoPartOfAReportThatWasNotAskedForIt) {
    EXPECT_THAT(text_of(report_html(town())), Not(HasSubstr("Change")));
}

TEST(Words, RefuseAMissingKeyAndAMissingValue) {
    EXPECT_THROW(say(english(), "no such key"), std::logic_error);
    EXPECT_THROW(say(english(), "cars"), std::logic_error);
    EXPECT_EQ(say(english(), "cars", {{"count", "1"}}, 1), "1 car");
    EXPECT_EQ(say(english(), "cars", {{"count", "2"}}, 2), "2 cars");
}

/// Sentences of the report in the English catalogue between their places, if they are more than a
/// name or a word that the other language has, too.
std::vector<std::string> english_pieces(const Language& other) {
    std::vector<std::string> pieces;
    for (const auto& [key, forms] : english().messages) {
        const auto& translated = *find_message(other, key);
        std::string piece;
        bool in_place = false;
        for (const char c : forms.front() + "{") {
            if (c == '{') {
                const bool alike = translated.find(piece) != std::string::npos;
                if (piece.size() >= 5 && !alike && !key.starts_with("site.")) {
                    pieces.push_back(piece);
                }
                piece.clear();
            }
            in_place = c == '{' || (in_place && c != '}');
            piece += in_place || c == '}' ? "" : std::string{c};
        }
    }
    return pieces;
}

TEST(Words, OfATranslatedReportHoldNoEnglish) {
    for (const auto* const code : {"de", "hu"}) {
        auto report = changed_town();
        report.title = "Bericht";
        report.network_source = "stadt.osm.pbf";
        report.attribution = "© OpenStreetMap";
        report.wording.language = language(code);
        ASSERT_NE(report.wording.language, nullptr);
        const auto text = text_of(report_html(report));
        EXPECT_THAT(english_pieces(*report.wording.language), SizeIs(Gt(100U)));
        for (const auto& piece : english_pieces(*report.wording.language)) {
            EXPECT_THAT(text, Not(HasSubstr(testing::with_plain_spaces(piece)))) << code;
        }
        EXPECT_THAT(text, HasSubstr("2,50 mm/m"));
        EXPECT_THAT(text, Not(HasSubstr("2.50")));
        EXPECT_THAT(report_html(report), HasSubstr(std::string{"<html lang=\""} + code));
    }
}

TEST(Words, OfTheGermanReportHaveItsDates) {
    auto report = changed_town();
    report.wording.language = language("de");
    const auto text = text_of(report_html(report));
    EXPECT_THAT(text, HasSubstr("Gefahren 01.03.2026 bis 02.04.2026."));
    EXPECT_THAT(text, HasSubstr("Änderung seit 15.03.2026"));
}

TEST(Words, OfTheHungarianReportHaveItsDates) {
    auto report = changed_town();
    report.wording.language = language("hu");
    const auto text = text_of(report_html(report));
    EXPECT_THAT(text, HasSubstr("Mérés ideje: 2026. 03. 01. – 2026. 04. 02."));
    EXPECT_THAT(text, HasSubstr("Változás 2026. 03. 15. óta"));
    EXPECT_THAT(text, HasSubstr("5,0%"));
}

} // namespace
} // namespace macadam
