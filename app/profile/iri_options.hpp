#pragma once

#include "app/cli/arguments.hpp"
#include "app/profile/iri_output.hpp"

#include <filesystem>
#include <optional>

namespace macadam {

struct IriOptions {
    IriQuestion question;
    std::optional<double> length_m; ///< `std::nullopt`: one value for the whole
    std::optional<double> base_m;   ///< base of a moving mean instead
    std::optional<double> threshold;
    std::optional<std::filesystem::path> output;
    IriWords words;
};

/// Parses the options of `iri`.
/// \throws UsageError  for invalid values or combinations.
IriOptions parse_iri(const Arguments& arguments);

} // namespace macadam
