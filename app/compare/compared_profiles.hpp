#pragma once

#include "render/report/comparison/comparison_page.hpp"

#include <filesystem>
#include <optional>

namespace macadam {

/// Compares the tracks that two profile files have in common, or their only tracks. Profiles with
/// uneven stations are first interpolated to their mean step.
///
/// \param step_m  as for read_profile.
/// \returns       a comparison without the names of the sources.
/// \throws InputError  if no track of one is in the other, the points are too far apart for IRI
///                     (0.3 m on average, 0.6 m in one place), or the profiles share no road.
SourceComparison compare_profiles(const std::filesystem::path& a,
                                  const std::filesystem::path& b,
                                  std::optional<double> step_m,
                                  const ProfileComparisonConfig& config);

} // namespace macadam
