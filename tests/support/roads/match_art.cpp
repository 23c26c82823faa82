#include "match_art.hpp"
#include "estimator/motion/make_odometer.hpp"
#include "mapping/matching/arcs.hpp"

#include <cmath>

namespace macadam::testing {

MatchedTrace match(const TripLog& trip, const RoadArt& art, const MatchConfig& config) {
    const auto odometer = make_odometer(trip, {}).odometer;
    return map_match(trip, odometer, art.roads, config).trace;
}

std::string letters_of(const MatchedTrace& trace, const RoadArt& art) {
    std::string letters;
    const auto add = [&](char letter) {
        if (letters.empty() || letters.back() != letter) {
            letters += letter;
        }
    };
    MatchedTrace road;
    const auto flush = [&] {
        for (const auto& arc : arcs_of(road, art.roads)) {
            add(static_cast<char>(arc.from_node));
            add(static_cast<char>(arc.to_node));
        }
        road.clear();
    };
    for (const auto& piece : trace) {
        if (piece.kind == IntervalKind::road) {
            road.push_back(piece);
        } else {
            flush();
            add('-');
        }
    }
    flush();
    return letters;
}

GeoPoint place_at(const MatchedTrace& trace, const RoadArt& art, double travel_m) {
    for (const auto& piece : trace) {
        if (piece.kind == IntervalKind::road && piece.from_travel_m <= travel_m &&
            travel_m <= piece.to_travel_m) {
            const double share =
                (travel_m - piece.from_travel_m) / (piece.to_travel_m - piece.from_travel_m);
            return place_on(
                art.roads, piece.edge, std::lerp(piece.from_offset_m, piece.to_offset_m, share));
        }
    }
    return {std::nan(""), std::nan("")};
}

RoadArt ladder() {
    return road_art(R"(
        A---------B---------C
                  |
        D---------E---------F
    )",
                    20,
                    {"ABC", "DEF", "BE"});
}

} // namespace macadam::testing
