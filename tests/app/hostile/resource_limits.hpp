#pragma once

#include "support/program/places.hpp"
#include "support/program/program.hpp"
#include "support/roads/store_world.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <ostream>
#include <string>
#include <vector>

namespace macadam::testing {

struct CommandCase {
    std::string name;
    std::vector<std::string> words; ///< STORE, OUT/..., TRIP, PROFILE stand for files
};

inline void PrintTo(const CommandCase& command, std::ostream* out) {
    *out << command.name;
}

/// Every command, once or more.
inline std::vector<CommandCase> commands() {
    return {{"init", {"init", "OUT/new.gpkg", "--trace", "TRIP"}},
            {"import", {"import", "STORE", "TRIP"}},
            {"calibrate", {"calibrate", "STORE"}},
            {"reprocess", {"reprocess", "STORE", "TRIP"}},
            {"valid_from", {"valid-from", "STORE", "--since", "2026-01-01", "--way", "1"}},
            {"forget", {"forget", "STORE", "--trip", "trip-1"}},
            {"query", {"query", "STORE", "--worst", "3"}},
            {"export_geojson", {"export", "STORE", "--all", "-o", "OUT/a.geojson"}},
            {"export_gpkg", {"export", "STORE", "--all", "-o", "OUT/a.gpkg"}},
            {"export_shp", {"export", "STORE", "--all", "-o", "OUT/a.shp"}},
            {"export_fgb", {"export", "STORE", "--all", "-o", "OUT/a.fgb"}},
            {"export_kml", {"export", "STORE", "--all", "-o", "OUT/a.kml"}},
            {"export_mbtiles", {"export", "STORE", "-o", "OUT/a.mbtiles"}},
            {"export_pmtiles", {"export", "STORE", "-o", "OUT/a.pmtiles"}},
            {"picture_tiles",
             {"export", "STORE", "-o", "OUT/tiles/", "--tiles", "picture", "--zoom", "12"}},
            {"render_png", {"render", "STORE", "-o", "OUT/a.png", "--size", "400x300"}},
            {"render_tif", {"render", "STORE", "-o", "OUT/a.tif", "--size", "400x300"}},
            {"render_pdf", {"render", "STORE", "-o", "OUT/a.pdf"}},
            {"report_html", {"report", "STORE", "-o", "OUT/a.html"}},
            {"report_pdf", {"report", "STORE", "-o", "OUT/a.pdf"}},
            {"info", {"info", "STORE"}},
            {"iri", {"iri", "PROFILE"}},
            {"trace", {"trace", "TRIP", "--method", "kf"}},
            {"match", {"match", "TRIP", "--network", "STORE", "-o", "OUT/a.csv"}},
            {"convert", {"convert", "TRIP", "-o", "OUT/a.trip.csv.gz"}}};
}

struct Place {
    std::filesystem::path store, out, profile;
};

inline Place new_place() {
    const auto folder = fresh_folder();
    std::filesystem::create_directory(folder / "out");
    auto store = new_store(folder / "roads.gpkg");
    import_trips(store, 3);
    std::string profile = "station_m,left_m\n";
    for (int row = 0; row < 1000; ++row) {
        profile += fmt::format("{:.2f},{:.4f}\n", 0.25 * row, 0.001 * (row % 7));
    }
    write_file(folder / "profile.csv", profile);
    return {folder / "roads.gpkg", folder / "out", folder / "profile.csv"};
}

inline std::vector<std::string> words_of(const CommandCase& command, const Place& place) {
    const std::string sample_data = source_folder() + "/sample_data";
    auto words = command.words;
    for (auto& word : words) {
        if (word == "STORE") {
            word = place.store.string();
        } else if (word == "TRIP") {
            word = sample_data + "/comma2k19/comma2k19_rav4.trip.csv";
        } else if (word == "PROFILE") {
            word = place.profile.string();
        } else if (word.starts_with("OUT/")) {
            word = place.out.string() + word.substr(3);
        }
    }
    return words;
}

/// The command either is done or says what it lacks, with exit status 1 and without an output.
inline void
expect_words_or_success(const Limit& limit, const CommandCase& command, const Place& place) {
    const auto run = run_macadam_limited(words_of(command, place), limit);
    EXPECT_LE(run.exit_status, 1) << run.err;
    if (run.exit_status == 1) {
        EXPECT_THAT(run.err, ::testing::HasSubstr("macadam " + command.words.front() + ": "));
        EXPECT_TRUE(std::filesystem::is_empty(place.out));
    }
    std::filesystem::remove_all(place.out);
    std::filesystem::create_directory(place.out);
}

} // namespace macadam::testing
