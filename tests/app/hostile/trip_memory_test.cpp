// Memory that hostile logs and archives can take: 200 MB and 64 bytes for each of theirs.

#include "support/files/compressed.hpp"
#include "support/program/piped_program.hpp"
#include "support/program/program.hpp"
#include "support/roads/drive.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;

constexpr double mb = 1 << 20;

/// Rows as text, with the head and the end of a log.
std::string
log_of(const std::string& columns, int rows, const std::function<std::string(int)>& row) {
    auto text = "# macadam-trip 1\n# frame: FLU\n# gravity: included\n" + columns + "\n";
    for (int i = 0; i < rows; ++i) {
        text += row(i) + "\n";
    }
    return text + fmt::format("# end rows: {}\n", rows);
}

const std::string all = "t_s,acc_y_mps2,acc_z_mps2,gyro_z_radps,speed_mps,lat_deg,lon_deg";

std::string row_at(double t_s, double at_s) {
    return fmt::format("{:.3f},0.1,{:.3f},{:.3f},20,{:.7f},11.0000000",
                       t_s,
                       9.81 + std::sin(50 * at_s),
                       0.1 * std::sin(at_s),
                       48 + at_s * 20 / 111200);
}

struct Hostile {
    const char* name;
    std::string text;
};

std::vector<Hostile> hostile_logs() {
    constexpr int hundred_hz = 20'000;
    const auto jumping = [](double by_s) {
        return log_of(all, hundred_hz, [=](int i) {
            return row_at(0.01 * i + (i > hundred_hz / 2 ? by_s : 0), 0.01 * i);
        });
    };
    return {
        {"clock jumps forward", jumping(1.7e9)},
        {"clock jumps backward", jumping(-1.7e9)},
        {"a jump at each hundredth row",
         log_of(all, hundred_hz, [](int i) { return row_at(0.01 * i + i / 100 * 4e7, 0.01 * i); })},
        {"tiny gaps",
         log_of(all, hundred_hz, [](int i) { return row_at(0.01 * i + i / 100 * 0.3, 0.01 * i); })},
        {"a row in a century", log_of(all, 1000, [](int i) { return row_at(3.15e9 * i, i); })},
        {"a row an hour", log_of(all, 1000, [](int i) { return row_at(3600 * i, 3600 * i); })},
        {"places jump",
         log_of(all,
                hundred_hz,
                [](int i) {
                    return fmt::format("{:.2f},0.1,9.8,0,{},{},{}",
                                       0.1 * i,
                                       i % 90,
                                       i / 50 % 2 == 0 ? 48 : -48,
                                       i / 50 % 4 < 2 ? 11 : -170);
                })},
        {"gyro alone",
         log_of(all,
                hundred_hz,
                [](int i) {
                    return i % 1000 == 0 ? row_at(0.4 * i, 0.4 * i)
                                         : fmt::format("{:.1f},,,0.1,90,,", 0.4 * i);
                })},
        {"no numbers",
         log_of(all,
                hundred_hz,
                [](int i) {
                    return i % 3 == 0   ? fmt::format("{},nan,nan,nan,nan,nan,nan", i)
                           : i % 3 == 1 ? fmt::format("{},1e300,-1e300,1e300,1e300,1e300,1e300", i)
                                        : std::string{"1e300,inf,,,,,"};
                })},
        {"an ordinary one", jumping(0)},
    };
}

struct Run {
    double peak_mb;
    int exit_status;
};

Run run(const std::vector<std::string>& words) {
    PipedProgram program{words};
    program.end_input();
    while (program.line(std::chrono::seconds{60})) {
    }
    const auto end = program.wait();
    return {end.peak_mb, end.exit_status};
}

class TripMemory : public ::testing::Test {
protected:
    void SetUp() override {
        folder = fresh_folder();
        store = (folder / "roads.gpkg").string();
        const Drive drive{.start = {48, 11}, .course_deg = 0, .length_m = 4000};
        write_file(folder / "road.trip.csv",
                   text_of(drive_over(patched_road([](double) { return false; }, 1),
                                      drive,
                                      *built_in_vehicle("golden-car")),
                           drive));
        ASSERT_EQ(run({"init", store, "--trace", (folder / "road.trip.csv").string()}).exit_status,
                  0);
    }

    fs::path folder;
    std::string store;
};

TEST_F(TripMemory, IsAMultipleOfTheLogWhateverItSays) {
    for (const auto& [name, text] : hostile_logs()) {
        const auto log = (folder / "hostile.trip.csv").string();
        write_file(log, text);
        const double max_mb = 200 + 64 * static_cast<double>(text.size()) / mb;
        for (const std::vector<std::string>& words : {std::vector<std::string>{"trace", log},
                                                      {"match", log, "--network", store},
                                                      {"import", store, log}}) {
            const auto [peak_mb, exit_status] = run(words);
            std::printf("%-30s %-7s %6.1f of %6.1f MB\n", name, words[0].c_str(), peak_mb, max_mb);
            EXPECT_LE(peak_mb, max_mb) << name << ": " << words[0];
            EXPECT_LE(exit_status, 1) << name << ": " << words[0];
        }
    }
}

struct Bomb {
    const char* format;
    const char* name; ///< of what is in the archive
    bool is_packed_twice;
};

/// A hundred megabytes of zeros, of which deflate makes a thousandth. They are gone before a
/// program is started: what its parent holds when it forks counts as its own.
void write_bomb(const fs::path& file, const Bomb& bomb) {
    const std::string zeros(100 << 20, '\0');
    write_file(
        file,
        archive_of(bomb.format, {{bomb.name, bomb.is_packed_twice ? gzipped(zeros) : zeros}}));
}

TEST_F(TripMemory, IsSmallForABomb) {
    constexpr std::array bombs{Bomb{"zip", "a.trip.csv", false},
                               Bomb{"tar.gz", "a.trip.csv", false},
                               Bomb{"tar.gz", "notes.txt", false},
                               Bomb{"zip", "a.trip.csv.gz", true}};
    for (const auto& bomb : bombs) {
        const auto file = folder / (std::string{"bomb."} + bomb.format);
        write_bomb(file, bomb);
        const auto [peak_mb, exit_status] = run({"import", store, file.string()});
        std::printf("%s with %s: %.1f MB\n", bomb.format, bomb.name, peak_mb);
        EXPECT_LT(peak_mb, 128) << bomb.format << " " << bomb.name;
        EXPECT_EQ(exit_status, 1) << bomb.format << " " << bomb.name;
    }
}

} // namespace
} // namespace macadam::testing
