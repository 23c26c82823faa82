#include "input_file.hpp"
#include "rules.hpp"
#include "targets.hpp"

#include "estimator/iri/iri.hpp"
#include "mapping/surveys/survey_match.hpp"
#include "storage/profiles/profile_reader.hpp"
#include "storage/settings/database_appearance.hpp"
#include "storage/settings/scenario_file.hpp"
#include "storage/settings/style_file.hpp"
#include "storage/settings/vehicle_file.hpp"
#include "storage/surveys/control_reader.hpp"
#include "storage/surveys/exclusion_file.hpp"
#include "storage/surveys/reference_reader.hpp"
#include "storage/surveys/section_file.hpp"
#include "storage/surveys/survey_reader.hpp"
#include "storage/surveys/truth_file.hpp"
#include "support/roads/store_world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
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

/// With its own stations, or as elevations alone.
Answer read_profile_file(const std::filesystem::path& file) {
    auto answer = Answer::refused;
    for (const auto step_m : {std::optional<double>{}, std::optional{0.25}}) {
        const auto read = may_refuse([&] {
            const auto profile = read_profile(file, step_m);
            expect_sound(profile);
            const auto extent = extent_of_profile(file, step_m);
            expect(extent.points == profile.station_m.size(), "a profile has its extent");
            expect(extent.first_m == profile.station_m.front() &&
                       extent.last_m == profile.station_m.back(),
                   "an extent ends where the profile does");
            if (profile.even_step_m && profile.station_m.size() < 10'000) {
                iri_mm_per_m(profile.tracks.front().elevation_m, *profile.even_step_m);
            }
        });
        answer = either(answer, read);
    }
    return answer;
}

/// By what the first byte looks like.
const char* name_for(std::string_view input) {
    return input.starts_with('<') ? "a.gpx" : input.starts_with('{') ? "a.geojson" : "a.csv";
}

Answer read_as(const char* name, std::string_view input) {
    return read_profile_file(input_file(name, input));
}

/// The names decide whether there is a header, and what stands between cells: a table may have the
/// wrong one. It is accepted if it is under its own.
Answer read_table_as(const char* name, const char* wrong_name, std::string_view input) {
    read_as(wrong_name, input);
    return read_as(name, input);
}

/// Printed to the mm/m and mm, they are what the file may hold: nothing unknown, nothing that ends
/// where it begins.
bool can_be_printed(const std::vector<SegmentTruth>& truth) {
    constexpr double min_m = 0.002;
    return std::ranges::all_of(truth, [](const SegmentTruth& segment) {
        return segment.to_m - segment.from_m >= min_m && std::isfinite(segment.iri_left) &&
               std::isfinite(segment.iri_right) && std::isfinite(segment.hri);
    });
}

} // namespace

Answer profile_csv(std::string_view input) {
    return read_table_as("a.csv", "a.txt", input);
}

Answer profile_txt(std::string_view input) {
    return read_table_as("a.txt", "a.csv", input);
}

Answer profile_erd(std::string_view input) {
    constexpr std::array<std::string_view, 2> names{"a.erd", "a.bin"};
    const auto folder = input_folder(names, input);
    return read_profile_file(folder / names[0]);
}

Answer profile_pro(std::string_view input) {
    return read_as("a.pro", input);
}

Answer truth_csv(std::string_view input) {
    return may_refuse([&] {
        const auto truth = read_truth(input_file("truth.csv", input));
        expect(std::ranges::adjacent_find(truth, std::greater_equal{}, &SegmentTruth::key) ==
                   truth.end(),
               "segments rise");
        if (can_be_printed(truth)) {
            const auto rows = truth_rows(truth);
            const auto again =
                read_truth(input_file("again.csv", fmt::format("{}\n{}", truth_header, rows)));
            expect(truth_rows(again) == rows, "what was written once is written so again");
        }
    });
}

Answer survey_csv(std::string_view input) {
    return may_refuse([&] {
        const auto survey = read_survey(input_file("survey.csv", input));
        expect(survey.size() >= 2, "a survey has two rows");
        std::vector<TravelPosition> trip;
        for (const auto& row : survey) {
            trip.push_back({row.at, 20 * static_cast<double>(trip.size())});
        }
        for (const auto& pass : match_survey(survey, trip, {})) {
            expect(pass.row < survey.size(), "a pass is of a row");
            expect(pass.from_m < pass.to_m, "a piece has a length");
        }
    });
}

Answer reference_csv(std::string_view input) {
    return may_refuse([&] {
        const auto survey = read_reference(input_file("reference.csv", input));
        expect(!survey.rows.empty(), "a survey has a row");
        for (const auto& row : survey.rows) {
            const bool has_place = survey.places == ReferenceLocation::on_ways ? row.way.has_value()
                                   : survey.places == ReferenceLocation::ends ? row.begin && row.end
                                                                              : true;
            expect(!row.placed || has_place, "a row that is placed has its place");
        }
    });
}

Answer control_csv(std::string_view input) {
    static const auto roads = testing::small_country();
    return may_refuse([&] {
        const auto sections = read_control_sections(input_file("control.csv", input), roads);
        expect(!sections.empty(), "a table has a section");
        for (const auto& section : sections) {
            expect(section.from_m < section.to_m, "a section has a length");
            expect(section.sd_mm_per_m >= 0, "a spread is no less than 0");
        }
    });
}

Answer section_file(std::string_view input) {
    return may_refuse([&] {
        const auto sections = read_sections(input_file(name_for(input), input));
        expect(!sections.empty(), "a file of sections has one");
        for (const auto& section : sections) {
            expect(section.line.empty() == (!section.route.empty() || section.way_id),
                   "a section has a road or a line");
        }
    });
}

Answer exclusion_file(std::string_view input) {
    return may_refuse([&] {
        for (const auto& exclusion : read_exclusions(input_file(name_for(input), input), 20)) {
            expect(!exclusion.line.empty(), "an exclusion has a place");
            expect(exclusion.radius_m >= 0, "a radius is no less than 0");
        }
    });
}

Answer style_toml(std::string_view input) {
    return may_refuse([&] {
        const auto look = read_style(input_file("a.toml", input));
        if (look.own_table) {
            const auto& classes = look.own_table->table().classes;
            expect(std::ranges::is_sorted(classes, {}, &IriClass::to_mm_per_m), "borders rise");
            expect(classes.size() <= max_own_classes, "there are not too many classes");
        }
    });
}

Answer appearance_toml(std::string_view input) {
    return may_refuse([&] {
        constexpr std::uint32_t white = 0xFFFFFF;
        const auto file = input_file("macadam.toml", input);
        const auto appearance = read_appearance(file);
        expect(appearance.has_value(), "a file that is there is read");
        expect(input.size() <= max_appearance_bytes, "a file that is read is short");
        expect(appearance->colours.ink.value_or(0) <= white, "a colour has three bytes");
    });
}

Answer recipe_toml(std::string_view input) {
    return may_refuse([&] { read_recipe(input_file("a.toml", input)); });
}

Answer vehicle_toml(std::string_view input) {
    return may_refuse([&] {
        const auto vehicle = read_vehicle(input_file("a.toml", input));
        expect(!vehicle.name.empty(), "a vehicle has a name");
        expect(vehicle.gain > 0, "a gain is above 0");
    });
}

} // namespace macadam::fuzz
