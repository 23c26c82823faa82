#pragma once

#include "app/profile/iri_analysis.hpp"

#include <optional>
#include <string>

namespace macadam {

/// Unit and format of a report of `macadam iri`.
struct IriWords {
    bool in_per_mi = false; ///< otherwise mm/m
    bool json = false;      ///< otherwise CSV
};

/// Formats a report as CSV or JSON.
std::string text_of(const IriReport& report, const IriWords& words);

/// Prints the moving mean, or the sections above a threshold (in the unit of `words`), as they are
/// computed.
void print_moving_iri(const IriQuestion& question,
                      double base_m,
                      std::optional<double> threshold,
                      const IriWords& words);

} // namespace macadam
