#pragma once

#include "mapping/fusion/segment_record.hpp"
#include "mapping/surveys/segment_truth.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace macadam {

/// How near the states of a store come to the truth; mm/m. A number that needs more segments than
/// there are is NaN.
struct TruthScore {
    std::size_t segments = 0; ///< with a state and a truth
    double km = 0;
    double mean_truth = 0;
    double bias = 0;        ///< mean of state - truth
    double rmse = 0;        ///< of single segments
    double rmse_100m = 0;   ///< of runs of five segments, length-weighted means
    std::size_t runs = 0;   ///< of five segments
    double correlation = 0; ///< of single segments (Pearson)
    double coverage = 0;    ///< share of segments whose 90 % interval holds the truth
};

struct TruthComparison {
    TruthScore all;
    struct Class {
        std::string highway; ///< "" where the map has none
        TruthScore score;
    };
    std::vector<Class> classes; ///< longest first
};

/// Joins by segment key; the truth that counts is the MRI. A run is five consecutive segments of
/// one way and direction that all have a state and a truth; runs do not overlap.
///
/// \param states  in the order of their keys; those without a state are passed over.
/// \param truth   in the order of their keys.
/// \throws InputError  if a segment's place along its way is not the same in both: the store and
///                     the truth are of different networks or segment lengths.
TruthComparison compare_with_truth(std::span<const SegmentRecord> states,
                                   std::span<const SegmentTruth> truth);

} // namespace macadam
