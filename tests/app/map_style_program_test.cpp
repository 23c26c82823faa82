// `macadam render --style` and its like as users run them.

#include "support/drive.hpp"
#include "support/program.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

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

    fs::path folder_;
    std::string store_;
};

} // namespace

TEST_F(MapStyleProgram, DrawsByTheFileUnlessAnOptionSaysOtherwise) {
    const auto plain = picture({});
    const auto dark = style("theme = \"dark\"\nunit = \"in/mi\"\n");
    EXPECT_TRUE(picture({"--style", dark}) == picture({"--theme", "dark", "--unit", "in/mi"}));
    EXPECT_TRUE(picture({"--style", dark, "--theme", "light", "--unit", "mm/m"}) == plain);
    EXPECT_TRUE(picture({"--style", style("")}) == plain);
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
    EXPECT_TRUE(picture({"--min-passes", "1"}) == plain);
    const auto grey = picture({"--min-passes", "3"});
    EXPECT_FALSE(grey == plain);
    EXPECT_TRUE(picture({"--style", style("min_passes = 3\n")}) == grey);
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
    EXPECT_THAT(run.err, HasSubstr("mine.toml:2: the key 'colors' is not known, expected theme"));
    EXPECT_FALSE(fs::exists(picture_file()));
    EXPECT_EQ(render({"--style", (folder_ / "none.toml").string()}).exit_status, 1);
}

TEST_F(MapStyleProgram, RefusesNumbersOfPassesThatAreNone) {
    const auto run = render({"--min-passes", "0"});
    EXPECT_EQ(run.exit_status, 2);
    EXPECT_THAT(run.err, HasSubstr("--min-passes is 0, expected 1 to 1000000"));
}

} // namespace macadam::testing
