#include "app/config/config_help.hpp"
#include "app/config/user_defaults.hpp"
#include "support/program/program.hpp"

#include "estimator/common/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

namespace macadam::testing {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::vector<std::string> words_of(const std::vector<Default>& defaults) {
    std::vector<std::string> words;
    for (const auto& [option, value, source] : defaults) {
        words.push_back(option + " " + value + " from " + source);
    }
    return words;
}

std::vector<std::string> defaults_in(const std::string& config, const Command& command) {
    return words_of(config_defaults(parse_toml(config, "config.toml"), "/home/ada", command));
}

std::string refusal_of(const std::string& config) {
    try {
        defaults_in(config, report_command);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(Preferences, AreNoOptionsThatDeleteSelectOrChangeWhatIsComputed) {
    for (const auto* const key : {"trip",
                                  "vehicle_id",
                                  "take_back",
                                  "trim",
                                  "min_passes",
                                  "grey_below",
                                  "class",
                                  "method",
                                  "channels",
                                  "vehicle",
                                  "output",
                                  "format",
                                  "json"}) {
        EXPECT_FALSE(preferences().contains(key)) << key;
    }
    EXPECT_TRUE(preferences().contains("units"));
    EXPECT_TRUE(preferences().contains("unit")); // its earlier name
    EXPECT_TRUE(preferences().contains("left_hand"));
}

TEST(Preferences, OfUnitsConcernResultsAndNotWhatIsRead) {
    EXPECT_THAT(preferences().find("units")->second.commands, ElementsAre("render", "report"));
}

TEST(ConfigFile, SetsDefaultsForAllCommandsAndForOne) {
    const std::string config = "unit = \"in/mi\"\n[report]\nunit = \"mm/m\"\n[render]\ntheme = "
                               "\"Dark\"\n";
    EXPECT_THAT(defaults_in(config, report_command),
                ElementsAre("--units mm/m from config.toml:3", "--units in/mi from config.toml:1"));
    EXPECT_THAT(defaults_in(config, render_command),
                ElementsAre("--theme dark from config.toml:5", "--units in/mi from config.toml:1"));
}

TEST(ConfigFile, HasFlagsNumbersAndPathsFromItsOwnFolder) {
    EXPECT_THAT(defaults_in("left_hand = true\njobs = 3\nvehicles = \"cars/../mine\"\n"
                            "style = \"/etc/style.toml\"\n",
                            render_command),
                ElementsAre("--jobs 3 from config.toml:2",
                            "--left-hand yes from config.toml:1",
                            "--style /etc/style.toml from config.toml:4",
                            "--vehicles /home/ada/mine from config.toml:3"));
}

TEST(ConfigFile, RefusesUnknownKeysWithTheNearestOne) {
    EXPECT_EQ(refusal_of("jobs = 1\nunitss = \"mm/m\"\n"),
              "config.toml:2: 'unitss' is no option with a default; did you mean units?");
    EXPECT_EQ(refusal_of("[rendr]\ntheme = \"dark\"\n"),
              "config.toml:1: 'rendr' is no option with a default; did you mean render?");
    EXPECT_EQ(refusal_of("[iri]\ntheme = \"dark\"\n"),
              "config.toml:2: 'theme' is no option with a default; see 'macadam help config'");
    EXPECT_EQ(refusal_of("min_passes = 3\n"),
              "config.toml:1: 'min_passes' is no option with a default; see 'macadam help config'");
}

TEST(ConfigFile, RefusesInvalidValuesOfAnyCommand) {
    EXPECT_THAT(refusal_of("theme = \"blue\"\n"),
                HasSubstr("config.toml:1: 'theme' is 'blue', expected light or dark or print"));
    EXPECT_THAT(refusal_of("left_hand = \"yes\"\n"), HasSubstr("config.toml:1: 'left_hand' is"));
    EXPECT_THAT(refusal_of("jobs = 0\n"), HasSubstr("config.toml:1: 'jobs' is"));
    EXPECT_THAT(refusal_of("unit = 3\n"), HasSubstr("config.toml:1: 'unit' is"));
    EXPECT_THAT(refusal_of("iri = 3\n"), HasSubstr("config.toml:1: 'iri' is"));
    EXPECT_THAT(refusal_of("unit =\n"), HasSubstr("config.toml:1: "));
}

/// The user's own file and variables.
class UserDefaults : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fresh_folder();
        setenv("XDG_CONFIG_HOME", folder_.c_str(), 1);
    }
    void TearDown() override {
        setenv("XDG_CONFIG_HOME", "/dev/null", 1);
        for (const auto* const name :
             {"MACADAM_UNIT", "MACADAM_UNITSS", "MACADAM_QUIET", "MACADAM_VERBOSE"}) {
            unsetenv(name);
        }
    }
    void configure(const std::string& config) const {
        std::filesystem::create_directories(folder_ / "macadam");
        write_file(folder_ / "macadam/config.toml", config);
    }
    std::vector<std::string> in_force() const { return words_of(user_defaults(report_command)); }
    std::string refusal() const {
        try {
            in_force();
        } catch (const UsageError& error) {
            return error.what();
        }
        return "";
    }

    std::filesystem::path folder_;
};

TEST_F(UserDefaults, AreNoneWithoutFileAndVariables) {
    EXPECT_THAT(in_force(), IsEmpty());
    EXPECT_THAT(config_help(), HasSubstr("macadam/config.toml (not there)"));
    EXPECT_THAT(config_help(), HasSubstr("built-in defaults only"));
}

TEST_F(UserDefaults, OfVariablesOutrankThoseOfTheFile) {
    configure("unit = \"in/mi\"\n");
    const auto file = (folder_ / "macadam/config.toml").string();
    EXPECT_THAT(in_force(), ElementsAre("--units in/mi from " + file + ":1"));
    setenv("MACADAM_UNIT", "mm/m", 1);
    EXPECT_THAT(in_force(), ElementsAre("--units mm/m from MACADAM_UNIT"));
    EXPECT_THAT(config_help(), HasSubstr("--units mm/m  (MACADAM_UNIT)  in render, report"));
    setenv("MACADAM_UNIT", "", 1);
    EXPECT_THAT(in_force(), ElementsAre("--units in/mi from " + file + ":1"));
}

TEST_F(UserDefaults, OfTheUnitOfResultsAreNotTakenForTheUnitOfAFileThatIsRead) {
    configure("unit = \"in/mi\"\n");
    for (const auto* const command : {&trace_command, &compare_command, &import_command}) {
        EXPECT_THAT(user_defaults(*command), IsEmpty()) << command->name;
    }
}

TEST_F(UserDefaults, OfFlagsCanBeSwitchedOffByAVariable) {
    configure("quiet = true\n");
    EXPECT_THAT(in_force(), Contains(HasSubstr("--quiet yes")));
    setenv("MACADAM_QUIET", "no", 1);
    EXPECT_THAT(in_force(), IsEmpty());
    setenv("MACADAM_QUIET", "perhaps", 1);
    EXPECT_EQ(refusal(), "MACADAM_QUIET is 'perhaps', expected yes or no");
}

TEST_F(UserDefaults, OfQuietAndVerboseExcludeEachOtherByRank) {
    configure("quiet = true\n");
    setenv("MACADAM_VERBOSE", "1", 1);
    EXPECT_THAT(in_force(), ElementsAre("--verbose yes from MACADAM_VERBOSE"));
}

TEST_F(UserDefaults, RefuseMisspelledVariablesAndInvalidValues) {
    setenv("MACADAM_UNITSS", "us", 1);
    EXPECT_EQ(refusal(), "unknown variable MACADAM_UNITSS; did you mean MACADAM_UNITS?");
    unsetenv("MACADAM_UNITSS");
    setenv("MACADAM_UNIT", "furlong", 1);
    EXPECT_EQ(refusal(), "MACADAM_UNIT is 'furlong', expected si or us or mm/m or in/mi");
    EXPECT_THAT(config_help(), HasSubstr("error\n  MACADAM_UNIT is 'furlong'"));
}

TEST_F(UserDefaults, NameTheFileAndLineOfAnError) {
    configure("\nunit = \"furlong\"\n");
    EXPECT_THAT(refusal(), HasSubstr("macadam/config.toml:2: 'unit' is 'furlong'"));
}

TEST_F(UserDefaults, LieInTheHomeFolderWithoutAnAbsoluteXdgFolder) {
    setenv("XDG_CONFIG_HOME", "relative", 1);
    const char* const home = std::getenv("HOME");
    const std::string before = home == nullptr ? "" : home;
    setenv("HOME", "/home/ada", 1);
    EXPECT_EQ(config_file(), "/home/ada/.config/macadam/config.toml");
    unsetenv("HOME");
    EXPECT_EQ(config_file(), std::nullopt);
    EXPECT_THAT(in_force(), IsEmpty());
    setenv("HOME", before.c_str(), 1);
}

} // namespace
} // namespace macadam::testing
