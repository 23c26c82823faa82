#include "app/compare/compared_profiles.hpp"

#include "estimator/common/error.hpp"
#include "estimator/iri/iri.hpp"
#include "storage/profiles/profile_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace macadam {
namespace {

/// Tests whether the points are dense enough for IRI; straight lines across a gap would be smooth.
void expect_dense(const MeasuredProfile& profile, const std::filesystem::path& file) {
    constexpr double longest_gap_m = 2 * coarsest_step_m;
    constexpr double rounding = 1 + 1e-9;
    const auto& stations = profile.station_m;
    const double step_m = profile.even_step_m.value_or((stations.back() - stations.front()) /
                                                       static_cast<double>(stations.size() - 1));
    if (step_m > coarsest_step_m * rounding) {
        throw InputError{fmt::format("{}: has a point every {:.6g} m, expected at most {:g} m",
                                     file.string(),
                                     step_m,
                                     coarsest_step_m)};
    }
    for (std::size_t i = 1; i < stations.size(); ++i) {
        if (stations[i] - stations[i - 1] > longest_gap_m * rounding) {
            throw InputError{fmt::format(
                "{}: has no point between stations {:.3f} and {:.3f} m, expected one at "
                "least every {:g} m",
                file.string(),
                stations[i - 1],
                stations[i],
                longest_gap_m)};
        }
    }
}

/// Reads a profile that is dense enough for IRI.
MeasuredProfile read_dense_profile(const std::filesystem::path& file,
                                   std::optional<double> step_m) {
    auto profile = read_profile(file, step_m);
    expect_dense(profile, file);
    return profile;
}

/// Interpolates the tracks of uneven stations to their mean step.
MeasuredProfile at_even_steps(MeasuredProfile profile) {
    if (profile.even_step_m) {
        return profile;
    }
    const auto& stations = profile.station_m;
    const double step_m =
        (stations.back() - stations.front()) / static_cast<double>(stations.size() - 1);
    std::vector<double> even_m(stations.size());
    std::vector<std::vector<double>> elevations(profile.tracks.size());
    std::size_t after = 1;
    for (std::size_t i = 0; i < even_m.size(); ++i) {
        even_m[i] = stations.front() + static_cast<double>(i) * step_m;
        while (after + 1 < stations.size() && stations[after] < even_m[i]) {
            ++after;
        }
        const double part = std::clamp(
            (even_m[i] - stations[after - 1]) / (stations[after] - stations[after - 1]), 0.0, 1.0);
        for (std::size_t track = 0; track < elevations.size(); ++track) {
            const auto& z = profile.tracks[track].elevation_m;
            elevations[track].push_back(z[after - 1] + part * (z[after] - z[after - 1]));
        }
    }
    profile.station_m = std::move(even_m);
    profile.even_step_m = step_m;
    for (std::size_t track = 0; track < elevations.size(); ++track) {
        profile.tracks[track].elevation_m = std::move(elevations[track]);
    }
    return profile;
}

std::vector<std::string> names_of(const MeasuredProfile& profile) {
    std::vector<std::string> names;
    for (const auto& track : profile.tracks) {
        names.push_back(track.name);
    }
    return names;
}

/// Indices of a track in both profiles.
struct TrackPair {
    std::string name;
    std::size_t a;
    std::size_t b;
};

std::vector<TrackPair> common_tracks(const MeasuredProfile& a, const MeasuredProfile& b) {
    std::vector<TrackPair> common;
    const auto a_names = names_of(a), b_names = names_of(b);
    for (std::size_t i = 0; i < a_names.size(); ++i) {
        const auto found = std::ranges::find(b_names, a_names[i]);
        if (found != b_names.end()) {
            common.push_back({a_names[i], i, static_cast<std::size_t>(found - b_names.begin())});
        }
    }
    if (common.empty() && a_names.size() == 1 && b_names.size() == 1) {
        common.push_back({fmt::format("{} and {}", a_names[0], b_names[0]), 0, 0});
    }
    if (common.empty()) {
        throw InputError{fmt::format("the profiles have no track in common ({}; {}), expected "
                                     "tracks of equal names, or one track each",
                                     fmt::join(a_names, ", "),
                                     fmt::join(b_names, ", "))};
    }
    return common;
}

} // namespace

SourceComparison compare_profiles(const std::filesystem::path& a,
                                  const std::filesystem::path& b,
                                  std::optional<double> step_m,
                                  const ProfileComparisonConfig& config) {
    const auto profile_a = at_even_steps(read_dense_profile(a, step_m));
    const auto profile_b = at_even_steps(read_dense_profile(b, step_m));
    SourceComparison comparison;
    comparison.interval_m = config.interval_m;
    const auto track_of = [](const MeasuredProfile& profile, std::size_t track) {
        return TrackProfile{
            profile.tracks[track].elevation_m, profile.station_m.front(), *profile.even_step_m};
    };
    for (const auto& [name, of_a, of_b] : common_tracks(profile_a, profile_b)) {
        auto track = compare_tracks(track_of(profile_a, of_a),
                                    track_of(profile_b, of_b),
                                    static_cast<std::int64_t>(comparison.tracks.size()),
                                    config);
        comparison.pairs.insert(
            comparison.pairs.end(), track.intervals.begin(), track.intervals.end());
        comparison.tracks.push_back({name, std::move(track)});
    }
    comparison.all = agreement_of(comparison.pairs);
    return comparison;
}

} // namespace macadam
