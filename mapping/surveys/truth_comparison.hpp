#pragma once

#include "mapping/fusion/segment_record.hpp"
#include "mapping/surveys/segment_truth.hpp"

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace macadam {

/// Agreement of the states of a database with the truth; mm/m. A number that needs more segments
/// than available is NaN.
struct TruthScore {
    std::size_t segments = 0; ///< with a state and a truth
    double km = 0;
    double mean_truth = 0;
    double bias = 0;        ///< mean of state - truth
    double rmse = 0;        ///< of single segments
    double rmse_100m = 0;   ///< of runs of five segments, length-weighted means
    std::size_t runs = 0;   ///< of five segments
    double correlation = 0; ///< of single segments (Pearson)
    double coverage = 0;    ///< share of segments whose 90 % interval contains the truth
};

struct TruthComparison {
    TruthScore all;
    struct Class {
        std::string highway; ///< "" if the map has none
        TruthScore score;
    };
    std::vector<Class> classes; ///< longest first

    /// Segments with from <= value < to.
    struct Band {
        double from;
        std::optional<double> to; ///< `std::nullopt`: no limit
        TruthScore score;
    };
    std::vector<Band> levels; ///< of the true MRI, mm/m; those with segments
    std::vector<Band> speeds; ///< of the mean speed of the passes, km/h; those with segments
};

/// Joins states and truth by segment key and compares their MRI. A run is five consecutive segments
/// of one way and direction that all have a state and a truth; runs do not overlap.
///
/// \param states     in key order; records without a state are skipped.
/// \param truth      in key order.
/// \param speed_kmh  mean speed of the passes of a segment; segments without one are in no band of
///                   speed.
/// \throws InputError  if a segment's position along its way differs: database and truth have
/// different networks or segment lengths.
TruthComparison compare_with_truth(std::span<const SegmentRecord> states,
                                   std::span<const SegmentTruth> truth,
                                   const std::map<SegmentKey, double>& speed_kmh = {});

} // namespace macadam
