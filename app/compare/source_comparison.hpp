#pragma once

#include "app/cli/console.hpp"
#include "render/report/comparison/comparison_page.hpp"
#include "storage/store/records/segment_filter.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace macadam {

enum class SourceKind { database, survey, profile };

/// Tells what a file is: a database by .gpkg, a profile by .erd, .pro or .txt, and a .csv by its
/// header: a survey has a column of places.
///
/// \throws InputError  if it is none of them, or cannot be read.
SourceKind kind_of_source(const std::filesystem::path& file);

/// A source of the command line.
struct SourceOption {
    std::filesystem::path file;
    SourceKind kind;
    std::optional<std::string> car; ///< only this car of a database
};

/// The command line of `compare`.
struct CompareOptions {
    SourceOption a;
    SourceOption b;
    SegmentFilter filter;
    bool speeds_in_mph = false;                 ///< groups of speed by round mph
    std::optional<std::filesystem::path> roads; ///< database on whose roads two surveys are placed
    double mm_per_m_of_one = 1;                 ///< mm/m of an IRI of 1 in a survey
    std::optional<double> step_m;               ///< of the profiles' points
    ProfileComparisonConfig profiles;
};

/// Compares two sources.
///
/// \throws InputError  if they cannot be compared: a profile has no place on a road, two surveys
///                     need a network, segments of two databases differ in length.
SourceComparison compare_sources(const CompareOptions& options, const Console& console);

} // namespace macadam
