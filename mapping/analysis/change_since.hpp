#pragma once

#include "mapping/analysis/length_weighted_mean.hpp"
#include "mapping/analysis/worst_sections.hpp"
#include "mapping/fusion/fusion_config.hpp"
#include "mapping/fusion/measured_segment.hpp"
#include "mapping/network/road_network.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace macadam {

struct ChangeSinceConfig {
    double rate = 0.05;           ///< false discovery rate: expected share of false calls
    FusionConfig fusion{};        ///< error model of the segment states
    double min_length_m = 100;    ///< shortest section listed
    double max_unmeasured_m = 30; ///< as in WorstSectionConfig
    double max_other_m = 50;      ///< longest gap of comparable but uncalled road within a section
    double sharpest_turn_deg = 60;
};

/// Increase in roughness, mm/m; negative: smoother.
struct Difference {
    double length_m = 0;
    double mm_per_m = 0;
    double sd = 0;
};

/// Returns the part of a segment's variance that all cars share, mm^2/m^2. Fusion gives n passes by
/// m cars of stated variance s^2 the variance share s^2 + car_share s^2 / m + rest^2 / n, which is
/// solved for s. 0 where it rests on references alone.
double common_variance(const MeasuredSegment& segment, const FusionConfig& config);

/// Computes the change of a segment between two states. The error c common to all cars is present
/// on both sides, since the models of the cars and the method are unchanged, and cancels as far as
/// it is equally large: the variance is s1^2 - c1^2 + s2^2 - c2^2 + (c1 - c2)^2. A car that drove
/// on both sides cancels part of its own error too; this is ignored, so the variance errs on the
/// large side.
///
/// \param before, after  the same segment from different passes
Difference difference_of(const MeasuredSegment& before,
                         const MeasuredSegment& after,
                         const FusionConfig& config);

/// Returns the probability of a difference at least as large, of either sign, if nothing has
/// changed. Assumes normal errors.
double chance_of(const Difference& difference);

/// Decides which of many tests to call so that the expected share of false calls is at most `rate`.
///
/// \param chances  p-values in any order. \returns  one decision per p-value.
///
/// Source: Y. Benjamini and Y. Hochberg, "Controlling the false discovery rate", Journal of the
/// Royal Statistical Society B 57 (1995), pp. 289-300; holds for independent and for positively
/// dependent tests.
std::vector<bool> called(std::span<const double> chances, double rate);

enum class Verdict { improved, no_change_shown, deteriorated };

struct ComparedSegment {
    std::size_t before; ///< index into the input, as is `after`
    std::size_t after;
    Difference difference;
    Verdict verdict;
};

struct ChangeLengths {
    std::string kind; ///< one of road_kinds(); "" = all
    double improved_m = 0;
    double unchanged_m = 0; ///< comparable, no change shown
    double deteriorated_m = 0;
    double before_alone_m = 0; ///< not comparable: passes on one side only
    double since_alone_m = 0;
    Difference mean{}; ///< over all comparable road
};

/// A section of road with its change in roughness; negative: smoother.
struct ChangedStretch {
    WorstSection stretch; ///< records index the compared segments; mean is unused
    RoadMean before;
    RoadMean after;
    Difference difference;
    double low = 0; ///< 90 % interval of the difference
    double high = 0;
};

struct ChangeSince {
    ChangeSinceConfig config{};
    std::vector<ComparedSegment> segments; ///< in key order
    ChangeLengths all;
    std::vector<ChangeLengths> kinds;   ///< kinds with measured road, in the order of road_kinds()
    std::size_t called_alone = 0;       ///< segments beyond 1.96 sd, each tested alone
    std::vector<ChangedStretch> worse;  ///< largest change first
    std::vector<ChangedStretch> better; ///< largest change first
};

/// Lengths by OSM's class of road that have passes on one side of the day only, m.
struct AloneLengths {
    std::map<std::string, double, std::less<>> before_m;
    std::map<std::string, double, std::less<>> since_m;
};

/// Compares roads before and since a day. Segments measured on both sides are compared;
/// neighbouring segments that have become significantly rougher (or smoother) are joined to
/// sections as in worst_sections, bridging at most 50 m of other segments. The difference of a
/// section covers all its segments and has the interval of road_mean. Only sections whose 90 %
/// interval excludes zero are listed.
///
/// \param before, since  segments of passes of that period alone, in key order.
/// \param alone          further lengths that have passes on one side only
ChangeSince change_since(const RoadNetwork& roads,
                         std::span<const MeasuredSegment> before,
                         std::span<const MeasuredSegment> since,
                         const ChangeSinceConfig& config,
                         const AloneLengths& alone = {});

} // namespace macadam
