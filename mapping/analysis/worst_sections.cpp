#include "mapping/analysis/worst_sections.hpp"

#include "mapping/analysis/network_summary.hpp"

#include "mapping/analysis/correlated_mean.hpp"
#include "mapping/analysis/maximum_scoring_runs.hpp"
#include "mapping/network/road_strokes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string_view>
#include <utility>

namespace macadam {
namespace {

constexpr std::size_t unmeasured = ~std::size_t{0};
constexpr double a_centimetre_m = 0.01; // output resolution of lengths

/// Index of the measured segments in key order.
struct Lookup {
    std::span<const MeasuredSegment> records;
    std::vector<std::size_t> order;

    const SegmentKey& key(std::size_t i) const { return records[i].key; }
};

Lookup lookup_of(std::span<const MeasuredSegment> measured) {
    Lookup lookup{measured, std::vector<std::size_t>(measured.size())};
    std::iota(lookup.order.begin(), lookup.order.end(), std::size_t{0});
    std::ranges::sort(lookup.order, [&](auto a, auto b) { return lookup.key(a) < lookup.key(b); });
    return lookup;
}

/// A segment of a road that is followed.
struct Piece {
    EdgeId edge;
    std::uint32_t number; ///< along the edge, in driving direction
    std::size_t record;   ///< or `unmeasured`
    double length_m;
};

/// Returns the measured segments of an edge in key order.
std::span<const std::size_t>
measured_on(const RoadNetwork& roads, const Lookup& lookup, EdgeId edge) {
    const auto link = link_at(roads, edge);
    const SegmentKey first{way_of(roads, edge).id, is_forward(edge), link.first_segment};
    auto past = first;
    past.index += link.segments;
    const auto at = [&](const SegmentKey& key) {
        return std::ranges::lower_bound(
            lookup.order, key, {}, [&](std::size_t i) { return lookup.key(i); });
    };
    return {at(first), at(past)};
}

std::vector<Piece> pieces_on(const RoadNetwork& roads, const Lookup& lookup, EdgeId edge) {
    const auto link = link_at(roads, edge);
    const double piece_m = (link.to_m - link.from_m) / link.segments;
    std::vector<Piece> pieces;
    for (std::uint32_t i = 0; i < link.segments; ++i) {
        pieces.push_back({edge, i, unmeasured, piece_m});
    }
    for (const auto record : measured_on(roads, lookup, edge)) {
        const auto along = lookup.key(record).index - link.first_segment;
        pieces[is_forward(edge) ? along : link.segments - 1 - along].record = record;
    }
    return pieces;
}

std::vector<Piece>
pieces_along(const RoadNetwork& roads, const Lookup& lookup, const std::vector<EdgeId>& chain) {
    std::vector<Piece> pieces;
    for (const auto edge : chain) {
        const auto more = pieces_on(roads, lookup, edge);
        pieces.insert(pieces.end(), more.begin(), more.end());
    }
    return pieces;
}

/// Selects edges with a measured segment, and edges short enough to be bridged by a section.
std::vector<bool>
edges_to_follow(const RoadNetwork& roads, const Lookup& lookup, const WorstSectionConfig& config) {
    std::vector<bool> wanted(std::size_t{2} * link_count(roads), false);
    for (std::uint32_t i = 0; i < wanted.size(); ++i) {
        const EdgeId edge{i};
        wanted[i] = !measured_on(roads, lookup, edge).empty() ||
                    (is_drivable(roads, edge) && length_m(roads, edge) <= config.max_unmeasured_m);
    }
    return wanted;
}

double excess_mm_per_m(const Lookup& lookup, const Piece& piece, const WorstSectionConfig& config) {
    return rated_length(lookup.records[piece.record]).iri - config.above_mm_per_m;
}

/// Road between two poor segments.
struct Between {
    double unmeasured_m = 0; ///< longest contiguous length
    double better_m = 0;
    double row_m = 0; ///< current contiguous unmeasured length

