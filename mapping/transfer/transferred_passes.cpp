#include "mapping/transfer/transferred_passes.hpp"

#include "mapping/transfer/transferred_events.hpp"
#include "mapping/transfer/transferred_intervals.hpp"
#include "mapping/transfer/transferred_trace.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <tuple>

namespace macadam {
namespace {

constexpr double min_cover = PassConfig{}.min_cover;
constexpr double mm_per_m = 1000;

using ChunkOrder = std::tuple<std::int64_t, bool, std::uint32_t>;

ChunkOrder order_of(const ChunkKey& chunk) {
    return {chunk.way_id, !chunk.forward, chunk.number};
}

/// Length-weighted sums over the intervals of one pass.
class IntervalMean {
public:
    explicit IntervalMean(std::span<const TransferredInterval> intervals) : intervals_{intervals} {
        for (const auto& interval : intervals) {
            covered_m_ += interval.covered_m;
        }
    }

    double covered_m() const { return covered_m_; }

    template <typename Value>
    double of(Value value) const {
        double sum = 0;
        for (const auto& interval : intervals_) {
            sum += interval.covered_m * value(interval);
        }
        return sum / covered_m_;
    }

    template <typename Integer>
    Integer whole(Integer Pass::*value) const {
        return static_cast<Integer>(std::llround(of([&](const TransferredInterval& interval) {
            return static_cast<double>(interval.pass->*value);
        })));
    }

