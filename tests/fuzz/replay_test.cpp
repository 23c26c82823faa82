// Every fuzz target over its seeds and over what fuzzing found, in the ordinary tests.

#include "fuzz/targets.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace macadam::fuzz {
namespace {

namespace fs = std::filesystem;

using Target = void (*)(std::string_view);

/// \returns how many inputs the folder has.
int replay(Target target, const fs::path& folder) {
    int count = 0;
    for (const auto& entry : fs::directory_iterator{folder}) {
        std::ifstream in{entry.path(), std::ios::binary};
        const std::string input{std::istreambuf_iterator<char>{in}, {}};
        EXPECT_NO_THROW(target(input)) << entry.path();
        ++count;
    }
    return count;
}

void survives(Target target, const std::string& name) {
    const fs::path here = MACADAM_SOURCE_DIR "/tests/fuzz";
    EXPECT_GT(replay(target, here / "seeds" / name), 0) << "no seeds for " << name;
    if (const auto findings = here / "findings" / name; fs::exists(findings)) {
        EXPECT_GT(replay(target, findings), 0) << "an empty folder";
    }
}

TEST(Fuzz, TripLogSurvivesEverySeedAndFinding) {
    survives(trip_log, "trip_log");
}

TEST(Fuzz, TripCompressedSurvivesEverySeedAndFinding) {
    survives(trip_compressed, "trip_compressed");
}

TEST(Fuzz, TripArchiveSurvivesEverySeedAndFinding) {
    survives(trip_archive, "trip_archive");
}

TEST(Fuzz, TripTraceSurvivesEverySeedAndFinding) {
    survives(trip_trace, "trip_trace");
}

TEST(Fuzz, TripWrittenSurvivesEverySeedAndFinding) {
    survives(trip_written, "trip_written");
}

TEST(Fuzz, PhoneExportSurvivesEverySeedAndFinding) {
    survives(phone_export, "phone_export");
}

TEST(Fuzz, MappedTripSurvivesEverySeedAndFinding) {
    survives(mapped_trip, "mapped_trip");
}

TEST(Fuzz, GpxSurvivesEverySeedAndFinding) {
    survives(gpx, "gpx");
}

TEST(Fuzz, RawlogSurvivesEverySeedAndFinding) {
    survives(rawlog, "rawlog");
}

TEST(Fuzz, VehicleTomlSurvivesEverySeedAndFinding) {
    survives(vehicle_toml, "vehicle_toml");
}

TEST(Fuzz, RecipeTomlSurvivesEverySeedAndFinding) {
    survives(recipe_toml, "recipe_toml");
}

TEST(Fuzz, ProfileCsvSurvivesEverySeedAndFinding) {
    survives(profile_csv, "profile_csv");
}

TEST(Fuzz, ProfileTxtSurvivesEverySeedAndFinding) {
    survives(profile_txt, "profile_txt");
}

TEST(Fuzz, ProfileErdSurvivesEverySeedAndFinding) {
    survives(profile_erd, "profile_erd");
}

TEST(Fuzz, ProfileProSurvivesEverySeedAndFinding) {
    survives(profile_pro, "profile_pro");
}

TEST(Fuzz, TruthCsvSurvivesEverySeedAndFinding) {
    survives(truth_csv, "truth_csv");
}

TEST(Fuzz, SurveyCsvSurvivesEverySeedAndFinding) {
    survives(survey_csv, "survey_csv");
}

TEST(Fuzz, OsmXmlSurvivesEverySeedAndFinding) {
    survives(osm_xml, "osm_xml");
}

TEST(Fuzz, OsmPbfSurvivesEverySeedAndFinding) {
    survives(osm_pbf, "osm_pbf");
}

TEST(Fuzz, LineLayerSurvivesEverySeedAndFinding) {
    survives(line_layer, "line_layer");
}

TEST(Fuzz, NetworkImageSurvivesEverySeedAndFinding) {
    survives(network_image, "network_image");
}

TEST(Fuzz, StoreBytesSurvivesEverySeedAndFinding) {
    survives(store_bytes, "store_bytes");
}

TEST(Fuzz, StoreContentSurvivesEverySeedAndFinding) {
    survives(store_content, "store_content");
}

TEST(Fuzz, GeometryBlobSurvivesEverySeedAndFinding) {
    survives(geometry_blob, "geometry_blob");
}

TEST(Fuzz, SegmentKeySurvivesEverySeedAndFinding) {
    survives(segment_key, "segment_key");
}

TEST(Fuzz, UtcTimeSurvivesEverySeedAndFinding) {
    survives(utc_time, "utc_time");
}

TEST(Fuzz, CommandLineSurvivesEverySeedAndFinding) {
    survives(command_line, "command_line");
}

} // namespace
} // namespace macadam::fuzz
