#include "render/labels/label_candidates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

// Cost of a label position, from barely noticeable to clearly disturbing.
constexpr double cost_of_cover = 4;
constexpr double cost_of_bend = 3;
constexpr double cost_of_distance = 0.6; // halfway to the next label
constexpr double cost_below = 0.08;      // names are usually above their road
constexpr double cost_of_position = 0.1; // around a point, from one to the next best
constexpr double cost_of_measured = 100; // of a place's name: only if no position is free

constexpr double max_place_covered = 0.6; // places lie in the densest streets

// In units of the em, for Noto Sans.
constexpr double capitals = 0.71;
constexpr double shield_pad = 0.3;
constexpr double shield_height = 1.35;

/// Returns the distance of a point from the area of a cluster's letters.
double distance_px(const PixelPoint& point, const ClusterPose& place, const TextLook& look) {
    const double x = point.x - place.from.x;
    const double y = point.y - place.from.y;
    const double along = x * place.along.x + y * place.along.y;
    const double up = x * place.along.y - y * place.along.x;
    const auto [low, high] = letter_extent(look);
    return std::hypot(std::max({0.0, -along, along - place.width_px}),
                      std::max({0.0, low - up, up - high}));
}

/// Returns the left ends of the baselines of a name on a point and around it, the best first, close
/// to it and then farther away.
std::vector<PixelPoint> ends_around(const PointName& place, const TextLook& look, double width_px) {
    const double cap_px = capitals * look.size_px;
    const auto& [x, y] = place.at;
    const double middle = x - width_px / 2;
    const double level = y + cap_px / 2;
    std::vector<PixelPoint> ends;
    if (place.symbol_px <= 0) {
        ends.push_back({middle, level});
    }
    for (const double gap : {0.3, 1.0, 1.8}) {
        const double gap_px = place.symbol_px + gap * look.size_px;
        const double right = x + gap_px;
        const double left = x - gap_px - width_px;
        const double above = y - gap_px / 2;
        const double below = y + gap_px / 2 + cap_px;
        for (const PixelPoint& end : {PixelPoint{right, above},
                                      {left, above},
                                      {left, below},
                                      {right, below},
                                      {right, level},
                                      {middle, y - gap_px},
                                      {left, level},
                                      {middle, y + gap_px + cap_px}}) {
            ends.push_back(end);
        }
    }
    return ends;
}

} // namespace

PixelBox shield_box(const ClusterPose& first, double text_px, const TextLook& look) {
    const double pad_px = shield_pad * look.size_px;
    const double middle = first.from.y - capitals * look.size_px / 2;
    const double half_px = shield_height * look.size_px / 2;
    return {
        first.from.x - pad_px, middle - half_px, first.from.x + text_px + pad_px, middle + half_px};
}

LabelCandidates::LabelCandidates(const LabelCell& cell,
                                 const LabelConfig& config,
                                 std::span<const NamedPart> parts)
    : cell_{0, 0, cell.box.width(), cell.box.height()}, config_{config},
      ground_{cell.box, parts, std::max(2.0, config.size_px / 6)}, cores_{junction_cores(parts)},
      cores_near_{8 * config.size_px} {
    std::erase_if(cores_,
                  [&](const JunctionCore& core) { return core.radius_px < config.min_core_px; });
    for (std::size_t i = 0; i < cores_.size(); ++i) {
        cores_near_.add(box_around({&cores_[i].middle, 1}, cores_[i].radius_px), i);
    }
    for (const auto& box : cell.kept_free) {
        kept_free_.push_back({box.left - cell.box.left,
                              box.top - cell.box.top,
                              box.right - cell.box.left,
                              box.bottom - cell.box.top});
    }
}

void LabelCandidates::visit(const LabelTask& task, double& limit, const Visitor& visitor) const {
    if (task.subject->kind == LabelSubject::Kind::place) {
        visit_around(*task.subject, visitor);
    } else {
        visit_along(task, limit, visitor);
    }
}

void LabelCandidates::visit_around(const LabelSubject& subject, const Visitor& visitor) const {
    const auto& place = *subject.place;
    double position_cost = 0;
    for (const auto& end : ends_around(place, subject.look, subject.line.width_px)) {
        auto found = upright(subject, end);
        found.middle = place.at;
        find_boxes(found, subject.look);
        const auto cover = covered(found, subject.look);
        const bool is_free = cover.measured <= 0;
        if (is_allowed(found) && cover.roads <= max_place_covered &&
            (is_free || place.may_cover_measured)) {
            found.cost =
                cost_of_cover * cover.roads + position_cost + (is_free ? 0 : cost_of_measured);
            visitor(std::move(found));
        }
        position_cost += cost_of_position;
    }
}

void LabelCandidates::visit_along(const LabelTask& task,
                                  double& limit,
                                  const Visitor& visitor) const {
    const double step_px = config_.size_px * 0.75;
    const auto& subject = *task.subject;
    const double half_px = subject.line.width_px / 2;
    for (int i = 0; i * step_px <= task.reach_px; ++i) {
        if (cost_of_distance * i * step_px / task.reach_px >= limit) {
            return;
        }
        for (const int side : {1, -1}) {
            if (i == 0 && side < 0) {
                continue;
            }
            const double middle_px = task.ideal_px + side * i * step_px;
            if (subject.kind == LabelSubject::Kind::road_number) {
                if (auto found = on_road(task, middle_px)) {
                    visitor(*std::move(found));
                }
                continue;
            }
            const bool forward =
                reads_forward(*subject.road, middle_px - half_px, middle_px + half_px);
            for (const auto& base : subject.base_lines) {
                if (base.forward != forward) {
                    continue;
                }
                if (auto found = beside_road(task, middle_px, base)) {
                    visitor(*std::move(found));
                }
            }
        }
    }
}