    void add(const Piece& piece) {
        row_m = piece.record == unmeasured ? row_m + piece.length_m : 0;
        better_m += piece.record == unmeasured ? 0 : piece.length_m;
        unmeasured_m = std::max(unmeasured_m, row_m);
    }
    bool may_be_bridged(const WorstSectionConfig& config) const {
        return unmeasured_m <= config.max_unmeasured_m + a_centimetre_m &&
               better_m <= config.most_better_m + a_centimetre_m;
    }
};

/// Finds the parts of a road that begin and end with poor segments and contain no unbridgeable gap.
std::vector<IndexRange> blocks_of(const std::vector<Piece>& pieces,
                                  const Lookup& lookup,
                                  const WorstSectionConfig& config) {
    std::vector<IndexRange> blocks;
    Between between;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const bool poor =
            pieces[i].record != unmeasured && excess_mm_per_m(lookup, pieces[i], config) > 0;
        if (!poor) {
            between.add(pieces[i]);
            continue;
        }
        if (blocks.empty() || !between.may_be_bridged(config)) {
            blocks.push_back({i, i});
        }
        blocks.back().last = i + 1;
        between = {};
    }
    return blocks;
}

/// Finds a road's runs of poor segments, as index ranges.
std::vector<IndexRange> poor_runs(const std::vector<Piece>& pieces,
                                  const Lookup& lookup,
                                  const WorstSectionConfig& config) {
    std::vector<IndexRange> runs;
    std::vector<double> scores;
    for (const auto& block : blocks_of(pieces, lookup, config)) {
        scores.clear();
        for (auto i = block.first; i < block.last; ++i) {
            scores.push_back(pieces[i].record == unmeasured
                                 ? 0
                                 : pieces[i].length_m * excess_mm_per_m(lookup, pieces[i], config));
        }
        for (const auto& run : maximal_scoring_runs(scores)) {
            runs.push_back({block.first + run.first, block.first + run.last});
        }
    }
    return runs;
}

// ----------------------------------------------------------------------------- what they amount to

std::vector<Segment> segments_along(const RoadNetwork& roads, std::span<const Piece> pieces) {
    std::vector<Segment> segments, of_edge;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (i == 0 || pieces[i].edge != pieces[i - 1].edge) {
            of_edge = segments_of(roads, pieces[i].edge);
        }
        segments.push_back(of_edge[pieces[i].number]);
    }
    return segments;
}

/// Returns true if a segment continues a part of its way in driving direction.
bool goes_on(const StretchPart& part, const Segment& segment) {
    if (part.way_id != segment.key.way_id || part.forward != segment.key.forward) {
        return false;
    }
    const double apart_m = part.forward ? segment.from_m - part.to_m : segment.to_m - part.from_m;
    return std::abs(apart_m) < a_centimetre_m;
}

std::vector<StretchPart> parts_of(const std::vector<Segment>& segments) {
    std::vector<StretchPart> parts;
    for (const auto& segment : segments) {
        if (parts.empty() || !goes_on(parts.back(), segment)) {
            parts.push_back(
                {segment.key.way_id, segment.key.forward, segment.from_m, segment.to_m});
        } else if (segment.key.forward) {
            parts.back().to_m = segment.to_m;
        } else {
            parts.back().from_m = segment.from_m;
        }
    }
    return parts;
}

std::vector<GeoPoint> line_through(const std::vector<Segment>& segments) {
    std::vector<GeoPoint> line;
    for (const auto& segment : segments) {
        for (const auto& point : segment.line) {
            if (line.empty() || distance_m(line.back(), point) > a_centimetre_m) {
                line.push_back(point);
            }
        }
    }
    return line;
}

/// Summarises the measured segments of a section.
WorstSection rated(std::vector<std::size_t> records, const Lookup& lookup, double common_share) {
    std::vector<SegmentState> states(records.size());
    std::vector<MeasuredPiece> pieces;
    for (std::size_t i = 0; i < records.size(); ++i) {
        const auto& segment = lookup.records[records[i]];
        states[i].iri_um = segment.iri_um;
        states[i].sd_um = segment.sd_um;
        states[i].passes = segment.passes;
        states[i].vehicles = segment.vehicles;
        states[i].first_seen_ms = segment.first_seen_ms;
        states[i].last_seen_ms = segment.last_seen_ms;
        pieces.push_back({segment.to_m - segment.from_m, 0, &states[i]});
    }
    const auto road = measured_road(pieces, {.common_share = common_share, .correlation_m = 0});
    WorstSection section{};
    section.records = std::move(records);
    section.mean = road.mean;
    section.worst_iri = road.worst_iri;
    section.min_passes = road.min_passes;
    section.median_passes = road.median_passes;
    section.vehicles = road.vehicles;
    section.first_seen_ms = road.first_seen_ms;
    section.last_seen_ms = road.last_seen_ms;
    return section;
}

