#include "fuzz/input_file.hpp"
#include "fuzz/rules.hpp"
#include "fuzz/targets.hpp"

#include "estimator/iri.hpp"
#include "mapping/survey_match.hpp"
#include "storage/profile_reader.hpp"
#include "storage/recipe_file.hpp"
#include "storage/survey_reader.hpp"
#include "storage/truth_file.hpp"
#include "storage/vehicle_file.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <optional>

namespace macadam::fuzz {
namespace {

void expect_sound(const MeasuredProfile& profile) {
    const auto& stations = profile.station_m;
    expect(stations.size() >= 2, "a profile has two stations");
    expect(std::ranges::adjacent_find(stations, std::greater_equal{}) == stations.end(),
           "stations rise");
    expect(!profile.tracks.empty(), "a profile has a track");
    for (const auto& track : profile.tracks) {
        expect(track.elevation_m.size() == stations.size(), "every station has its elevation");
    }
}

void read_profile_file(const std::filesystem::path& file) {
    for (const auto step_m : {std::optional<double>{}, std::optional{0.25}}) {
        may_refuse([&] {
            const auto profile = read_profile(file, step_m);
            expect_sound(profile);
            if (profile.even_step_m && profile.station_m.size() < 10'000) {
                iri_mm_per_m(profile.tracks.front().elevation_m, *profile.even_step_m);
            }
        });
    }
}

void read_as(const char* name, std::string_view input) {
    read_profile_file(input_file(name, input));
}

} // namespace

void profile_csv(std::string_view input) {
    read_as("a.csv", input);
}

void profile_txt(std::string_view input) {
    read_as("a.txt", input);
}

void profile_erd(std::string_view input) {
    constexpr std::array<std::string_view, 2> names{"a.erd", "a.bin"};
    const auto folder = input_folder(names, input);
    if (std::filesystem::exists(folder / names[0])) {
        read_profile_file(folder / names[0]);
    }
}

void profile_pro(std::string_view input) {
    read_as("a.pro", input);
}

void truth_csv(std::string_view input) {
    may_refuse([&] {
        const auto truth = read_truth(input_file("truth.csv", input));
        expect(std::ranges::adjacent_find(truth, std::greater_equal{}, &SegmentTruth::key) ==
                   truth.end(),
               "segments rise");
    });
}

void survey_csv(std::string_view input) {
    may_refuse([&] {
        const auto survey = read_survey(input_file("survey.csv", input));
        expect(survey.size() >= 2, "a survey has two rows");
        std::vector<TripPlaceAt> trip;
        for (const auto& row : survey) {
            trip.push_back({row.at, 20 * static_cast<double>(trip.size())});
        }
        for (const auto& pass : match_survey(survey, trip, {})) {
            expect(pass.row < survey.size(), "a pass is of a row");
            expect(pass.from_m < pass.to_m, "a piece has a length");
        }
    });
}

void recipe_toml(std::string_view input) {
    may_refuse([&] { read_recipe(input_file("a.toml", input)); });
}

void vehicle_toml(std::string_view input) {
    may_refuse([&] {
        const auto vehicle = read_vehicle(input_file("a.toml", input));
        expect(!vehicle.name.empty(), "a vehicle has a name");
        expect(vehicle.gain > 0, "a gain is above 0");
    });
}

} // namespace macadam::fuzz
