#pragma once

#include "storage/profiles/profile_reader.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace macadam {

inline constexpr double rounding_m = 1e-6; ///< of stations

/// What to ask of a measured profile.
struct IriQuestion {
    std::filesystem::path profile;
    std::optional<double> step_m; ///< as open_profile takes it
    std::optional<double> from_m; ///< of the reported part; what lies before is lead-in
    std::optional<double> to_m;
    bool envelope = true;
};

/// How a profile was solved.
struct IriMethod {
    std::optional<double> even_step_m;           ///< nothing: uneven stations, solved exactly
    std::optional<std::size_t> envelope_samples; ///< steps for 250 mm; nothing: uneven, or none
};

/// Left and right among the tracks.
struct TrackPair {
    std::size_t left;
    std::size_t right;
};

/// The part of a profile that is driven, and the part of that which is reported.
struct Course {
    ProfileExtent extent;
    IriMethod method;
    double start_m; ///< of the car
    double from_m;  ///< of the report
    double to_m;
    double covered_to_m; ///< by points: up to 250 mm farther

    bool sampled() const { return extent.even_step_m.has_value(); }

    /// First value of the sampled stroke that belongs to what lies after a station.
    std::size_t index_at(double station_m) const;

    /// The start of the car may still show there.
    bool leads_in(double at_m) const;

    std::optional<TrackPair> pair() const;
};

/// \throws InputError  if the file cannot be used or holds nothing of the part.
Course course_of(const IriQuestion& question);

/// Sends all tracks over the profile abreast, and behind them the mean of left and right if they
/// are there, in the memory of a few points. Calls `take` with one value of each, again and again:
/// of the stroke between two points, or on uneven stations of the mean between two of `edges_m`.
void drive_all(const IriQuestion& question,
               const Course& course,
               const std::vector<double>& edges_m,
               const std::function<void(std::span<const double>)>& take);

} // namespace macadam
