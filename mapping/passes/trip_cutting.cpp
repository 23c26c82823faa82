#include "mapping/passes/trip_cutting.hpp"

#include "estimator/roughness/roughness_mean.hpp"
#include "mapping/passes/segment_overlap.hpp"
#include "mapping/passes/track_difference.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

namespace macadam {
namespace {

constexpr double min_cover = 0.5; // of a cell, as of a segment

/// Station and travel at the same time of a drive.
struct StationSample {
    double station_m;
    double travel_m;
};

/// Returns samples with increasing station and travel. Backward steps within a drive are rounding
/// errors.
std::vector<StationSample> samples_of(std::span<const SegmentOverlap> parts) {
    std::vector<StationSample> samples;
    const auto add = [&](const StationSample& sample) {
        if (samples.empty() || (sample.station_m > samples.back().station_m &&
                                sample.travel_m >= samples.back().travel_m)) {
            samples.push_back(sample);
        }
    };
    for (const auto& part : parts) {
        add({part.from_station_m, part.travel.from_m});
        add({part.to_station_m, part.travel.to_m});
    }
    return samples;
}

/// Interpolates travel; extrapolated one to one beyond the ends.
double travel_at(std::span<const StationSample> samples, double station_m) {
    if (station_m <= samples.front().station_m) {
        return samples.front().travel_m + station_m - samples.front().station_m;
    }
    if (station_m >= samples.back().station_m) {
        return samples.back().travel_m + station_m - samples.back().station_m;
    }
    const auto next = std::ranges::upper_bound(samples, station_m, {}, &StationSample::station_m);
    const auto before = next - 1;
    return std::lerp(before->travel_m,
                     next->travel_m,
                     (station_m - before->station_m) / (next->station_m - before->station_m));
}

TraceCell cell_over(const TravelSpan& travel,
                    const IriTrace& roughness,
                    const std::optional<TrackDifference>& tracks,
                    const Vehicle& vehicle) {
    const auto mean = mean_over(roughness, travel.from_m, travel.to_m, vehicle);
    const auto headline = headline_of(mean, ratio_over(tracks, travel.from_m, travel.to_m));
    if (!headline || !(mean.covered_m >= min_cover * (travel.to_m - travel.from_m))) {
        return {};
    }
    return {code_of(headline->iri_mm_per_m),
            mean.left_mm_per_m ? code_of(*mean.left_mm_per_m) : no_roughness};
}

/// Returns the length-weighted mean of the drive in whole decimetres, so that differences between
/// processors in the last bit of a filter hardly ever show.
std::int32_t place_sd_mm(std::span<const SegmentOverlap> parts) {
    constexpr double min_sd_dm = 3;   // cut corners and lane keeping are in no filter
    constexpr double max_sd_dm = 500; // far beyond what lags can correct
    double sum = 0;
    double length_m = 0;
    for (const auto& part : parts) {
        const double part_m = part.to_station_m - part.from_station_m;
        sum += part_m * part.place_sd_m;
        length_m += part_m;
    }
    const double sd_dm = std::clamp(10 * sum / length_m, min_sd_dm, max_sd_dm);
    return 100 * static_cast<std::int32_t>(std::lround(sd_dm));
}

/// \param readable  readable range of travel
RoughnessTrace trace_of(std::span<const SegmentOverlap> parts,
                        const TravelSpan& readable,
                        const IriTrace& roughness,
                        const std::optional<TrackDifference>& tracks,
                        const RoadNetwork& roads,
                        const Vehicle& vehicle) {
    const auto samples = samples_of(parts);
    const auto first =
        static_cast<std::int32_t>(std::floor(samples.front().station_m - trace_margin_m));
    const auto last =
        static_cast<std::int32_t>(std::ceil(samples.back().station_m + trace_margin_m));
    std::vector<TraceCell> cells;
    for (auto metre = first; metre < last; ++metre) {
        const TravelSpan travel{travel_at(samples, metre), travel_at(samples, metre + 1)};
        const bool is_readable = travel.from_m >= readable.from_m && travel.to_m <= readable.to_m;
        cells.push_back(is_readable ? cell_over(travel, roughness, tracks, vehicle) : TraceCell{});
    }
    return with_cells({.chunk = chunk_of(parts.front().segment, roads.segment_length_m),
                       .drive = *parts.front().drive,
                       .first_m = first,
                       .iri = {},
                       .left = {},
                       .place_sd_mm = place_sd_mm(parts)},
                      cells);
}

bool is_same_drive(const SegmentOverlap& a, const SegmentOverlap& b, double segment_length_m) {
    return a.drive == b.drive &&
           chunk_of(a.segment, segment_length_m) == chunk_of(b.segment, segment_length_m);
}

/// \param readable  readable range of travel
std::vector<RoughnessTrace> extract_traces(std::vector<SegmentOverlap> parts,
                                           const TravelSpan& readable,
                                           const IriTrace& roughness,
                                           const RoadNetwork& roads,
                                           const Vehicle& vehicle) {
    const auto tracks = track_difference_of(roughness, vehicle);
    std::vector<RoughnessTrace> traces;
    std::erase_if(parts, [](const SegmentOverlap& part) { return !part.drive; });
    for (auto first = parts.begin(); first != parts.end();) {
        auto last = first + 1;
        while (last != parts.end() && is_same_drive(*first, *last, roads.segment_length_m)) {
            ++last;
        }
        auto trace = trace_of({first, last}, readable, roughness, tracks, roads, vehicle);
        if (!trace.iri.empty()) {
            traces.push_back(std::move(trace));
        }
        first = last;
    }
    return traces;
}

/// Mean of the known cells of a range and their total length. Micrometres per metre.
struct Mean {
    double covered_m = 0;
    double um = 0;
};

Mean mean_between(const std::vector<RoughnessCode>& codes, double from_m, double to_m) {
    Mean mean;
    const auto first = static_cast<std::size_t>(std::max(0.0, std::floor(from_m)));
    for (auto i = first; i < codes.size() && static_cast<double>(i) < to_m; ++i) {
        const auto at_m = static_cast<double>(i);
        if (const auto um = um_of(codes[i])) {
            const double length_m = std::min(to_m, at_m + 1) - std::max(from_m, at_m);
            mean.covered_m += length_m;
            mean.um += length_m * *um;
        }
    }
    mean.um = mean.covered_m > 0 ? mean.um / mean.covered_m : 0;
    return mean;
}

IriUm whole_um(double um) {
    return static_cast<IriUm>(std::lround(um));
}

std::optional<IriUm> scaled(const std::optional<IriUm>& um, double factor) {
    return um ? std::optional{whole_um(factor * *um)} : std::nullopt;
}

} // namespace

TripCut cut_trip(const IriTrace& roughness,
                 const MatchedTrace& matched,
                 const RoadNetwork& roads,
                 const Vehicle& vehicle,
                 const PassConfig& config) {
    if (matched.empty()) {
        return {};
    }
    auto parts = driven_parts(matched, roads, config.min_confidence);
    auto passes = driven_passes(parts, roughness, vehicle, config);
    const TravelSpan readable{matched.front().from_travel_m, matched.back().to_travel_m};
    return {std::move(passes),
            extract_traces(std::move(parts), readable, roughness, roads, vehicle)};
}

Pass moved(const Pass& pass,
           double from_station_m,
           double to_station_m,
           const RoughnessTrace& trace,
           double from_lag_m,
           double to_lag_m) {
    if (from_lag_m == 0 && to_lag_m == 0) {
        return pass;
    }
    const double from_m = from_station_m + from_lag_m - trace.first_m;
    const double to_m = to_station_m + to_lag_m - trace.first_m;
    const auto mean = mean_between(trace.iri, from_m, to_m);
    if (mean.covered_m < min_cover * (to_m - from_m) || pass.iri_um <= 0) {
        return pass;
    }
    const double factor = mean.um / pass.iri_um;
    auto again = pass;
    again.iri_um = whole_um(mean.um);
    again.sd_um = std::max(1, whole_um(factor * pass.sd_um));
    again.iri_centre_um = scaled(pass.iri_centre_um, factor);
    again.iri_left_um = scaled(pass.iri_left_um, factor);
    again.iri_right_um = scaled(pass.iri_right_um, factor);
    again.covered_mm = static_cast<std::int32_t>(std::lround(1000 * mean.covered_m));
    const auto left = mean_between(trace.left, from_m, to_m);
    if (pass.iri_left_um && pass.iri_right_um && left.covered_m == mean.covered_m) {
        again.iri_left_um = whole_um(left.um);
        again.iri_right_um = whole_um(std::max(0.0, 2 * mean.um - left.um));
    }
    return again;
}

} // namespace macadam
