// The PDF of a report, read again by poppler's tools.

#include "render/report/document/pdf.hpp"

#include "estimator/common/error.hpp"
#include "render/scene/scene.hpp"
#include "support/files/sample_photo.hpp"
#include "support/program/places.hpp"
#include "support/program/program.hpp"
#include "support/roads/sample_report.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

namespace macadam {
namespace {

using ::testing::AllOf;
using testing::changed_town;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;
using testing::town;

ReportPicture grey_picture(int width, int height) {
    Image image{width, height, {}};
    image.rgb.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3, 128);
    return {encode_png(image), {}, width, height};
}

/// Photos of a section: a wide one and a tall one.
std::vector<ReportPhoto> photos() {
    const auto folder = testing::fresh_folder();
    const auto grey = [](int, int) { return std::array<std::uint8_t, 3>{128, 128, 128}; };
    std::vector<ReportPhoto> photos;
    for (const auto& [width_px, height_px] : {std::pair{64, 48}, std::pair{20, 160}}) {
        const auto bytes = testing::read_file(
            testing::write_photo(folder / "photo.jpg", width_px, height_px, grey, std::nullopt));
        photos.push_back({.jpeg = {bytes.begin(), bytes.end()},
                          .width_px = width_px,
                          .height_px = height_px,
                          .day = "2026-03-12",
                          .distance_m = 7.6});
    }
    return photos;
}

/// A report with everything in it, and pictures that are some.
Report whole_report() {
    auto report = changed_town();
    report.map = report.change->map = grey_picture(140, 105);
    for (auto* const stretches : {&report.change->worse, &report.change->better}) {
        for (auto& stretch : *stretches) {
            stretch.map = grey_picture(48, 36);
        }
    }
    report.worst.assign(20, report.worst[0]);
    for (auto& stretch : report.worst) {
        stretch.map = grey_picture(48, 36);
    }
    report.worst[0].photos = photos();
    report.vehicles.assign(60, report.vehicles[0]);
    for (std::size_t i = 0; i < report.vehicles.size(); ++i) {
        report.vehicles[i].name = fmt::format("{}", i + 1);
    }
    return report;
}

std::string printed(const std::string& command) {
    std::string text;
    auto* const pipe = popen(command.c_str(), "r");
    EXPECT_NE(pipe, nullptr);
    char part[4096];
    for (std::size_t n = 1; n > 0;) {
        n = fread(part, 1, sizeof part, pipe);
        text.append(part, n);
    }
    EXPECT_EQ(pclose(pipe), 0) << command;
    return text;
}

class ReportPdf : public ::testing::Test {
protected:
    /// What one of poppler's tools says of the report's PDF.
    std::string
    by(const std::string& tool, const Report& report, const PdfConfig& config = {}) const {
        const auto file = testing::fresh_folder() / "report.pdf";
        testing::write_file(file, pdf_of(report_document(report), config));
        const auto out = tool.starts_with("pdftotext") ? " -" : "";
        return printed(fmt::format("{} '{}'{}", tool, file.string(), out));
    }
};

void replace_all(std::string& text, std::string_view what, std::string_view by) {
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at)) {
        text.replace(at, what.size(), by);
    }
}

/// Parted by one blank each, of whatever kind they were. Around dashes and before percents poppler
/// leaves some out.
std::string words_only(std::string text) {
    replace_all(text, "\u202F", " ");
    replace_all(text, "\u00A0", " ");
    std::string words;
    std::istringstream in{text};
    for (std::string word; in >> word;) {
        words += word + ' ';
    }
    replace_all(words, " – ", "–");
    replace_all(words, " %", "%");
    return words;
}

/// Of all tables of a document, in words.
std::vector<std::string> cells_of(const Document& document) {
    std::vector<std::string> cells;
    for (const auto& section : document.sections) {
        for (const auto& block : section.blocks) {
            if (const auto* const table = std::get_if<document::Table>(&block)) {
                for (const auto& row : table->rows) {
                    for (const auto& cell : row) {
                        std::string text;
                        for (const auto& span : cell.text.spans) {
                            text += cell.shares.empty() ? span.text : "";
                        }
                        cells.push_back(words_only(text));
                    }
                }
            }
        }
    }
    return cells;
}

struct Word {
    std::string text;
    double left, top, right, bottom;
};

/// Words with the boxes of their letters, page by page.
std::vector<std::vector<Word>> pages_of(const std::string& boxes) {
    std::vector<std::vector<Word>> pages;
    std::istringstream lines{boxes};
    for (std::string line; std::getline(lines, line);) {
        if (line.find("<page ") != std::string::npos) {
            pages.emplace_back();
        }
        Word word{};
        if (std::sscanf(line.c_str(),
                        " <word xMin=\"%lf\" yMin=\"%lf\" xMax=\"%lf\" yMax=\"%lf\">",
                        &word.left,
                        &word.top,
                        &word.right,
                        &word.bottom) == 4) {
            word.text = line.substr(line.find("\">") + 2);
            pages.back().push_back(word);
        }
    }
    return pages;
}

