#pragma once

#include "mapping/fusion.hpp"
#include "storage/fusion_settings.hpp"
#include "storage/road_store.hpp"
#include "storage/sqlite.hpp"
#include "storage/strip_passes.hpp"
#include "storage/strip_rows.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

namespace macadam {

struct FusedSegment {
    std::int64_t fid;
    SegmentState state;
};

struct FusedStrip {
    LaySummary laid;                    ///< of its traces
    std::vector<FusedSegment> segments; ///< with a pass, in the order of their rows
};

/// Which passes a state is fused from.
struct PassChoice {
    std::optional<Period> period; ///< those with a date in it
    bool cars_alone;              ///< those of references are left out
};

/// States of the segments of strips, fused from their passes, which are first laid on each other,
/// by the rules that the store has when this is made.
class StripStates {
public:
    explicit StripStates(Database& database);

    /// \param strip  the row of its first segment.
    FusedStrip of(std::int64_t strip, std::int64_t segments_in_strip);

    /// Its segments from some passes alone, as if there were no others.
    std::vector<FusedSegment>
    of(std::int64_t strip, std::int64_t segments_in_strip, const PassChoice& choice);

    /// The passes of these trips, by hash, where they lie among each other; as they were read,
    /// whatever is known of their cars, and also those of a road that is no more.
    std::vector<StripPass> readings(std::int64_t strip,
                                    std::int64_t segments_in_strip,
                                    const std::unordered_set<std::string>& trips);

    /// The passes of cars from which states are fused, where their own trips put them.
    std::vector<StripPass> passes_of_cars(std::int64_t strip, std::int64_t segments_in_strip);

    /// Takes them to where they lie among each other, as if there were no others.
    void lay_on_each_other(std::int64_t strip, std::vector<StripPass>& passes);

    const FusionConfig& config() const { return config_; }

private:
    std::vector<StripPass> valid_passes(std::int64_t strip, std::int64_t segments_in_strip);

    StripTraces traces_;
    StripPasses passes_;
    ValidFrom valid_from_;
    CarRecords cars_;
    FusionConfig config_;
};

} // namespace macadam
