// `macadam render --style` and its like as users run them.

#include "support/program/html_text.hpp"
#include "support/program/program.hpp"
#include "support/roads/drive.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

/// A store of a road that one car drove over twice.
class MapStyleProgram : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fresh_folder();
        store_ = (folder_ / "roads.gpkg").string();
        const auto road = patched_road([](double x_m) { return x_m < 300; }, 0.25);
        std::vector<std::string> trips;
        for (const double speed_mps : {15.0, 22.0}) {
            const Drive drive{.length_m = 600,
                              .speed_mps = speed_mps,
                              .trip_id = fmt::format("at-{}", speed_mps)};
            trips.push_back((folder_ / (drive.trip_id + ".trip.csv")).string());
            write_file(trips.back(),
                       text_of(drive_over(road, drive, *built_in_vehicle("golden-car")), drive));
        }
        ASSERT_EQ(run_macadam({"init", store_, "--trace", trips[0]}).exit_status, 0);
        ASSERT_EQ(run_macadam({"import", store_, trips[0], trips[1], "--method", "kf"}).exit_status,
                  0);
    }

    std::string style(const std::string& toml) const {
        const auto file = folder_ / "mine.toml";
        write_file(file, toml);
        return file.string();
    }

    std::string picture_file() const { return (folder_ / "map.png").string(); }

    macadam::testing::Run render(std::vector<std::string> more) const {
        std::vector<std::string> words{"render", store_, "-o", picture_file(), "--size", "512x512"};
        words.insert(words.end(), more.begin(), more.end());
        fs::remove(picture_file());
        return run_macadam(words);
    }

    std::string picture(std::vector<std::string> more) const {
        const auto run = render(std::move(more));
        EXPECT_EQ(run.exit_status, 0) << run.err;
        return read_file(picture_file());
    }

    std::string report(std::vector<std::string> more) const {
        const auto file = (folder_ / "report.html").string();
        std::vector<std::string> words{"report", store_, "-o", file};
        words.insert(words.end(), more.begin(), more.end());
        const auto run = run_macadam(words);
        EXPECT_EQ(run.exit_status, 0) << run.err;
        return read_file(file);
    }

    fs::path folder_;
    std::string store_;
};

/// A picture of a page, in base 64.
std::string picture_in(const std::string& html, const std::string& css_class) {
    const auto image = html.find("<img class=\"" + css_class + "\"");
    const auto begin = html.find("base64,", image);
    return image == std::string::npos ? "" : html.substr(begin, html.find('"', begin) - begin);
}

} // namespace

TEST_F(MapStyleProgram, DrawsByTheFileUnlessAnOptionSaysOtherwise) {
    const auto plain = picture({});
    const auto dark = style("theme = \"dark\"\nunit = \"in/mi\"\n");
    EXPECT_TRUE(picture({"--style", dark}) == picture({"--theme", "dark", "--unit", "in/mi"}));
    EXPECT_TRUE(picture({"--style", dark, "--theme", "light", "--unit", "mm/m"}) == plain);
    EXPECT_TRUE(picture({"--style", style("")}) == plain);
}

TEST_F(MapStyleProgram, DrawsAsTheDatabasesOwnFileSuggestsUnlessTheUserSaysOtherwise) {
    const auto plain = picture({});
    const auto dark = picture({"--theme", "dark"});
    ASSERT_FALSE(dark == plain);
    write_file(folder_ / "macadam.toml", "theme = \"dark\"\nlanguage = \"de\"\n");
    EXPECT_TRUE(picture({}) == dark);
    setenv("MACADAM_THEME", "light", 1);
    EXPECT_TRUE(picture({}) == plain);
    EXPECT_TRUE(picture({"--style", style("theme = \"dark\"\n")}) == dark);
    unsetenv("MACADAM_THEME");
    EXPECT_THAT(report({}), HasSubstr("<html lang=\"de\""));
}