TEST_F(ReportPdf, SaysWhatEveryTableOfThePageSays) {
    const auto report = whole_report();
    const auto text = words_only(by("pdftotext -layout", report));
    const auto cells = cells_of(report_document(report));
    EXPECT_THAT(cells, SizeIs(::testing::Gt(300U)));
    for (const auto& cell : cells) {
        const bool is_number = !cell.empty() && std::isdigit(static_cast<unsigned char>(cell[0]));
        std::istringstream words{is_number ? "" : cell}; // names may go over several lines
        EXPECT_THAT(text, HasSubstr(is_number ? cell : ""));
        for (std::string word; words >> word;) {
            EXPECT_THAT(text, HasSubstr(word));
        }
    }
}

TEST_F(ReportPdf, CutsNoTextOffAndPutsNoneOnAnother) {
    // Boxes of poppler are as high as the font's own line, which is a little more than ours.
    constexpr double play_pt = 2.5;
    for (const auto& paper : {a4, us_letter}) {
        const auto pages = pages_of(by("pdftotext -bbox", whole_report(), {paper}));
        ASSERT_THAT(pages, Not(IsEmpty()));
        for (const auto& page : pages) {
            for (std::size_t i = 0; i < page.size(); ++i) {
                const auto& a = page[i];
                EXPECT_GE(a.left, 42) << a.text;
                EXPECT_LE(a.right, paper.width_pt - 42) << a.text;
                EXPECT_GE(a.top, 20) << a.text;
                EXPECT_LE(a.bottom, paper.height_pt - 20) << a.text;
                for (std::size_t k = 0; k < i; ++k) {
                    const auto& b = page[k];
                    const bool apart = a.left >= b.right - 0.5 || b.left >= a.right - 0.5 ||
                                       a.top >= b.bottom - play_pt || b.top >= a.bottom - play_pt;
                    EXPECT_TRUE(apart) << a.text << " on " << b.text;
                }
            }
        }
    }
}

TEST_F(ReportPdf, EndsNoLineWithinAUnit) {
    Document document;
    document.language = "en";
    document.title = "Lines of all lengths";
    document::Bullets lines;
    for (std::size_t letters = 1; letters < 120; ++letters) {
        lines.items.emplace_back(std::string(letters, 'i') +
                                 " 170 in/mi or 2.7 mm/m, for instance");
    }
    document.sections.push_back({"Lines", {lines}});
    const auto file = testing::fresh_folder() / "lines.pdf";
    testing::write_file(file, pdf_of(document, {}));
    const auto text = printed(fmt::format("pdftotext -layout '{}' -", file.string()));
    EXPECT_THAT(text, HasSubstr("2.7"));
    EXPECT_THAT(text, Not(HasSubstr("/\n")));
    EXPECT_THAT(text, Not(HasSubstr("170\n")));
}

TEST_F(ReportPdf, EmbedsEveryFont) {
    std::istringstream fonts{by("pdffonts", whole_report())};
    std::string line;
    std::getline(fonts, line);
    const auto at = line.find("emb");
    ASSERT_NE(at, std::string::npos);
    std::getline(fonts, line); // a rule
    int count = 0;
    while (std::getline(fonts, line)) {
        EXPECT_EQ(line.substr(at, 3), "yes") << line;
        ++count;
    }
    EXPECT_GT(count, 0);
}

TEST_F(ReportPdf, GivesTheSameBytesForTheSameReport) {
    const auto document = report_document(whole_report());
    const auto once = pdf_of(document, {});
    EXPECT_THAT(once, StartsWith("%PDF-"));
    EXPECT_TRUE(once == pdf_of(document, {})); // too long to print
}

TEST_F(ReportPdf, HasTheTitleAndTheDayOfTheDataOnPaperOfItsSize) {
    const auto info = by("pdfinfo -isodates", whole_report());
    EXPECT_THAT(info, HasSubstr("Spring survey\n"));
    EXPECT_THAT(info, HasSubstr("2026-04-02T00:00:00"));
    EXPECT_THAT(info, HasSubstr("(A4)"));
    EXPECT_THAT(by("pdfinfo", whole_report(), {us_letter}), HasSubstr("(letter)"));
}

TEST_F(ReportPdf, OfUndatedTripsHasNoDate) {
    auto report = whole_report();
    report.period = {};
    EXPECT_THAT(by("pdfinfo", report), Not(HasSubstr("CreationDate")));
}

TEST_F(ReportPdf, NumbersItsPagesAndRepeatsTitleAndHeads) {
    auto report = whole_report();
    report.sections.assign(100, report.sections[0]); // more than a page of them
    for (auto& section : report.sections) {
        section.name = "section-of-many";
    }
    const auto text = by("pdftotext -layout", report);
    std::istringstream in{text};
    int pages = 0, heads = 0;
    for (std::string page; std::getline(in, page, '\f');) {
        const auto words = words_only(page);
        if (words.empty()) {
            continue;
        }
        ++pages;
        EXPECT_THAT(words, HasSubstr(fmt::format("Page {} of ", pages)));
        EXPECT_EQ(pages > 1,
                  words.find("Spring survey · 2026-03-01 to 2026-04-02") != std::string::npos);
        const bool has_sections = words.find("section-of-many") != std::string::npos;
        heads += has_sections ? 1 : 0;
        EXPECT_EQ(has_sections, words.find("Excluded,") != std::string::npos);
    }
    EXPECT_THAT(text, HasSubstr(fmt::format("Page {0} of {0}", pages)));
    EXPECT_GE(heads, 2);
}

