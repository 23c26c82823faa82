// `trace --live` between two pipes: what comes out, and when.

#include "support/program/piped_program.hpp"
#include "support/program/program.hpp"
#include "support/roads/drive.hpp"

#include <gmock/gmock.h>

#include <csignal>
#include <deque>
#include <sstream>
#include <string>
#include <vector>

namespace macadam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::StartsWith;

constexpr std::chrono::seconds timeout{60}; // sanitizers, and a machine that is busy
constexpr std::string_view end_mark = "# end rows";

/// A drive of 60 s at 20 m/s.
std::string log_text() {
    const Drive drive{.length_m = 1200, .rate_hz = 50, .gnss_hz = 1};
    const auto vehicle = *built_in_vehicle("golden-car");
    const auto road = patched_road([](double x_m) { return x_m > 600; }, 2);
    return text_of(drive_over(road, drive, vehicle), drive);
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream{text};
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

std::string cell(const std::string& line, int column) {
    std::istringstream stream{line};
    std::string text;
    for (int i = 0; i <= column; ++i) {
        std::getline(stream, text, ',');
    }
    return text;
}

/// The head of a log and its rows before a time.
std::string until(const std::string& text, double end_s) {
    std::string part;
    bool rows = false;
    for (const auto& line : lines_of(text)) {
        if (rows && (line.starts_with(end_mark) || std::stod(cell(line, 0)) >= end_s)) {
            break;
        }
        rows = rows || line.starts_with("t_s");
        part += line + "\n";
    }
    return part;
}

struct Told {
    std::vector<std::string> lines;
    PipedProgram::End end;
};

/// What the program says of a log that is piped into it.
Told piped(const std::string& text, std::vector<std::string> words) {
    words.insert(words.begin(), {"trace", "--live"});
    PipedProgram program{words};
    program.write(text);
    program.end_input();
    std::vector<std::string> lines;
    while (const auto line = program.line(timeout)) {
        lines.push_back(*line);
    }
    return {lines, program.wait()};
}

constexpr int iri_column = 6;
constexpr int validity_column = 15;

} // namespace

TEST(LiveProgram, TellsRowsWhileTheLogIsStillOpen) {
    PipedProgram program{{"trace", "--live", "--method", "kf"}};
    program.write(until(log_text(), 30));
    EXPECT_THAT(program.line(timeout).value_or(""), StartsWith("from_m,to_m,t_s,"));
    // 600 m were driven; what lay 2 s behind the car was left at 560 m.
    for (int row = 0; row < 28; ++row) {
        EXPECT_EQ(cell(program.line(timeout).value_or(""), 1),
                  std::to_string(20 * row + 20) + ".000");
    }
}

TEST(LiveProgram, TellsWhatTraceTells) {
    const auto file = fresh_folder() / "drive.trip.csv";
    write_file(file, log_text());
    const auto whole = lines_of(run_macadam({"trace", file.string(), "--method", "kf"}).out);
    const auto live =
        lines_of(run_macadam({"trace", "--live", file.string(), "--method", "kf"}).out);
    ASSERT_THAT(live, SizeIs(whole.size()));
    EXPECT_EQ(live.front(), whole.front());
    for (std::size_t i = 1; i < whole.size(); ++i) {
        EXPECT_EQ(cell(live[i], 0), cell(whole[i], 0));
        EXPECT_EQ(cell(live[i], validity_column), cell(whole[i], validity_column)) << whole[i];
        // Behind a window the state of the filter is forgotten to within some per cent; the last
        // rows end where either trace ends.
        if (!cell(whole[i], iri_column).empty() && i + 2 < whole.size()) {
            EXPECT_NEAR(std::stod(cell(live[i], iri_column)) /
                            std::stod(cell(whole[i], iri_column)),
                        1,
                        0.05)
                << whole[i];
        }
    }
}

TEST(LiveProgram, SmoothsByDefault) {
    const auto told = piped(until(log_text(), 9), {"-"});
    // A header and 183 m: the receiver's first fix is 0.2 s older than the log.
    ASSERT_THAT(told.lines, SizeIs(10));
    EXPECT_EQ(cell(told.lines[6], validity_column), "ok");
    EXPECT_EQ(told.end.exit_status, 0);
}

TEST(LiveProgram, WritesAnObjectALine) {
    const auto told = piped(until(log_text(), 9), {"--method", "kf", "--json"});
    ASSERT_THAT(told.lines, SizeIs(9));
    EXPECT_THAT(told.lines.front(), StartsWith(R"({"from_m":0.000,"to_m":20.000,)"));
    EXPECT_THAT(told.lines.back(), ::testing::EndsWith("}"));
}

