#include "render/labels/label_path.hpp"

#include "estimator/common/angle.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

// In units of the em, for Noto Sans.
constexpr double capitals = 0.76; // with room for accents above capitals in many scripts
constexpr double descenders = 0.22;

double cosine_of_deg(double deg) {
    return std::cos(deg * rad_per_deg);
}

double dot(const PixelPoint& a, const PixelPoint& b) {
    return a.x * b.x + a.y * b.y;
}

/// Returns the unit vector between two points; `std::nullopt` if they coincide.
std::optional<PixelPoint> direction(const PixelPoint& from, const PixelPoint& to) {
    const double x = to.x - from.x;
    const double y = to.y - from.y;
    const double length = std::sqrt(x * x + y * y);
    if (!(length > 0)) {
        return {};
    }
    return PixelPoint{x / length, y / length};
}

/// Interval of a path in reading direction.
struct Reading {
    const LabelPath* path;
    double start_px;
    double sign; ///< -1: against the path

    PixelPoint at(double px) const { return path->at(start_px + sign * px); }
};

} // namespace

LabelPath::LabelPath(std::span<const PixelPoint> line) : line_{line.begin(), line.end()} {
    until_px_.push_back(0);
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        until_px_.push_back(until_px_.back() + macadam::length_px(line.subspan(i, 2)));
    }
}

PixelPoint LabelPath::at(double along_px) const {
    const auto next = std::ranges::upper_bound(until_px_, along_px);
    const auto i = std::size_t(
        std::clamp(next - until_px_.begin(), std::ptrdiff_t{1}, std::ptrdiff_t(line_.size()) - 1));
    const double piece_px = until_px_[i] - until_px_[i - 1];
    const double t =
        piece_px > 0 ? std::clamp((along_px - until_px_[i - 1]) / piece_px, 0.0, 1.0) : 0;
    const auto& a = line_[i - 1];
    const auto& b = line_[i];
    return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
}

bool reads_forward(const LabelPath& path, double from_px, double to_px) {
    const auto a = path.at(from_px);
    const auto b = path.at(to_px);
    return b.x != a.x ? b.x > a.x : b.y < a.y;
}

LabelPath base_line(const LabelPath& road, double left_px, double smooth_px) {
    const double length_px = road.length_px();
    const int steps = 1 + int(4 * length_px / smooth_px);
    std::vector<PixelPoint> line;
    PixelPoint along{1, 0};
    for (int i = 0; i <= steps; ++i) {
        const double here_px = length_px * i / steps;
        const double reach_px = std::min({smooth_px, here_px, length_px - here_px});
        const double min_px = smooth_px / 4; // at the ends, where no neighbourhood is left
        along = direction(road.at(here_px - std::max(reach_px, min_px)),
                          road.at(here_px + std::max(reach_px, min_px)))
                    .value_or(along);
        const auto a = road.at(here_px - reach_px);
        const auto b = road.at(here_px);
        const auto c = road.at(here_px + reach_px);
        line.push_back({(a.x + 2 * b.x + c.x) / 4 + along.y * left_px,
                        (a.y + 2 * b.y + c.y) / 4 - along.x * left_px});
    }
    return LabelPath{line};
}

double base_line_px(const TextLook& look,
                    double half_width_px,
                    const LabelConfig& config,
                    LabelSide side) {
    const double away_px = half_width_px + config.gap_px + config.halo_px;
    // Few letters have descenders, so these may come near the road.
    return side == LabelSide::above ? away_px + 0.5 * descenders * look.size_px
                                    : -away_px - capitals * look.size_px;
}

std::optional<std::vector<ClusterPose>> set_along(const LabelPath& base,
                                                  const SetLine& line,
                                                  double middle_px,
                                                  bool forward,
                                                  const LabelConfig& config) {
    const double from_px = middle_px - line.width_px / 2;
    const double to_px = middle_px + line.width_px / 2;
    if (from_px < 0 || to_px > base.length_px()) {
        return {};
    }
    const Reading reading{&base, forward ? from_px : to_px, forward ? 1.0 : -1.0};
    const auto whole = direction(reading.at(0), reading.at(line.width_px));
    if (!whole) {
        return {};
    }
    const double least_whole = cosine_of_deg(config.max_turn_deg);
    const double least_next = cosine_of_deg(config.max_bend_deg);
    std::vector<ClusterPose> places;
    places.reserve(line.clusters.size());
    for (const auto& cluster : line.clusters) {
        const auto a = reading.at(cluster.left_px);
        const auto b = reading.at(cluster.right_px);
        const auto own = direction(a, b);
        const auto along = own ? *own : places.empty() ? *whole : places.back().along;
        if (dot(along, *whole) < least_whole ||
            (!places.empty() && dot(along, places.back().along) < least_next)) {
            return {};
        }
        const double width_px = cluster.right_px - cluster.left_px;
        const PixelPoint middle{(a.x + b.x) / 2, (a.y + b.y) / 2};
        places.push_back({{middle.x - along.x * width_px / 2, middle.y - along.y * width_px / 2},
                          along,
                          width_px});
    }
    return places;
}

LetterExtent letter_extent(const TextLook& look) {
    return {-descenders * look.size_px, capitals * look.size_px};
}

std::vector<PixelPoint> corners_of(const ClusterPose& place, const TextLook& look) {
    const PixelPoint up{place.along.y * look.size_px, -place.along.x * look.size_px};
    const PixelPoint to{place.from.x + place.along.x * place.width_px,
                        place.from.y + place.along.y * place.width_px};
    std::vector<PixelPoint> corners;
    for (const auto& foot : {place.from, to}) {
        corners.push_back({foot.x + up.x * capitals, foot.y + up.y * capitals});
        corners.push_back({foot.x - up.x * descenders, foot.y - up.y * descenders});
    }
    return corners;
}

} // namespace macadam
