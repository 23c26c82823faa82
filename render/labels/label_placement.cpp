#include "render/labels/label_placement.hpp"

#include "render/labels/label_lines.hpp"
#include "render/labels/label_occupancy.hpp"
#include "render/labels/label_path.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace macadam {
namespace {

constexpr int last_main_rank = 2; // secondary roads
constexpr double main_size = 1.1; // size of their names relative to others
constexpr double same_name = 0.8; // of repeat_px: minimum distance between two labels of a name

// Cost of a label position, from barely noticeable to clearly disturbing.
constexpr double cost_of_cover = 4;
constexpr double cost_of_bend = 3;
constexpr double cost_of_distance = 0.6; // halfway to the next label
constexpr double cost_below = 0.08;      // names are usually above their road

struct Road {
    NamedPart part;
    LabelPath path;
};

/// Baseline of a road's names: on its left or right, read along it or against it.
struct BaseLine {
    LabelPath path;
    LabelSide side;
    bool forward;
};

/// Candidate position of a label.
struct Candidate {
    std::vector<ClusterPose> places;
    std::vector<PixelBox> boxes; ///< of its clusters, with halo
    PixelBox box;                ///< union of boxes
    PixelPoint middle;
    double cost;
};

PixelBox box_around(std::span<const PixelPoint> points, double margin_px) {
    PixelBox box{points[0].x, points[0].y, points[0].x, points[0].y};
    for (const auto& point : points) {
        box = {std::min(box.left, point.x),
               std::min(box.top, point.y),
               std::max(box.right, point.x),
               std::max(box.bottom, point.y)};
    }
    return {
        box.left - margin_px, box.top - margin_px, box.right + margin_px, box.bottom + margin_px};
}

PixelBox both(const PixelBox& a, const PixelBox& b) {
    return {std::min(a.left, b.left),
            std::min(a.top, b.top),
            std::max(a.right, b.right),
            std::max(a.bottom, b.bottom)};
}

bool overlap(const PixelBox& a, const PixelBox& b) {
    return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

std::vector<Road> roads_by_weight(const std::vector<NamedPart>& parts) {
    std::vector<Road> roads;
    for (auto& chain : named_chains(parts)) {
        LabelPath path{chain.line};
        roads.push_back({std::move(chain), std::move(path)});
    }
    std::ranges::stable_sort(roads, {}, [](const Road& road) {
        return std::tuple{road.part.quiet, road.part.rank, -road.path.length_px()};
    });
    return roads;
}

/// Places labels road by road; placed labels are not moved.
class Placing {
public:
    Placing(const LabelCell& cell,
            const LabelConfig& config,
            const std::vector<NamedPart>& parts,
            TypeSetter& setter)
        : cell_{&cell}, config_{&config}, setter_{&setter}, ground_{
                                                                cell.box,
                                                                parts,
                                                                std::max(2.0, config.size_px / 6)} {
        for (const auto& box : cell.kept_free) {
            kept_free_.push_back({box.left - cell.box.left,
                                  box.top - cell.box.top,
                                  box.right - cell.box.left,
                                  box.bottom - cell.box.top});
        }
    }

    void label(const Road& road);

    std::vector<Label> finished() && { return std::move(labels_); }

private:
    struct Task {
        const Road* road;
        const SetLine* line;
        const std::vector<BaseLine>* base_lines;
        TextLook look;
        double ideal_px; ///< best position of the label's middle, along the road
        double reach_px; ///< maximum distance from there
    };

    std::optional<Candidate> best_of(const Task& task) const;
    std::optional<Candidate>
    candidate(const Task& task, double middle_px, const BaseLine& base) const;
    std::vector<BaseLine> base_lines(const Road& road, const TextLook& look) const;
    bool has_room(const Candidate& candidate, const std::string& name) const;
    double covered(const Candidate& candidate, const TextLook& look) const;
    void take(const Task& task, Candidate candidate);

    const LabelCell* cell_;
    const LabelConfig* config_;
    TypeSetter* setter_;
    OccupancyGrid ground_;
    std::vector<PixelBox> kept_free_; ///< relative to the cell's corner
    std::vector<Label> labels_;
    std::vector<Candidate> taken_; ///< one per label
};

void Placing::label(const Road& road) {
    const TextLook look{road.part.rank <= last_main_rank ? config_->size_px * main_size
                                                         : config_->size_px};
    const double length_px = road.path.length_px();
    if (length_px < look.size_px) {
        return;
    }
    const auto line = setter_->set(road.part.name, look);
    if (!line.whole || line.glyphs.empty() || line.width_px > length_px) {
        return;
    }
    const auto bases = base_lines(road, look);
    const int count = std::max(1, int(length_px / config_->repeat_px));
    for (int i = 0; i < count; ++i) {
        const Task task{
            &road, &line, &bases, look, (i + 0.5) * length_px / count, length_px / count / 2};
        if (auto best = best_of(task)) {
            take(task, *std::move(best));
        }
    }
}

std::vector<BaseLine> Placing::base_lines(const Road& road, const TextLook& look) const {
    std::vector<BaseLine> lines;
    for (const auto side : {LabelSide::above, LabelSide::below}) {
        const double upwards_px = base_line_px(look, road.part.half_width_px, *config_, side);
        for (const bool forward : {true, false}) {
            lines.push_back({base_line(road.path, forward ? upwards_px : -upwards_px, look.size_px),
                             side,
                             forward});
        }
    }
    return lines;
}

std::optional<Candidate> Placing::best_of(const Task& task) const {
    const double step_px = config_->size_px * 0.75;
    std::optional<Candidate> best;
    for (int i = 0; i * step_px <= task.reach_px; ++i) {
        if (best && cost_of_distance * i * step_px / task.reach_px >= best->cost) {
            break;
        }
        for (const int side : {1, -1}) {
            if (i == 0 && side < 0) {
                continue;
            }
            const double middle_px = task.ideal_px + side * i * step_px;
            const double half_px = task.line->width_px / 2;
            const bool forward =
                reads_forward(task.road->path, middle_px - half_px, middle_px + half_px);
            for (const auto& base : *task.base_lines) {
                auto found =
                    base.forward == forward ? candidate(task, middle_px, base) : std::nullopt;
                if (found && (!best || found->cost < best->cost)) {
                    best = std::move(found);
                }
            }
        }
    }
    return best;
}

std::optional<Candidate>
Placing::candidate(const Task& task, double middle_px, const BaseLine& base) const {
    const double stretch = base.path.length_px() / task.road->path.length_px();
    auto places = set_along(base.path, *task.line, middle_px * stretch, base.forward, *config_);
    if (!places) {
        return {};
    }
    Candidate found{.places = *std::move(places),
                    .boxes = {},
                    .box = {},
                    .middle = task.road->path.at(middle_px),
                    .cost = 0};
    double bend = 0;
    for (std::size_t i = 0; i < found.places.size(); ++i) {
        const auto& place = found.places[i];
        found.boxes.push_back(box_around(corners_of(place, task.look), config_->halo_px + 1));
        found.box = i == 0 ? found.boxes[0] : both(found.box, found.boxes[i]);
        const auto& first = found.places[0].along;
        bend += 1 - (place.along.x * first.x + place.along.y * first.y);
    }
    if (!has_room(found, task.road->part.name)) {
        return {};
    }
    const double cover = covered(found, task.look);
    if (cover > config_->max_covered) {
        return {};
    }
    found.cost = cost_of_cover * cover + cost_of_bend * bend / double(found.places.size()) +
                 cost_of_distance * std::abs(middle_px - task.ideal_px) / task.reach_px +
                 (base.side == LabelSide::below ? cost_below : 0);
    return found;
}

bool Placing::has_room(const Candidate& candidate, const std::string& name) const {
    const auto& box = candidate.box;
    if (box.left < 0 || box.top < 0 || box.right > cell_->box.width() ||
        box.bottom > cell_->box.height()) {
        return false;
    }
    const auto hits = [&](const PixelBox& other) {
        return overlap(box, other) && std::ranges::any_of(candidate.boxes, [&](const auto& own) {
                   return overlap(own, other);
               });
    };
    if (std::ranges::any_of(kept_free_, hits)) {
        return false;
    }
    for (std::size_t i = 0; i < taken_.size(); ++i) {
        const double x = taken_[i].middle.x - candidate.middle.x;
        const double y = taken_[i].middle.y - candidate.middle.y;
        const double min_px = same_name * config_->repeat_px;
        if ((labels_[i].name == name && x * x + y * y < min_px * min_px) ||
            (overlap(box, taken_[i].box) && std::ranges::any_of(taken_[i].boxes, hits))) {
            return false;
        }
    }
    return true;
}

double Placing::covered(const Candidate& candidate, const TextLook& look) const {
    int all = 0;
    int road = 0;
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
                road += ground_.has_road(
                            {left.x * (1 - x) + right.x * x, left.y * (1 - x) + right.y * x})
                            ? 1
                            : 0;
            }
        }
    }
    return double(road) / std::max(1, all);
}

