#include "storage/profiles/profile_reader.hpp"

#include "estimator/common/error.hpp"
#include "storage/profiles/profile_rows.hpp"
#include "storage/text/text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>

namespace macadam {

namespace {

struct Form {
    std::string_view ending;
    std::unique_ptr<ProfileRows> (*open)(const std::filesystem::path&, std::optional<double>);
};

constexpr std::array forms{Form{".csv", open_csv_profile},
                           Form{".txt", open_txt_profile},
                           Form{".erd", open_erd_profile},
                           Form{".pro", open_pro_profile}};

/// Statistics of the points read so far.
struct Passed {
    std::size_t points = 0;
    double first_m = 0;
    double last_m = 0;
    double shortest_m = std::numeric_limits<double>::infinity(); ///< step
    double longest_m = 0;

    void add(double station_m) {
        if (points++ == 0) {
            first_m = station_m;
        } else {
            shortest_m = std::min(shortest_m, station_m - last_m);
            longest_m = std::max(longest_m, station_m - last_m);
        }
        last_m = station_m;
    }

    std::optional<double> even_step_m() const {
        constexpr double max_deviation = 1e-3; // of the step: rounding of stations to mm
        const double mean_m = (last_m - first_m) / static_cast<double>(points - 1);
        const double deviation_m = std::max(longest_m - mean_m, mean_m - shortest_m);
        return deviation_m <= max_deviation * mean_m ? std::optional{mean_m} : std::nullopt;
    }
};

/// Passes each point to `take`.
template <typename Take>
ProfileExtent read_through(const std::string& name, ProfileRows& rows, Take take) {
    Passed passed;
    for (auto row = rows.next(); !row.empty(); row = rows.next()) {
        const double station_m = row.front();
        if (!std::isfinite(station_m) || (passed.points > 0 && station_m <= passed.last_m)) {
            throw InputError{fmt::format("{}: point {} is at {} m, expected more than {}",
                                         name,
                                         passed.points + 1,
                                         station_m,
                                         passed.last_m)};
        }
        passed.add(station_m);
        take(row);
    }
    if (passed.points < 2) {
        throw InputError{
            fmt::format("{}: has {} rows of numbers, expected at least two", name, passed.points)};
    }
    const auto& head = rows.head();
    return {.tracks = head.tracks,
            .points = passed.points,
            .first_m = passed.first_m,
            .last_m = passed.last_m,
            .even_step_m = head.step_m ? head.step_m : passed.even_step_m()};
}

} // namespace

std::unique_ptr<ProfileRows> open_profile(const std::filesystem::path& file,
                                          std::optional<double> step_m) {
    if (step_m && !(*step_m > 0 && std::isfinite(*step_m))) {
        throw InputError{fmt::format("the step is '{}', expected metres above 0", *step_m)};
    }
    auto ending = file.extension().string();
    std::ranges::transform(
        ending, ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto* const form = std::ranges::find(forms, ending, &Form::ending);
    if (form == forms.end()) {
        throw InputError{
            fmt::format("{}: ends in {}, expected a profile in .csv, .txt, .erd or .pro",
                        file.string(),
                        in_quotes(file.extension().string()))};
    }
    return form->open(file, step_m);
}

MeasuredProfile read_profile(const std::filesystem::path& file, std::optional<double> step_m) {
    const auto rows = open_profile(file, step_m);
    MeasuredProfile profile;
    for (const auto& name : rows->head().tracks) {
        profile.tracks.push_back({name, {}});
    }
    const auto extent = read_through(file.string(), *rows, [&](std::span<const double> row) {
        profile.station_m.push_back(row.front());
        for (std::size_t i = 0; i < profile.tracks.size(); ++i) {
            profile.tracks[i].elevation_m.push_back(row[i + 1]);
        }
    });
    profile.even_step_m = extent.even_step_m;
    return profile;
}

ProfileExtent extent_of_profile(const std::filesystem::path& file, std::optional<double> step_m) {
    const auto rows = open_profile(file, step_m);
    return read_through(file.string(), *rows, [](std::span<const double>) {});
}

ProfileExtent extent_of_profile(const std::string& name, const MeasuredProfile& profile) {
    return read_through(name, *rows_of_profile(profile), [](std::span<const double>) {});
}

} // namespace macadam