TEST_F(ReportPdf, WritesAnyScript) {
    auto report = whole_report();
    report.title = "Οδός Ермак улица שדרה";
    const auto text = by("pdftotext", report);
    for (const auto* const word : {"Οδός", "Ермак", "улица"}) {
        EXPECT_THAT(text, HasSubstr(word));
    }
}

TEST_F(ReportPdf, SaysArabicInTheOrderOfReading) {
    auto report = whole_report();
    report.title = "Route شارع الملك 12, end";
    const auto* const said =
        "/usr/bin/python3 -c 'import sys, pikepdf\n"
        "pdf = pikepdf.open(sys.argv[1])\n"
        "for thing in pdf.objects:\n"
        "    if isinstance(thing, pikepdf.Dictionary) and \"/ActualText\" in thing:\n"
        "        print(thing.S, thing.ActualText)'";
    EXPECT_EQ(by(said, report), "/H1 Route شارع الملك 12, end\n");
    EXPECT_EQ(by(said, whole_report()), "");
}

TEST_F(ReportPdf, BeginsATextThatBeginsWithAnArabicNameAtTheLeft) {
    auto report = whole_report();
    report.title = "شارع الملك";
    const auto pages = pages_of(by("pdftotext -bbox", report));
    ASSERT_THAT(pages, Not(IsEmpty()));
    const auto title = std::ranges::max_element(
        pages[0], {}, [](const Word& word) { return word.bottom - word.top; });
    ASSERT_NE(title, pages[0].end());
    EXPECT_LT(title->right, a4.width_pt / 2); // of a word or two
}

TEST_F(ReportPdf, GivesHanCharactersTheShapesOfTheLettersBesideThem) {
    const auto fonts = [this](const std::string& title) {
        auto report = whole_report();
        report.title = title;
        return by("pdffonts", report);
    };
    EXPECT_THAT(fonts("门骨直"), AllOf(HasSubstr("CJKsc"), Not(HasSubstr("CJKjp"))));
    EXPECT_THAT(fonts("骨直の"), AllOf(HasSubstr("CJKjp"), Not(HasSubstr("CJKsc"))));
    EXPECT_THAT(fonts("骨直의"), AllOf(HasSubstr("CJKkr"), Not(HasSubstr("CJKjp"))));
    EXPECT_THAT(fonts("شارع الملك"), AllOf(HasSubstr("NotoSansArabic"), Not(HasSubstr("DejaVu"))));
}

TEST_F(ReportPdf, LeadsFromATableToTheMapsOfItsStretches) {
    const auto document = report_document(whole_report());
    const auto pdf = pdf_of(document, {});
    EXPECT_THAT(pdf, HasSubstr("/Outlines"));
    EXPECT_THAT(pdf, HasSubstr("/Subtype /Link"));
    EXPECT_THAT(pdf, HasSubstr("(stretch-20)"));
}

TEST_F(ReportPdf, OfTheGermanReportIsGerman) {
    auto report = whole_report();
    report.wording.language = language("de");
    const auto text = words_only(by("pdftotext -layout", report));
    EXPECT_THAT(text, HasSubstr("Seite 1 von "));
    EXPECT_THAT(text, HasSubstr("2,50 mm/m"));
    EXPECT_THAT(text, Not(HasSubstr("Page")));
}

TEST_F(ReportPdf, OfInchesLeavesNoMillimetre) {
    auto report = whole_report();
    report.wording.unit = IriUnit::in_per_mi;
    EXPECT_THAT(by("pdftotext", report), Not(HasSubstr("mm/m")));
}

TEST_F(ReportPdf, OfNothingMeasuredIsStillAReport) {
    auto report = testing::nothing_measured();
    report.map = grey_picture(140, 105);
    EXPECT_THAT(by("pdftotext", report), HasSubstr("No measurements yet."));
}

TEST_F(ReportPdf, RefusesAPictureThatIsNone) {
    try {
        pdf_of(report_document(town()), {});
        FAIL() << "a picture of three bytes was drawn";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("cannot read a picture of the report"));
    }
}

TEST_F(ReportPdf, IsTaggedForPeopleWhoHearItAndWastesNoPaper) {
    auto report = whole_report();
    report.wording.language = language("hu");
    const auto check = fmt::format("/usr/bin/python3 {}/tests/render/report/document/pdf_access.py",
                                   testing::source_folder());
    EXPECT_EQ(by(check, report), "");
    EXPECT_EQ(by(check, report, {.paper = us_letter}), "");
}

} // namespace
} // namespace macadam
