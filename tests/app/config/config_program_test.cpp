// Defaults of options, verbosity and colour as users see them.

#include "support/program/places.hpp"
#include "support/program/program.hpp"
#include "support/program/shell.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

namespace macadam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::StartsWith;

class ConfigProgram : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fresh_folder();
        std::string profile = "station_m,left_m\n";
        for (int i = 0; i < 400; ++i) {
            profile += fmt::format("{:.2f},{:.4f}\n", 0.25 * i, 0.002 * (i % 3));
        }
        profile_ = (folder_ / "road.csv").string();
        write_file(profile_, profile);
        std::filesystem::create_directories(folder_ / "macadam");
        setenv("XDG_CONFIG_HOME", folder_.c_str(), 1);
    }
    void TearDown() override {
        setenv("XDG_CONFIG_HOME", "/dev/null", 1);
        unsetenv("MACADAM_UNIT");
        unsetenv("CLICOLOR_FORCE");
    }
    void configure(const std::string& config) const {
        write_file(folder_ / "macadam/config.toml", config);
    }
    macadam::testing::Run iri(std::vector<std::string> more = {}) const {
        std::vector<std::string> words{"iri", profile_};
        words.insert(words.end(), more.begin(), more.end());
        return run_macadam(words);
    }

    std::filesystem::path folder_;
    std::string profile_;
};

TEST_F(ConfigProgram, TakesTheCommandLineBeforeVariablesBeforeTheFile) {
    const auto settings = [&](std::vector<std::string> more) {
        std::vector<std::string> words{
            "render", (folder_ / "none.gpkg").string(), "-o", "x.png", "--verbose"};
        words.insert(words.end(), more.begin(), more.end());
        return run_macadam(words).err;
    };
    EXPECT_THAT(settings({}), Not(HasSubstr("--units")));
    configure("unit = \"in/mi\"\n");
    EXPECT_THAT(settings({}), HasSubstr("--units in/mi ("));
    EXPECT_THAT(settings({}), HasSubstr("macadam/config.toml:1)\n"));
    setenv("MACADAM_UNIT", "mm/m", 1);
    EXPECT_THAT(settings({}), HasSubstr("--units mm/m (MACADAM_UNIT)\n"));
    EXPECT_THAT(settings({"--unit", "in/mi"}), HasSubstr("--units in/mi (command line)\n"));
}

TEST_F(ConfigProgram, LeavesRowsForProgramsInTheirUnit) {
    const auto metric = iri().out;
    configure("unit = \"in/mi\"\n");
    EXPECT_EQ(iri().out, metric);
    EXPECT_NE(iri({"--unit", "in/mi"}).out, metric);
}

TEST_F(ConfigProgram, RefusesAMistakeInTheFileWithItsLine) {
    configure("[render]\nunitss = \"in/mi\"\n");
    const auto run = iri();
    EXPECT_EQ(run.exit_status, 2);
    EXPECT_THAT(
        run.err,
        HasSubstr("config.toml:2: 'unitss' is no option with a default; did you mean units?"));
    EXPECT_EQ(run_macadam({"iri", "--help"}).exit_status, 0);
    EXPECT_THAT(run_macadam({"help", "config"}).out, HasSubstr("config.toml:2: 'unitss'"));
}

TEST_F(ConfigProgram, RunsWithoutAnyEnvironment) {
    const auto out =
        output_of(folder_,
                  fmt::format("env -i LSAN_OPTIONS=\"$LSAN_OPTIONS\" '{}' iri '{}' --format csv",
                              program_file(),
                              profile_));
    EXPECT_THAT(out, StartsWith("from_m,"));
    EXPECT_THAT(out, Not(HasSubstr("exit ")));
}

TEST_F(ConfigProgram, TellsSettingsTheirSourcesAndTimesWhenVerbose) {
    const auto run = iri({"--verbose", "--length", "50"});
    EXPECT_EQ(run.exit_status, 0);
    EXPECT_THAT(run.err, HasSubstr(" s] --length 50 (command line)\n"));
    EXPECT_THAT(run.err, HasSubstr(" s] done, with at most "));
    EXPECT_EQ(run.out, iri({"--length", "50"}).out);
    EXPECT_EQ(iri().err, "");
    EXPECT_EQ(iri({"--verbose", "--quiet"}).exit_status, 2);
    EXPECT_THAT(iri({"--verbose", "--quiet"}).err,
                HasSubstr("--quiet and --verbose cannot be combined"));
}

TEST_F(ConfigProgram, ColoursErrorsAndHeadingsOnlyWhereThatIsWanted) {
    EXPECT_THAT(iri({"--nonsense"}).err, StartsWith("macadam iri: unknown option"));
    EXPECT_THAT(run_macadam({"help"}).out, Not(HasSubstr("\033")));
    setenv("CLICOLOR_FORCE", "1", 1);
    EXPECT_THAT(iri({"--nonsense"}).err, StartsWith("\033[31mmacadam iri\033[0m: unknown option"));
    EXPECT_THAT(run_macadam({"iri", "--help"}).out, HasSubstr("\033[1moptions\033[0m\n"));
    EXPECT_THAT(iri({"--format", "csv"}).out, Not(HasSubstr("\033")));
}

} // namespace
} // namespace macadam::testing
