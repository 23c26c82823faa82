#pragma once

#include "storage/profiles/profile_reader.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace macadam {

inline constexpr double rounding_m = 1e-6; ///< tolerance of stations

/// Request for the IRI of a measured profile.
struct IriQuestion {
    std::filesystem::path profile; ///< file; of a profile in memory its name, for messages
    std::shared_ptr<const MeasuredProfile> measured{}; ///< instead of the file; null: read that
    std::optional<double> step_m;                      ///< of the file, as in open_profile
    std::optional<double> from_m; ///< start of the reported part; the profile before it is lead-in
    std::optional<double> to_m;
    bool envelope = true;
};

/// Method that computed the IRI of a profile.
struct IriMethod {
    std::optional<double> even_step_m; ///< `std::nullopt`: uneven stations, solved exactly
    /// Steps for 250 mm; `std::nullopt`: uneven stations, or no envelope.
    std::optional<std::size_t> envelope_samples;
};

/// Left and right among the tracks.
struct TrackPair {
    std::size_t left;
    std::size_t right;
};

/// Simulated part of a profile, and the reported part within it.
struct Course {
    ProfileExtent extent;
    IriMethod method;
    double start_m; ///< start of the car
    double from_m;  ///< start of the report
    double to_m;
    double covered_to_m; ///< end of the points: up to 250 mm farther

    bool sampled() const { return extent.even_step_m.has_value(); }

    /// Index of the first value of the sampled stroke after a station.
    std::size_t index_at(double station_m) const;

    /// Returns whether the start-up transient may still show at a position.
    bool leads_in(double at_m) const;

    std::optional<TrackPair> pair() const;
};

/// Determines the simulated and the reported part.
/// \throws InputError  if the file cannot be used or does not cover the part.
Course course_of(const IriQuestion& question);

/// Simulates all tracks in parallel, followed by the mean of left and right if both exist, with
/// only a few points in memory. Calls `take` repeatedly with one value per track: the stroke
/// between two points or, on uneven stations, the mean between two of `edges_m`.
void drive_all(const IriQuestion& question,
               const Course& course,
               const std::vector<double>& edges_m,
               const std::function<void(std::span<const double>)>& take);

} // namespace macadam