TEST(LiveProgram, SaysThatALogJustEnds) {
    const auto told = piped(until(log_text(), 10), {"--method", "kf"});
    EXPECT_EQ(told.end.exit_status, 0);
    EXPECT_THAT(told.end.err, HasSubstr("the log ends here after"));
    EXPECT_THAT(told.end.err, HasSubstr("without '# end rows: N'"));
}

TEST(LiveProgram, SaysNothingOfALogThatEndsAsItShould) {
    const auto told = piped(log_text(), {"--method", "kf"});
    EXPECT_EQ(told.end.exit_status, 0);
    EXPECT_THAT(told.end.err, ::testing::Not(HasSubstr("ends here")));
}

TEST(LiveProgram, RefusesAWrongNumberOfRows) {
    const auto part = until(log_text(), 10);
    const auto line = std::to_string(lines_of(part).size() + 1);
    const auto told = piped(part + "# end rows: 5\n", {"--method", "kf"});
    EXPECT_EQ(told.end.exit_status, 1);
    EXPECT_THAT(told.end.err,
                HasSubstr("macadam trace: standard input:" + line +
                          ": '# end rows: 5', expected '# end rows: 5"));
}

TEST(LiveProgram, RefusesVibrationThatIsSampledTooSlowly) {
    std::string slow = "# macadam-trip 1\n# vehicle_id: golden-car\nt_s,acc_z_mps2,speed_mps\n";
    for (int i = 0; i < 200; ++i) {
        slow += std::to_string(0.1 * i) + ",9.81,20\n";
    }
    const auto told = piped(slow, {});
    EXPECT_EQ(told.end.exit_status, 1);
    EXPECT_THAT(told.end.err,
                HasSubstr("macadam trace: standard input: acceleration was sampled at 10.0 Hz, "
                          "expected at least 40"));
}

TEST(LiveProgram, NamesARowThatItLeavesOut) {
    const auto part = until(log_text(), 10);
    const auto line = std::to_string(lines_of(part).size() + 1);
    const auto told = piped(part + "garbage\n", {"--method", "kf"});
    EXPECT_EQ(told.end.exit_status, 0);
    EXPECT_THAT(told.end.err,
                HasSubstr("standard input:" + line + ": 'garbage': skipped: wrong_cell_count"));
    EXPECT_THAT(told.end.err, HasSubstr("wrong_cell_count 1"));
}

TEST(LiveProgram, RefusesWhatIsNoLog) {
    const auto told = piped("hello\n", {});
    EXPECT_EQ(told.end.exit_status, 1);
    EXPECT_THAT(told.end.err,
                HasSubstr("macadam trace: standard input:1: 'hello', expected '# macadam-trip 1'"));
}

TEST(LiveProgram, RefusesADriveShorterThanARow) {
    const auto told = piped(until(log_text(), 3), {"--method", "kf", "--length", "100"});
    EXPECT_EQ(told.end.exit_status, 1);
    EXPECT_THAT(told.end.err, HasSubstr("expected at least --length 100 m"));
}

TEST(LiveProgram, EndsWhenNobodyReadsAnyMore) {
    PipedProgram program{{"trace", "--live", "--method", "kf"}};
    program.write(until(log_text(), 5));
    ASSERT_TRUE(program.line(timeout).has_value());
    program.close_output();
    program.write(log_text().substr(until(log_text(), 5).size()));
    program.end_input();
    EXPECT_EQ(program.wait().exit_status, 128 + SIGPIPE);
}

TEST(LiveProgram, EndsWithWordsWhenItIsInterrupted) {
    const auto log = until(log_text(), 40);
    std::deque<PipedProgram> programs; // at once: each waits a while before it ends by itself
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        auto& program =
            programs.emplace_back(std::vector<std::string>{"trace", "--live", "--method", "kf"});
        program.write(log);
        ASSERT_TRUE(program.line(timeout)); // and waits for more
        program.signal(signal);
    }
    for (auto& program : programs) {
        const auto end = program.wait();
        EXPECT_EQ(end.exit_status, 1);
        EXPECT_THAT(end.err, HasSubstr("macadam trace: interrupted"));
    }
}

TEST(LiveProgram, AloneReadsStandardInput) {
    const auto run = run_macadam({"trace"});
    EXPECT_EQ(run.exit_status, 2);
    EXPECT_THAT(run.err, HasSubstr("TRIP is missing"));
}

TEST(LiveProgram, ReadsNoForeignLogs) {
    const auto run = run_macadam({"trace", "--live", "-", "--mapping", "x.toml"});
    EXPECT_EQ(run.exit_status, 2);
    EXPECT_THAT(run.err, HasSubstr("--live and --mapping cannot be combined"));
}

TEST(LiveProgram, IsTaughtByTheHelp) {
    EXPECT_THAT(run_macadam({"trace", "--help"}).out,
                HasSubstr("sensor-program | macadam trace --live -"));
}

} // namespace macadam::testing