void Placing::take(const Task& task, Candidate candidate) {
    const auto& corner = cell_->box;
    Label label{.name = task.road->part.name,
                .look = task.look,
                .quiet = task.road->part.quiet,
                .halo_px = config_->halo_px,
                .left = int(std::lround(corner.left)),
                .top = int(std::lround(corner.top)),
                .glyphs = {},
                .box = {candidate.box.left + corner.left,
                        candidate.box.top + corner.top,
                        candidate.box.right + corner.left,
                        candidate.box.bottom + corner.top}};
    for (std::size_t i = 0; i < candidate.places.size(); ++i) {
        const auto& [from, along, width_px] = candidate.places[i];
        const auto& cluster = task.line->clusters[i];
        for (std::size_t g = cluster.first; g < cluster.first + cluster.count; ++g) {
            const auto& glyph = task.line->glyphs[g];
            const double right = glyph.x_px - cluster.left_px;
            label.glyphs.push_back({glyph,
                                    {from.x + along.x * right + along.y * glyph.y_px,
                                     from.y + along.y * right - along.x * glyph.y_px,
                                     along.x,
                                     along.y}});
        }
    }
    labels_.push_back(std::move(label));
    taken_.push_back(std::move(candidate));
}

} // namespace

LabelCell label_cell_at(double x_px, double y_px) {
    const double left = std::floor(x_px / label_cell_px) * label_cell_px;
    const double top = std::floor(y_px / label_cell_px) * label_cell_px;
    return {{left, top, left + label_cell_px, top + label_cell_px}, {}};
}

std::vector<Label> placed_labels(std::span<const RoadName> roads,
                                 const LabelCell& cell,
                                 const LabelConfig& config,
                                 TypeSetter& setter) {
    const auto parts = parts_in(roads, cell.box);
    Placing placing{cell, config, parts, setter};
    for (const auto& road : roads_by_weight(parts)) {
        placing.label(road);
    }
    return std::move(placing).finished();
}

} // namespace macadam
