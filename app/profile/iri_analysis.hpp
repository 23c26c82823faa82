#pragma once

#include "app/profile/profile_simulation.hpp"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace macadam {

/// The part that is asked for, in pieces; IRI in mm/m.
struct IriReport {
    IriMethod method;
    std::vector<double> borders_m; ///< pieces + 1
    struct Channel {
        std::string name;
        double whole; ///< over all pieces
        std::vector<double> pieces;
    };
    std::vector<Channel> channels; ///< as many as tracks
    std::optional<Channel> mri;    ///< mean of left and right, where both are there
    std::optional<Channel> hri;    ///< of the mean profile
    std::vector<bool> lead_in;     ///< the start of the car may still show in the piece
};

/// Reads the file twice, point by point: its length does not matter to memory.
///
/// \param length_m  of a piece; nothing: all in one.
/// \throws InputError  if the file cannot be used or holds nothing of the part.
IriReport iri_of_pieces(const IriQuestion& question, std::optional<double> length_m);

/// Mean over a base around one place.
struct MovingIri {
    double at_m;                 ///< the middle of the base
    std::span<const double> iri; ///< of each track, mm/m
    std::optional<double> mri;
    bool lead_in; ///< the base begins where the start of the car may still show
};

/// What a moving report begins with.
struct MovingHead {
    IriMethod method;
    double base_m; ///< at least a step
    std::vector<std::string> tracks;
    bool has_mri;
};

/// The mean over a base that moves along the reported part, in steps of the profile (of a thirtieth
/// of the base on uneven stations). Calls `begin` once and then `take` for every place.
void moving_iri(const IriQuestion& question,
                double base_m,
                const std::function<void(const MovingHead&)>& begin,
                const std::function<void(const MovingIri&)>& take);

} // namespace macadam
