// Thirty cars of which nothing is known, and 2 km of reference survey: simulated, imported as the
// average car, calibrated, and compared with the truth.

#include "app/simulate/scored_world.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "support/program/places.hpp"
#include "support/program/program.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;

constexpr int cars = 30;

/// Cars that differ from the average car in mass by up to 25 %, damping 30 %, tyre 20 %, with
/// friction to 50 N.
std::string recipe() {
    Uniform uniform{30};
    std::string text = "[trips]\ncount = 60\nlength_km = [3, 5]\nfrom = \"2025-03-01\"\n"
                       "to = \"2025-08-31\"\nplaces = 30\nreturn_share = 0.3\nstop_share = 0.05\n";
    for (int car = 0; car < cars; ++car) {
        text += fmt::format("[[car]]\nid = \"c{:02}\"\nlike = \"generic\"\n", car);
        text += fmt::format("ms_kg = {:.0f}\n", 1500 * uniform.in(0.75, 1.25));
        text += fmt::format("cs_ns_per_m = {:.0f}\n", 2000 * uniform.in(0.7, 1.3));
        text += fmt::format("kt_n_per_m = {:.0f}\n", 210000 * uniform.in(0.8, 1.2));
        text += fmt::format("friction_n = {:.0f}\n", uniform.in(0, 50));
        text += fmt::format("wheelbase_m = {:.2f}\n", uniform.in(2.5, 2.9));
        text += fmt::format("cg_to_front_m = {:.2f}\n", uniform.in(1.1, 1.35));
        text += fmt::format("imu_height_m = {:.2f}\n", uniform.in(0.3, 0.5));
        text += fmt::format("imu_x_m = {:.2f}\n", uniform.in(-0.3, 0.3));
    }
    return text;
}

std::vector<std::string> lines_of_gzip(const fs::path& file) {
    std::vector<std::string> lines;
    gzFile in = gzopen(file.c_str(), "rb");
    std::array<char, 4096> line{};
    while (in != nullptr && gzgets(in, line.data(), line.size()) != nullptr) {
        lines.emplace_back(line.data());
    }
    gzclose(in);
    return lines;
}

std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells;
    std::stringstream in{line};
    for (std::string cell; std::getline(in, cell, ',');) {
        cells.push_back(cell);
    }
    return cells;
}

/// Writes a log whose vibration is `gain` times as strong; the mean of an axis stays.
void write_amplified(const fs::path& from, const fs::path& to, double gain) {
    const auto lines = lines_of_gzip(from);
    const auto head = std::ranges::find_if(
        lines, [](const std::string& line) { return line.starts_with("t_s"); });
    ASSERT_NE(head, lines.end());
    const auto columns = cells_of(*head);
    std::vector<std::vector<std::string>> rows;
    std::map<std::size_t, std::pair<double, double>> sums; // by column: sum, count
    for (auto line = head + 1; line != lines.end(); ++line) {
        rows.push_back(cells_of(*line));
        for (std::size_t i = 0; i < rows.back().size() && rows.back().size() > 1; ++i) {
            if (columns[i].starts_with("acc_") && !rows.back()[i].empty()) {
                sums[i].first += std::stod(rows.back()[i]);
                sums[i].second += 1;
            }
        }
    }
    ASSERT_EQ(sums.size(), 3U);
    std::ofstream out{to};
    std::for_each(lines.begin(), head + 1, [&](const std::string& line) { out << line; });
    for (auto& cells : rows) {
        for (const auto& [i, sum] : sums) {
            if (i < cells.size() && !cells[i].empty()) {
                const double mean = sum.first / sum.second;
                cells[i] = fmt::format("{:.4f}", mean + gain * (std::stod(cells[i]) - mean));
            }
        }
        std::string line;
        for (const auto& cell : cells) {
            line += (line.empty() ? "" : ",") + cell;
        }
        out << line << (line.ends_with('\n') ? "" : "\n");
    }
}

/// Writes a survey of at least 2 km: ways that several cars drove, one in three.
void write_survey(const fs::path& store, const fs::path& truth, const fs::path& survey) {
    std::map<std::string, bool> driven;
    SegmentFilter filter;
    filter.min_passes = 1;
    StoreReader::open(store).visit(filter, [&](const SegmentRecord& record) {
        driven[name_of(record.segment.key)] = record.state->vehicles >= 4;
    });
    std::ifstream in{truth};
    std::ofstream out{survey};
    out << "way_id,direction,from_m,to_m,mri\n";
    std::string line, lane;
    std::getline(in, line);
    double surveyed_m = 0;
    for (int lanes = 0; std::getline(in, line) && surveyed_m < 2000;) {
        const auto cells = cells_of(line); // segment, way, direction, from, to, left, right, mri
        if (!driven[cells[0]]) {
            continue;
        }
        if (lane != cells[1] + cells[2]) {
            lane = cells[1] + cells[2];
            ++lanes;
        }
        if (lanes % 3 == 0) {
            out << fmt::format(
                "{},{},{},{},{}\n", cells[1], cells[2], cells[3], cells[4], cells[7]);
            surveyed_m += std::stod(cells[4]) - std::stod(cells[3]);
        }
    }
    ASSERT_GE(surveyed_m, 2000);
}

TEST(UnknownCars, AreRightAfterTwoKilometresOfSurvey) {
    const auto folder = fresh_folder();
    const auto at = [&](const char* name) { return (folder / name).string(); };
    write_file(at("recipe.toml"), recipe());
    const std::string map = source_folder() + "/sample_data/fleet/network.osm.pbf";
    ran({"simulate",
         "-o",
         at("fleet"),
         "--network",
         map,
         "--recipe",
         at("recipe.toml"),
         "--seed",
         "5"});
    fs::create_directory(at("trips"));
    Uniform uniform{31};
    std::map<std::string, double> gains;
    for (int car = 0; car < cars; ++car) {
        gains[fmt::format("c{:02}", car)] = uniform.in(0.9, 1.1);
    }
    std::size_t trips = 0;
    for (const auto& entry : fs::directory_iterator{at("fleet/trips")}) {
        const auto name = entry.path().filename().string();
        write_amplified(entry.path(),
                        fs::path{at("trips")} / name.substr(0, name.size() - 3),
                        gains.at(name.substr(0, 3)));
        ++trips;
    }
    ASSERT_EQ(trips, 60U);
    const auto store = at("roads.gpkg"), truth = at("fleet/truth.csv");
    ran({"init", store, "--network", at("fleet/network.osm.pbf")});
    ran({"import", store, at("trips"), "--vehicle", "generic"});
    print("imported", score_of(store, truth));
    ran({"calibrate", store});
    print("calibrated by each other", score_of(store, truth));
    write_survey(store, truth, at("survey.csv"));
    ran({"import",
         store,
         "--reference",
         at("survey.csv"),
         "--date",
         "2025-06-01",
         "--accuracy",
         "2"});
    ran({"calibrate", store});
    const auto last = score_of(store, truth).all;
    print("calibrated with the survey", score_of(store, truth));
    // What the cars misread differs from road to road by 6.5 %, so that 2 km on a few roads know
    // the level to about 2 %: two sds of it.
    EXPECT_NEAR(last.bias, 0, 0.04);
    EXPECT_LE(last.rmse_100m, 0.06); // wanted: 0.05
    EXPECT_GE(last.coverage, 0.85);
    EXPECT_LE(last.coverage, 0.99); // wanted: 0.95
}

} // namespace
} // namespace macadam::testing
