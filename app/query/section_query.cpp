#include "app/query/section_query.hpp"

#include "estimator/common/error.hpp"
#include "mapping/analysis/exclusion.hpp"
#include "mapping/analysis/homogeneous_sections.hpp"
#include "mapping/routes/line_matching.hpp"
#include "storage/networks/network_file.hpp"
#include "storage/surveys/exclusion_file.hpp"
#include "storage/surveys/section_file.hpp"

#include <fmt/format.h>

#include <map>

namespace macadam {
namespace {

/// Requested road; its beginning has a station, and stations rise or fall along it.
struct AskedRoad {
    std::string name;
    LinearRoute road;
    double begin_m = 0;
    bool rises = true;
};

/// Finds roads of the network from the references in files; looks up each named road once.
class RoadFinder {
public:
    explicit RoadFinder(const RoadNetwork& roads) : roads_{roads} {}

    AskedRoad operator()(const SectionReference& reference) {
        try {
            return !reference.line.empty() ? of_line(reference)
                   : reference.way_id      ? of_way(reference)
                                           : of_route(reference);
        } catch (const InputError& error) {
            throw InputError{fmt::format("{}: {}", reference.where, error.what())};
        }
    }

private:
    AskedRoad of_line(const SectionReference& reference) const {
        return {reference.name, matched_line(roads_, reference.line)};
    }

    AskedRoad of_way(const SectionReference& reference) const {
        const auto whole = route_along_way(roads_, *reference.way_id, {}, {}, true);
        return part(reference, whole);
    }

    AskedRoad of_route(const SectionReference& reference) {
        auto known = named_.find(reference.route);
        if (known == named_.end()) {
            known =
                named_.emplace(reference.route, route_of_named_road(roads_, reference.route)).first;
        }
        return part(reference, known->second);
    }

    /// Cuts a road to the stations of a reference.
    AskedRoad part(const SectionReference& reference, const LinearRoute& whole) const {
        const double whole_m = length_m(whole);
        const bool rises = reference.forward.value_or(reference.from_m.value_or(0) <=
                                                      reference.to_m.value_or(whole_m));
        auto begin_m = reference.from_m.value_or(rises ? 0 : whole_m);
        auto end_m = reference.to_m.value_or(rises ? whole_m : 0);
        if (rises != (begin_m <= end_m)) {
            std::swap(begin_m, end_m);
        }
        auto road = part_of(whole, roads_, begin_m, end_m);
        if (road.parts.empty()) {
            throw InputError{fmt::format("extends from {:.0f} to {:.0f} m, expected a part of "
                                         "the road, which is {:.0f} m long",
                                         begin_m,
                                         end_m,
                                         whole_m)};
        }
        return {reference.name, std::move(road), std::min(begin_m, whole_m), rises};
    }

    const RoadNetwork& roads_;
    std::map<std::string, LinearRoute> named_;
};

std::vector<SectionReference> references_of(const SectionOptions& options) {
    auto references = read_sections(options.along ? *options.along : *options.sections);
    if (options.along && references.front().line.empty()) {
        throw InputError{fmt::format("{}: is a table, expected a GPX track or a layer of lines",
                                     options.along->string())};
    }
    return references;
}

SegmentStates states_of(const StoreReader& store,
                        const std::vector<RouteSegment>& pieces,
                        const SegmentFilter& filter) {
    SegmentFilter on_road;
    on_road.ranges = ranges_of(pieces);
    on_road.period = filter.period;
    on_road.min_passes = filter.min_passes;
    on_road.min_vehicles = filter.min_vehicles;
    on_road.vehicle = filter.vehicle;
    SegmentStates states;
    store.visit(on_road, [&](const SegmentRecord& record) {
        states.emplace(record.segment.key, *record.state);
    });
    return states;
}

std::vector<ProfilePiece> profile_of(const std::vector<RouteSegment>& pieces,
                                     const SegmentStates& states) {
    std::vector<ProfilePiece> profile;
    for (const auto& piece : pieces) {
        const auto state = piece.segment ? states.find(*piece.segment) : states.end();
        if (state != states.end()) {
            profile.push_back({piece.from_m, piece.to_m, state->second.iri_um / 1000.0});
        }
    }
    return profile;
}

std::vector<RouteMeasureRange> cut(double whole_m,
                                   const std::vector<RouteSegment>& pieces,
                                   const SegmentStates& states,
                                   const SectionOptions& options) {
    if (options.homogeneous) {
        return homogeneous_sections(whole_m, profile_of(pieces, states));
    }
    return options.length_m ? even_sections(whole_m, *options.length_m)
                            : std::vector<RouteMeasureRange>{{0, whole_m}};
}

std::vector<RoadSection> sections_of(const StoreReader& store,
                                     const RoadNetwork& roads,
                                     const LinearRoute& road,
                                     const SectionOptions& options,
                                     const SegmentFilter& filter,
                                     const std::vector<Exclusion>& exclusions) {
    const auto pieces = pieces_of(roads, road);
    const auto states = states_of(store, pieces, filter);
    return measured_sections(roads,
                             road,
                             states,
                             cut(length_m(road), pieces, states, options),
                             excluded_ranges(roads, road, exclusions));
}

} // namespace

SectionTotal each_section(const StoreReader& store,
                          const SectionOptions& options,
                          const SegmentFilter& filter,
                          const std::function<void(const NamedSection&)>& take) {
    const auto exclusions = options.exclude
                                ? read_exclusions(*options.exclude, options.exclude_radius_m)
                                : std::vector<Exclusion>{};
    const auto roads = load_or_build_network(store);
    SectionTotal total;
    const auto report = [&](const AskedRoad& asked) {
        for (auto& section : sections_of(store, roads, asked.road, options, filter, exclusions)) {
            total.length_m += section.to_m - section.from_m;
            total.measured_m += section.measured.mean.length_m;
            total.excluded_m += section.excluded_m;
            const double sign = asked.rises ? 1 : -1;
            take({asked.name,
                  asked.begin_m + sign * section.from_m,
                  asked.begin_m + sign * section.to_m,
                  std::move(section)});
        }
    };
    if (options.route) {
        const auto& [from, to] = *options.route;
        report({"route", route_between(roads, from, to, {.best = options.best})});
        return total;
    }
    RoadFinder find{roads};
    for (const auto& reference : references_of(options)) {
        report(find(reference));
    }
    return total;
}

} // namespace macadam