    /// Returns the mean; `std::nullopt` if one of the passes lacks the value.
    std::optional<IriUm> known(std::optional<IriUm> Pass::*value) const {
        const auto is_known = [&](const TransferredInterval& interval) {
            return (interval.pass->*value).has_value();
        };
        return std::ranges::all_of(intervals_, is_known)
                   ? std::optional{static_cast<IriUm>(
                         std::lround(of([&](const TransferredInterval& interval) {
                             return static_cast<double>(*(interval.pass->*value));
                         })))}
                   : std::nullopt;
    }

private:
    std::span<const TransferredInterval> intervals_;
    double covered_m_ = 0;
};

/// Builds the pass of a drive over one new segment; `std::nullopt` if too little of it is covered.
std::optional<Pass> pass_of(std::span<const TransferredInterval> intervals) {
    const IntervalMean mean{intervals};
    const auto& first = intervals.front();
    const double segment_m = length_m(first.correspondence.whole_m);
    const double covered_m = std::min(segment_m, mean.covered_m());
    if (!(covered_m > 0) || covered_m < min_cover * segment_m) {
        return std::nullopt;
    }
    auto pass = *first.pass;
    pass.segment = first.correspondence.after;
    pass.iri_left_um = mean.known(&Pass::iri_left_um);
    pass.iri_right_um = mean.known(&Pass::iri_right_um);
    pass.iri_centre_um = mean.known(&Pass::iri_centre_um);
    pass.iri_um = mean.whole(&Pass::iri_um);
    pass.sd_um = std::max(1, mean.whole(&Pass::sd_um)); // same car: errors of its passes are common
    pass.speed_mmps = mean.whole(&Pass::speed_mmps);
    pass.confidence_ppm = mean.whole(&Pass::confidence_ppm);
    pass.covered_mm = static_cast<std::int32_t>(std::lround(covered_m * mm_per_m));
    pass.t_ms =
        std::llround(mean.of([](const TransferredInterval& interval) { return interval.t_ms; }));
    for (const auto& interval : intervals) {
        pass.centre_only = pass.centre_only || interval.pass->centre_only;
        pass.validity = static_cast<std::uint8_t>(pass.validity | interval.pass->validity);
    }
    return pass;
}

/// Groups the intervals of a drive by new segment; each segment occurs once.
std::map<SegmentKey, std::vector<TransferredInterval>>
intervals_by_segment(const std::vector<TransferredInterval>& intervals) {
    std::map<SegmentKey, std::vector<TransferredInterval>> by_segment;
    for (const auto& interval : intervals) {
        by_segment[interval.correspondence.after].push_back(interval);
    }
    return by_segment;
}

/// A new pass with the old passes it is made from.
struct NewPass {
    Pass pass;
    std::vector<const Pass*> made_of;
};

std::vector<NewPass> passes_of(const TransferredDrive& drive,
                               const SegmentCorrespondences& correspondences) {
    std::vector<NewPass> passes;
    for (const auto& [key, intervals] : intervals_by_segment(drive.intervals)) {
        std::vector<const Pass*> made_of;
        std::ranges::transform(intervals, std::back_inserter(made_of), &TransferredInterval::pass);
        // Slivers of its neighbours, below a millimetre, may be present too.
        const auto same = std::ranges::find_if(intervals, [&](const TransferredInterval& interval) {
            const auto correspondence = correspondences.unchanged(interval.pass->segment);
            return correspondence && correspondence->after == key;
        });
        if (same != intervals.end()) {
            auto pass = *same->pass;
            pass.segment = key;
            pass.drive = drive.number;
            passes.push_back({pass, std::move(made_of)});
        } else if (auto pass = pass_of(intervals)) {
            pass->drive = drive.number;
            passes.push_back({*pass, std::move(made_of)});
        }
    }
    return passes;
}

/// Numbers the passes over a segment in order of time.
void number_occurrences(std::vector<NewPass>& passes) {
    std::ranges::stable_sort(passes, {}, [](const NewPass& made) { return made.pass.t_ms; });
    std::map<SegmentKey, std::uint32_t> occurrences;
    for (auto& [pass, made_of] : passes) {
        pass.occurrence = occurrences[pass.segment]++;
    }
}

/// Old chunks whose data only change their key, and the data to be recut.
struct Parted {
    TransferredPasses renamed;
    TripPasses rest;
};

SegmentKey renamed_key(const SegmentKey& key, const SegmentCorrespondences& correspondences) {
    return correspondences.unchanged(key)->after;
}

PassEvent
renamed(PassEvent event, const ShiftedChunk& to, const SegmentCorrespondences& correspondences) {
    const double at_m =
        station_m(event.segment.forward, static_cast<double>(event.at_mm) / mm_per_m);
    event.segment = renamed_key(event.segment, correspondences);
    event.at_mm = std::llround(mm_per_m * std::abs(at_m + to.shift_m));
    return event;
}

Parted parted(const TripPasses& old, const SegmentCorrespondences& correspondences) {
    const double segment_length_m = correspondences.before().segment_length_m;
    std::map<ChunkOrder, std::optional<ShiftedChunk>> chunks;
    const auto moved = [&](const ChunkKey& chunk) {
        const auto [found, is_new] = chunks.try_emplace(order_of(chunk));
        if (is_new) {
            found->second = correspondences.moved(chunk);
        }
        return found->second;
    };
    Parted parts;
    for (const auto& pass : old.passes) {
        if (moved(chunk_of(pass.segment, segment_length_m))) {
            parts.renamed.readings.passes.push_back(pass);
            parts.renamed.readings.passes.back().segment =
                renamed_key(pass.segment, correspondences);
            ++parts.renamed.moved;
        } else {
            parts.rest.passes.push_back(pass);
        }
    }
    for (const auto& event : old.events) {
        if (const auto to = moved(chunk_of(event.segment, segment_length_m))) {
            parts.renamed.readings.events.push_back(renamed(event, *to, correspondences));
        } else {
            parts.rest.events.push_back(event);
        }
    }
    for (const auto& trace : old.traces) {
        if (const auto to = moved(trace.chunk)) {
            parts.renamed.readings.traces.push_back(trace);
            auto& renamed = parts.renamed.readings.traces.back();
            renamed.chunk = to->chunk;
            renamed.first_m += static_cast<std::int32_t>(std::lround(to->shift_m));
        } else {
            parts.rest.traces.push_back(trace);
        }
    }
    return parts;
}

/// Finds the new pass that is made from the old pass of an event.
NewOccurrence occurrence_in(const std::vector<NewPass>& passes) {
    return [&](const PassEvent& old, const SegmentKey& after) -> std::optional<std::uint32_t> {
        const auto is_old = [&](const Pass* pass) {
            return pass->segment == old.segment && pass->occurrence == old.occurrence;
        };
        const auto made = std::ranges::find_if(passes, [&](const NewPass& each) {
            return each.pass.segment == after && std::ranges::any_of(each.made_of, is_old);
        });
        return made == passes.end() ? std::nullopt : std::optional{made->pass.occurrence};
    };
}

} // namespace

TransferredPasses transfer_passes(const TripPasses& old,
                                  const SegmentCorrespondences& correspondences) {
    auto [all, rest] = parted(old, correspondences);
    std::vector<NewPass> passes;
    for (const auto& intervals : intervals_by_chunk(rest.passes, correspondences)) {
        for (const auto& drive : drives_of(intervals)) {
            std::ranges::move(passes_of(drive, correspondences), std::back_inserter(passes));
            if (auto trace =
                    trace_of(drive, rest.traces, correspondences.before().segment_length_m)) {
                all.readings.traces.push_back(std::move(*trace));
            }
        }
    }
    number_occurrences(passes);
    std::ranges::move(carried_events(rest.events, correspondences, occurrence_in(passes)),
                      std::back_inserter(all.readings.events));
    std::set<const Pass*> used;
    for (const auto& [pass, made_of] : passes) {
        all.readings.passes.push_back(pass);
        used.insert(made_of.begin(), made_of.end());
    }
    all.moved += used.size();
    all.lost = rest.passes.size() - used.size();
    return all;
}

} // namespace macadam