std::optional<LabelCandidate>
LabelCandidates::beside_road(const LabelTask& task, double middle_px, const BaseLine& base) const {
    const auto& subject = *task.subject;
    const double stretch = base.path.length_px() / subject.road->length_px();
    auto places = set_along(base.path, subject.line, middle_px * stretch, base.forward, config_);
    if (!places) {
        return {};
    }
    LabelCandidate found{.places = *std::move(places),
                         .boxes = {},
                         .box = {},
                         .middle = subject.road->at(middle_px),
                         .cost = 0};
    find_boxes(found, subject.look);
    if (!is_allowed(found) || is_on_core(found, subject.look)) {
        return {};
    }
    const double cover = covered(found, subject.look).roads;
    if (cover > config_.max_covered) {
        return {};
    }
    double bend = 0;
    const auto& first = found.places[0].along;
    for (const auto& [from, along, width_px] : found.places) {
        bend += 1 - (along.x * first.x + along.y * first.y);
    }
    found.cost = cost_of_cover * cover + cost_of_bend * bend / double(found.places.size()) +
                 cost_of_distance * std::abs(middle_px - task.ideal_px) / task.reach_px +
                 (base.side == LabelSide::below ? cost_below : 0);
    return found;
}

std::optional<LabelCandidate> LabelCandidates::on_road(const LabelTask& task,
                                                       double middle_px) const {
    const auto& subject = *task.subject;
    if (middle_px < 0 || middle_px > subject.road->length_px()) {
        return {};
    }
    const auto middle = subject.road->at(middle_px);
    auto found = upright(
        subject,
        {middle.x - subject.line.width_px / 2, middle.y + capitals * subject.look.size_px / 2});
    found.middle = middle;
    const double air_px = config_.halo_px;
    const auto frame = shield_box(found.places[0], subject.line.width_px, subject.look);
    found.box = {
        frame.left - air_px, frame.top - air_px, frame.right + air_px, frame.bottom + air_px};
    found.boxes = {found.box};
    if (!is_allowed(found) || is_on_core(found, subject.look)) {
        return {};
    }
    found.cost = cost_of_distance * std::abs(middle_px - task.ideal_px) / task.reach_px;
    return found;
}

LabelCandidate LabelCandidates::upright(const LabelSubject& subject,
                                        const PixelPoint& left_end) const {
    LabelCandidate found{.places = {}, .boxes = {}, .box = {}, .middle = {}, .cost = 0};
    // Whole pixels, for which the letters are hinted.
    const PixelPoint end{std::round(left_end.x), std::round(left_end.y)};
    for (const auto& cluster : subject.line.clusters) {
        found.places.push_back(
            {{end.x + cluster.left_px, end.y}, {1, 0}, cluster.right_px - cluster.left_px});
    }
    return found;
}

void LabelCandidates::find_boxes(LabelCandidate& candidate, const TextLook& look) const {
    for (const auto& place : candidate.places) {
        const auto box = box_around(corners_of(place, look), config_.halo_px + 1);
        candidate.box = candidate.boxes.empty() ? box : both(candidate.box, box);
        candidate.boxes.push_back(box);
    }
}

bool LabelCandidates::is_allowed(const LabelCandidate& candidate) const {
    const auto& box = candidate.box;
    if (box.left < 0 || box.top < 0 || box.right > cell_.right || box.bottom > cell_.bottom) {
        return false;
    }
    return std::ranges::none_of(kept_free_, [&](const PixelBox& free) {
        return overlap(box, free) && std::ranges::any_of(candidate.boxes, [&](const auto& own) {
                   return overlap(own, free);
               });
    });
}

bool LabelCandidates::is_on_core(const LabelCandidate& candidate, const TextLook& look) const {
    return cores_near_.any_near(candidate.box, [&](std::size_t core) {
        const auto& [middle, radius_px] = cores_[core];
        return std::ranges::any_of(candidate.places, [&](const ClusterPose& place) {
            return distance_px(middle, place, look) < radius_px;
        });
    });
}

LabelCandidates::Cover LabelCandidates::covered(const LabelCandidate& candidate,
                                                const TextLook& look) const {
    int all = 0;
    double road = 0;
    int measured = 0;
    for (const auto& place : candidate.places) {
        const auto corners = corners_of(place, look);
        for (const double x : {0.25, 0.75}) {
            for (const double y : {0.05, 0.35, 0.65, 0.95}) {
                const double top = 1 - y;
                const PixelPoint left{corners[0].x * top + corners[1].x * y,
                                      corners[0].y * top + corners[1].y * y};
                const PixelPoint right{corners[2].x * top + corners[3].x * y,
                                       corners[2].y * top + corners[3].y * y};
                ++all;
                const PixelPoint at{left.x * (1 - x) + right.x * x, left.y * (1 - x) + right.y * x};
                road += ground_.weight(at);
                measured += ground_.is_measured(at) ? 1 : 0;
            }
        }
    }
    return {road / std::max(1, all), double(measured) / std::max(1, all)};
}

} // namespace macadam