WorstSection section_of(const RoadNetwork& roads,
                        const Lookup& lookup,
                        std::span<const Piece> pieces,
                        double common_share) {
    std::vector<std::size_t> records;
    double length_m = 0;
    for (const auto& piece : pieces) {
        length_m += piece.length_m;
        if (piece.record != unmeasured) {
            records.push_back(piece.record);
        }
    }
    auto section = rated(std::move(records), lookup, common_share);
    const auto segments = segments_along(roads, pieces);
    const auto& first = lookup.records[section.records.front()];
    section.name = first.name;
    section.highway = first.highway;
    section.parts = parts_of(segments);
    section.line = line_through(segments);
    section.length_m = length_m;
    section.middle = halfway_along(section.line);
    return section;
}

} // namespace

double poor_above(const ClassTable& table) {
    return table.classes[(table.classes.size() - 1) / 2].to_mm_per_m;
}

std::vector<WorstSection> worst_sections(const RoadNetwork& roads,
                                         std::span<const MeasuredSegment> measured,
                                         const WorstSectionConfig& config) {
    const auto lookup = lookup_of(measured);
    const auto wanted = edges_to_follow(roads, lookup, config);
    std::vector<WorstSection> sections;
    for (const auto& chain : road_strokes(roads, wanted, config.sharpest_turn_deg)) {
        const auto pieces = pieces_along(roads, lookup, chain);
        for (const auto& run : poor_runs(pieces, lookup, config)) {
            const auto of_run = std::span{pieces}.subspan(run.first, run.last - run.first);
            auto section = section_of(roads, lookup, of_run, config.common_share);
            if (section.length_m >= config.min_length_m - a_centimetre_m) {
                sections.push_back(std::move(section));
            }
        }
    }
    std::ranges::sort(sections, [&](const WorstSection& a, const WorstSection& b) {
        return std::pair{-a.mean.iri, lookup.key(a.records.front())} <
               std::pair{-b.mean.iri, lookup.key(b.records.front())};
    });
    return sections;
}

std::vector<WorstSection> worst_sections(const RoadNetwork& roads,
                                         std::span<const SegmentRecord> records,
                                         const WorstSectionConfig& config) {
    std::vector<MeasuredSegment> measured;
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < records.size(); ++i) {
        if (records[i].state) {
            measured.push_back(measured_segment(records[i]));
            indices.push_back(i);
        }
    }
    auto sections = worst_sections(roads, std::span<const MeasuredSegment>{measured}, config);
    for (auto& section : sections) {
        for (auto& record : section.records) {
            record = indices[record];
        }
    }
    return sections;
}

double traffic_weight(std::string_view highway) {
    constexpr std::array<std::pair<std::string_view, double>, 8> weights{{{"motorway", 4},
                                                                          {"trunk", 4},
                                                                          {"primary", 4},
                                                                          {"secondary", 3},
                                                                          {"tertiary", 2},
                                                                          {"service", 0.5},
                                                                          {"track", 0.5},
                                                                          {"other", 0.5}}};
    const auto kind = road_kind(highway);
    const auto* const found =
        std::ranges::find(weights, kind, [](const auto& weight) { return weight.first; });
    return found == weights.end() ? 1 : found->second;
}

RepairNeed repair_need(const WorstSection& section, double above_mm_per_m) {
    const double weight = traffic_weight(section.highway) * section.mean.length_m;
    return {.certain = weight * std::max(0.0, section.mean.low - above_mm_per_m),
            .expected = weight * (section.mean.iri - above_mm_per_m)};
}

void sort_by_need(std::vector<WorstSection>& sections, double above_mm_per_m) {
    std::ranges::stable_sort(sections, [&](const WorstSection& a, const WorstSection& b) {
        const auto of_a = repair_need(a, above_mm_per_m);
        const auto of_b = repair_need(b, above_mm_per_m);
        return std::pair{of_a.certain, of_a.expected} > std::pair{of_b.certain, of_b.expected};
    });
}

} // namespace macadam
