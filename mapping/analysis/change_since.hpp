#pragma once

#include "mapping/analysis/length_weighted_mean.hpp"
#include "mapping/analysis/worst_sections.hpp"
#include "mapping/fusion/fusion_config.hpp"
#include "mapping/fusion/segment_record.hpp"
#include "mapping/network/road_network.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace macadam {

struct ChangeSinceConfig {
    double rate = 0.05;    ///< of what is called changed, at most this share by chance (expected)
    FusionConfig fusion{}; ///< of what the errors of states are made
    double min_length_m = 100;    ///< of a stretch that is listed
    double max_unmeasured_m = 30; ///< as WorstSectionConfig
    double max_other_m = 50;      ///< comparable but not called, in a row, within a stretch
    double sharpest_turn_deg = 60;
};

/// How much rougher a road has become, mm/m; less than 0: smoother.
struct Difference {
    double length_m = 0;
    double mm_per_m = 0;
    double sd = 0;
};

/// Of its variance, what all cars read wrong alike, mm^2/m^2: fusion makes the variance of n passes
/// of m cars with stated variance s^2 as share s^2 + car_share s^2 / m + rest^2 / n, which is
/// solved for s. 0 where references alone tell.
double common_variance(const SegmentState& state, const FusionConfig& config);

/// \param before, after  of the same segment, from different passes, with states. What all cars
/// read
///        wrong alike (c) is there on both sides, for the model of the cars and the method have
///        stayed the same, and cancels as far as it is equally large: the variance is
///        s1^2 - c1^2 + s2^2 - c2^2 + (c1 - c2)^2. That a car may have driven on both sides, so
///        that its own error cancels too, is not counted: the variance is rather too large then.
Difference
difference_of(const SegmentRecord& before, const SegmentRecord& after, const FusionConfig& config);

/// The probability that a difference as large, of either sign, comes by chance where nothing has
/// changed. Normal errors.
double chance_of(const Difference& difference);

/// Which of many tests to call, so that of those called an expected share of at most `rate` is
/// called by chance.
///
/// \param chances  any order. \returns  as many.
///
/// Source: Y. Benjamini and Y. Hochberg, "Controlling the false discovery rate", Journal of the
/// Royal Statistical Society B 57 (1995), pp. 289-300; holds for independent tests and for those
/// whose errors go together.
std::vector<bool> called(std::span<const double> chances, double rate);

enum class Verdict { improved, no_change_shown, deteriorated };

struct ComparedSegment {
    std::size_t before; ///< places in what was given
    std::size_t after;
    Difference difference;
    Verdict verdict;
};

struct ChangeLengths {
    std::string kind; ///< of road_kinds(); "" = all
    double improved_m = 0;
    double unchanged_m = 0; ///< comparable, no change shown
    double deteriorated_m = 0;
    double before_alone_m = 0; ///< not comparable: passes of one side alone
    double since_alone_m = 0;
    Difference mean{}; ///< of all that is comparable
};

/// A stretch with what it has become rougher by; less than 0: smoother.
struct ChangedStretch {
    WorstSection stretch; ///< records: places among the compared segments; mean is not used
    RoadMean before;
    RoadMean after;
    Difference difference;
    double low = 0; ///< 90 % interval of the difference
    double high = 0;
};

struct ChangeSince {
    ChangeSinceConfig config{};
    std::vector<ComparedSegment> segments; ///< in the order of their keys
    ChangeLengths all;
    std::vector<ChangeLengths> kinds;   ///< with something measured, in the order of road_kinds()
    std::size_t called_alone = 0;       ///< segments past 1.96 sd, each tested alone
    std::vector<ChangedStretch> worse;  ///< the most first
    std::vector<ChangedStretch> better; ///< the most first
};

/// What roads say before and since a day. Segments that both know are compared; neighbouring ones
/// that have become rougher (or smoother) by more than chance explains are joined to stretches, as
/// worst_sections does, with at most 50 m of others between two of them. The difference of a
/// stretch is of all of its segments and has the interval of road_mean. Listed are those whose
/// 90 % interval leaves out zero.
///
/// \param before, since  segments with states from passes of that time alone, in the order of keys.
ChangeSince change_since(const RoadNetwork& roads,
                         std::span<const SegmentRecord> before,
                         std::span<const SegmentRecord> since,
                         const ChangeSinceConfig& config);

} // namespace macadam
