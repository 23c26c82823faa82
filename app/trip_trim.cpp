#include "app/trip_trim.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace macadam {
namespace {

constexpr double rounding_m = 1e-6; // a cut at a border of segments is at it

bool is_empty(const TravelSpan& told) {
    return told.from_m >= told.to_m;
}

double share(double value, double from, double to) {
    return to > from ? (value - from) / (to - from) : 0;
}

/// The part of a piece between two places of its travel.
MatchedPiece between_travel(const MatchedPiece& piece, double from_m, double to_m) {
    const double first = share(from_m, piece.from_travel_m, piece.to_travel_m);
    const double last = share(to_m, piece.from_travel_m, piece.to_travel_m);
    auto part = piece;
    part.from_travel_m = from_m;
    part.to_travel_m = to_m;
    part.from_offset_m = std::lerp(piece.from_offset_m, piece.to_offset_m, first);
    part.to_offset_m = std::lerp(piece.from_offset_m, piece.to_offset_m, last);
    part.t_enter_s = std::lerp(piece.t_enter_s, piece.t_leave_s, first);
    part.t_leave_s = std::lerp(piece.t_enter_s, piece.t_leave_s, last);
    return part;
}

/// The same between two offsets along its edge.
MatchedPiece between_offsets(const MatchedPiece& piece, double from_m, double to_m) {
    const auto travel_at = [&](double offset_m) {
        return std::lerp(piece.from_travel_m,
                         piece.to_travel_m,
                         share(offset_m, piece.from_offset_m, piece.to_offset_m));
    };
    return between_travel(piece, travel_at(from_m), travel_at(to_m));
}

double segment_m(const MatchedPiece& piece, const RoadNetwork& roads) {
    const auto link = link_at(roads, piece.edge);
    return (link.to_m - link.from_m) / link.segments;
}

/// A trace from one place of its travel on, without the rest of the segment in which that lies.
MatchedTrace cut_before(const MatchedTrace& matched, double from_m, const RoadNetwork& roads) {
    MatchedTrace rest;
    const MatchedPiece* cut = nullptr; // the piece that was cut, while its segment lasts
    double border_m = 0;               // of that segment, along the edge
    for (const auto& piece : matched) {
        if (piece.to_travel_m <= from_m) {
            continue;
        }
        if (piece.from_travel_m < from_m && piece.kind == PieceKind::road) {
            const double length_m = segment_m(piece, roads);
            const auto part = between_travel(piece, from_m, piece.to_travel_m);
            cut = &piece;
            border_m = std::ceil(part.from_offset_m / length_m - rounding_m) * length_m;
        }
        const bool goes_on = cut != nullptr && piece.edge == cut->edge &&
                             piece.kind == PieceKind::road && piece.from_offset_m < border_m;
        if (!goes_on) {
            cut = nullptr;
            rest.push_back(
                between_travel(piece, std::max(from_m, piece.from_travel_m), piece.to_travel_m));
        } else if (piece.to_offset_m > border_m) {
            rest.push_back(between_offsets(piece, border_m, piece.to_offset_m));
            cut = nullptr;
        }
    }
    return rest;
}

/// The same trace driven backward, as far as cutting needs it: travel and offsets change sign.
MatchedTrace backward(MatchedTrace matched) {
    std::ranges::reverse(matched);
    for (auto& piece : matched) {
        piece.from_travel_m = -std::exchange(piece.to_travel_m, -piece.from_travel_m);
        piece.from_offset_m = -std::exchange(piece.to_offset_m, -piece.from_offset_m);
        std::swap(piece.t_enter_s, piece.t_leave_s);
    }
    return matched;
}

std::vector<std::uint8_t> trimmed(std::vector<std::uint8_t> use,
                                  const std::vector<double>& t_s,
                                  double latency_s,
                                  const Odometer& odometer,
                                  double trim_m) {
    const auto told = told_part(odometer, trim_m);
    const double from_s = odometer.t_s(told.from_m);
    const double to_s = odometer.t_s(told.to_m);
    for (std::size_t i = 0; trim_m > 0 && i < use.size(); ++i) {
        const double at_s = t_s[i] - latency_s;
        if (is_empty(told) || at_s < from_s || at_s > to_s) {
            use[i] = static_cast<std::uint8_t>(RowReason::trimmed);
        }
    }
    return use;
}

} // namespace

TravelSpan told_part(const Odometer& odometer, double trim_m) {
    return {trim_m, odometer.whole_m() - trim_m};
}

MatchedTrace trimmed(MatchedTrace matched, const TravelSpan& told, const RoadNetwork& roads) {
    if (is_empty(told)) {
        return {};
    }
    matched = cut_before(matched, told.from_m, roads);
    return backward(cut_before(backward(std::move(matched)), -told.to_m, roads));
}

TripUse without_vibration_outside(TripUse use,
                                  const TripLog& trip,
                                  const Odometer& odometer,
                                  double trim_m) {
    use.acc = trimmed(std::move(use.acc), trip.acc.t_s, 0, odometer, trim_m);
    use.gyro = trimmed(std::move(use.gyro), trip.gyro.t_s, 0, odometer, trim_m);
    return use;
}

TripUse
without_places_outside(TripUse use, const TripLog& trip, const Odometer& odometer, double trim_m) {
    std::vector<double> fixes_s(trip.fixes.size());
    std::ranges::transform(trip.fixes, fixes_s.begin(), &GnssFix::t_s);
    use.speed =
        trimmed(std::move(use.speed), trip.speed.t_s, trip.meta.speed_latency_s, odometer, trim_m);
    use.fixes = trimmed(std::move(use.fixes), fixes_s, trip.meta.gnss_latency_s, odometer, trim_m);
    return use;
}

std::string spoken_trim(const TravelSpan& told, double trim_m) {
    if (is_empty(told)) {
        return fmt::format("goes {:.0f} m, which is all within {:g} m of its ends: no pass",
                           told.to_m + trim_m,
                           trim_m);
    }
    return fmt::format("the first and the last {:g} m were left out", trim_m);
}

} // namespace macadam
