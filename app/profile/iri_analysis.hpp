#pragma once

#include "app/profile/profile_simulation.hpp"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace macadam {

/// IRI of the requested part of a profile, by interval, in mm/m.
struct IriReport {
    IriMethod method;
    std::vector<double> borders_m; ///< intervals + 1
    struct Channel {
        std::string name;
        double whole; ///< over all intervals
        std::vector<double> pieces;
    };
    std::vector<Channel> channels; ///< one per track
    std::optional<Channel> mri;    ///< mean of left and right, if both exist
    std::optional<Channel> hri;    ///< IRI of the mean profile
    std::vector<bool> lead_in;     ///< start-up transient may still show in the interval
};

/// Computes the IRI by interval. The file is read twice, point by point, so that memory does not
/// depend on its length.
///
/// \param length_m     length of an interval; `std::nullopt`: a single one
/// \throws InputError  if the file cannot be used or does not cover the part.
IriReport iri_of_pieces(const IriQuestion& question, std::optional<double> length_m);

/// Mean over a base length around one position.
struct MovingIri {
    double at_m;                 ///< middle of the base
    std::span<const double> iri; ///< per track, mm/m
    std::optional<double> mri;
    bool lead_in; ///< base begins where the start-up transient may still show
};

/// Header of a moving-mean report.
struct MovingHead {
    IriMethod method;
    double base_m; ///< at least one step
    std::vector<std::string> tracks;
    bool has_mri;
};

/// Computes the mean over a base that moves along the reported part in steps of the profile (a
/// thirtieth of the base on uneven stations). Calls `begin` once, then `take` for every position.
void moving_iri(const IriQuestion& question,
                double base_m,
                const std::function<void(const MovingHead&)>& begin,
                const std::function<void(const MovingIri&)>& take);

} // namespace macadam