TEST_F(MapStyleProgram, IgnoresAFileBesideTheDatabaseThatIsWrongAndSaysSo) {
    const auto plain = picture({});
    const auto file = folder_ / "macadam.toml";
    write_file(file, "theme = \"dark\"\nmin_passes = 9\n");
    const auto run = render({});
    EXPECT_EQ(run.exit_status, 0);
    EXPECT_THAT(run.err, HasSubstr("macadam.toml:2: unknown key"));
    EXPECT_THAT(run.err, HasSubstr("expected unit, language, theme, colours; the file is ignored"));
    EXPECT_TRUE(read_file(picture_file()) == plain);
    fs::remove(file);
    fs::create_symlink(style("theme = \"dark\"\n"), file);
    EXPECT_THAT(render({}).err, HasSubstr("is a link, which is not followed; the file is ignored"));
    EXPECT_TRUE(read_file(picture_file()) == plain);
}

TEST_F(MapStyleProgram, TakesDefaultsWithoutRefusingThoseThatHaveNoEffect) {
    setenv("MACADAM_PAPER", "letter", 1);
    setenv("MACADAM_THEME", "print", 1);
    setenv("MACADAM_JOBS", "2", 1);
    EXPECT_FALSE(report({}).empty());
    const auto rows = (folder_ / "roads.csv").string();
    const auto run = run_macadam({"export", store_, "-o", rows});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    setenv("MACADAM_JOBS", "many", 1);
    const auto tiles = run_macadam({"export", store_, "-o", (folder_ / "a.mbtiles").string()});
    EXPECT_EQ(tiles.exit_status, 2);
    EXPECT_THAT(tiles.err, HasSubstr("--jobs many comes from MACADAM_JOBS"));
    for (const auto* const name : {"MACADAM_PAPER", "MACADAM_THEME", "MACADAM_JOBS"}) {
        unsetenv(name);
    }
}

TEST_F(MapStyleProgram, KnowsTheShippedTableAsAFileOfItsOwn) {
    const auto own = style("[[class]]\nname = \"very good\"\nup_to = 1.5\n"
                           "[[class]]\nname = \"good\"\nup_to = 2.5\n"
                           "[[class]]\nname = \"fair\"\nup_to = 3.5\n"
                           "[[class]]\nname = \"poor\"\nup_to = 5\n"
                           "[[class]]\nname = \"very poor\"\n");
    EXPECT_TRUE(picture({"--style", own}) == picture({"--classes", "five"}));
}

TEST_F(MapStyleProgram, DrawsRoadsWithFewPassesInGrey) {
    const auto plain = picture({});
    EXPECT_TRUE(picture({"--grey-below", "1"}) == plain);
    const auto grey = picture({"--grey-below", "3"});
    EXPECT_FALSE(grey == plain);
    EXPECT_TRUE(picture({"--style", style("min_passes = 3\n")}) == grey);
}

TEST_F(MapStyleProgram, ReportsWithTheClassesColoursAndWordsOfTheFile) {
    const auto html =
        with_plain_spaces(report({"--style",
                                  style("unit = \"mm/m\"\n"
                                        "[[class]]\nname = \"glatt\"\nup_to = 1.1\n"
                                        "[[class]]\nname = \"eben\"\nup_to = 2.2\n"
                                        "[[class]]\nname = \"rauh\"\nup_to = 5.5\n"
                                        "[[class]]\nname = \"kaputt\"\n"
                                        "[ramp]\ncolours = [\"#2c7bb6\", \"#abd9e9\", \"#fdae61\", "
                                        "\"#d7191c\"]\n"
                                        "[legend]\ntitle = \"Ebenheit\"\nup_to = \"bis {}\"\n"
                                        "above = \"über {}\"\nunmeasured = \"Nie gemessen\"\n")}));
    for (const auto* words : {"Glatt",
                              "Kaputt",
                              "bis 1.10",
                              "bis 70", // in/mi
                              "1.10 – 2.20",
                              "über 5.50",
                              "Ebenheit:",
                              "Rauh or worse",
                              "above 2.20 mm/m",
                              "Nie gemessen",
                              "fill=\"#2c7bb6\"",
                              "fill=\"#abd9e9\"",
                              "fill=\"#d7191c\""}) {
        EXPECT_THAT(html, HasSubstr(words));
    }
    EXPECT_THAT(html, Not(HasSubstr("below 1.50")));
    EXPECT_THAT(html, Not(HasSubstr("No measurement")));
}

