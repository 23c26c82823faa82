#pragma once

#include "app/profile/iri_analysis.hpp"

#include <optional>
#include <string>

namespace macadam {

/// In which words a report of `macadam iri` is printed.
struct IriWords {
    bool in_per_mi = false; ///< otherwise mm/m
    bool json = false;      ///< otherwise CSV
};

/// CSV or JSON, whole.
std::string text_of(const IriReport& report, const IriWords& words);

/// Prints the moving mean, or where it exceeds a threshold (in the unit of `words`), as it comes.
void print_moving_iri(const IriQuestion& question,
                      double base_m,
                      std::optional<double> threshold,
                      const IriWords& words);

} // namespace macadam