TEST_F(MapStyleProgram, ReportsAsOptionsSayWhateverTheFileSays) {
    const auto mine = style("classes = \"five\"\nunit = \"in/mi\"\ntheme = \"dark\"\n");
    const auto plain = report({});
    EXPECT_TRUE(report({"--style", mine, "--classes", "fhwa", "--unit", "mm/m"}) == plain);
    EXPECT_TRUE(report({"--style", mine}) == report({"--classes", "five", "--unit", "in/mi"}));
    EXPECT_FALSE(report({"--style", mine}) == plain);
}

TEST_F(MapStyleProgram, ReportsWithColoursOfAThemeOnPagesOfThatKindAlone) {
    const auto plain = report({});
    const auto on_dark =
        report({"--style", style("theme = \"dark\"\n[colours]\nground = \"#102030\"\n")});
    ASSERT_FALSE(picture_in(plain, "light").empty());
    EXPECT_TRUE(picture_in(on_dark, "light") == picture_in(plain, "light"));
    EXPECT_FALSE(picture_in(on_dark, "dark") == picture_in(plain, "dark"));
    const auto on_light = report({"--style", style("[colours]\nground = \"#f0f0ff\"\n")});
    EXPECT_FALSE(picture_in(on_light, "light") == picture_in(plain, "light"));
    EXPECT_TRUE(picture_in(on_light, "dark") == picture_in(plain, "dark"));
}

TEST_F(MapStyleProgram, ReportsRoadsWithFewPassesInGreyAndSaysSo) {
    const auto plain = report({});
    EXPECT_THAT(plain, Not(HasSubstr("are grey here")));
    EXPECT_TRUE(report({"--grey-below", "1"}) == plain);
    const auto grey = report({"--grey-below", "3"});
    EXPECT_THAT(grey, HasSubstr("Fewer than 3 passes"));
    EXPECT_THAT(grey, HasSubstr("Roads with few passes are grey here; all figures count them."));
    EXPECT_FALSE(picture_in(grey, "light") == picture_in(plain, "light"));
    EXPECT_TRUE(report({"--style", style("min_passes = 3\n")}) == grey);
    EXPECT_THAT(report({"--grey-below", "3", "--language", "de"}),
                HasSubstr("Weniger als 3 Überfahrten"));
}

TEST_F(MapStyleProgram, ReportsNothingByAFileThatIsNoStyle) {
    const auto file = (folder_ / "report.html").string();
    EXPECT_EQ(
        run_macadam({"report", store_, "-o", file, "--style", style("colors = 3\n")}).exit_status,
        1);
    EXPECT_FALSE(fs::exists(file));
    const auto run = run_macadam({"report", store_, "--against-reference", "--grey-below", "3"});
    EXPECT_EQ(run.exit_status, 2);
    EXPECT_THAT(run.err, HasSubstr("--grey-below and --against-reference cannot be combined"));
}

TEST_F(MapStyleProgram, WarnsOfColoursThatSomeEyesConfuse) {
    const auto run =
        render({"--style", style("[ramp]\ncolours = [\"#1a9641\", \"#a6d96a\", \"#fdae61\"]\n")});
    EXPECT_EQ(run.exit_status, 0);
    EXPECT_THAT(run.err,
                HasSubstr("warning: the colours of 'fair' (#a6d96a) and 'poor' (#fdae61) differ by "
                          "2.0 CIEDE2000 with deuteranopia, expected 10 or more"));
    EXPECT_TRUE(fs::exists(picture_file()));
}

TEST_F(MapStyleProgram, RefusesAFileThatIsNoStyle) {
    const auto run = render({"--style", style("theme = \"dark\"\ncolors = 3\n")});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("mine.toml:2: unknown key 'colors', expected theme"));
    EXPECT_FALSE(fs::exists(picture_file()));
    EXPECT_EQ(render({"--style", (folder_ / "none.toml").string()}).exit_status, 1);
}

TEST_F(MapStyleProgram, RefusesNumbersOfPassesThatAreNone) {
    const auto run = render({"--grey-below", "0"});
    EXPECT_EQ(run.exit_status, 2);
    EXPECT_THAT(run.err, HasSubstr("--grey-below is 0, expected 1 to 1000000"));
}

} // namespace macadam::testing
