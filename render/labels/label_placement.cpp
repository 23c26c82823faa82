#include "render/labels/label_placement.hpp"

#include "render/labels/label_candidates.hpp"
#include "render/labels/label_lines.hpp"
#include "render/labels/label_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

namespace macadam {
namespace {

// Size of the names of ranks relative to those of tertiary roads.
constexpr std::array size_of_rank{1.15, 1.15, 1.08, 1.0, 0.92, 0.85};
constexpr double shield_size = 0.9; // likewise, of all ranks
constexpr double same_name = 0.8;   // of repeat_px: minimum distance between two labels of a name

constexpr std::size_t max_moved = 2;     // labels that make room for another
constexpr std::size_t max_attempts = 30; // positions for which others are moved

/// Places labels in their order of importance.
class Placing {
public:
    Placing(const LabelCell& cell, const LabelConfig& config, std::span<const NamedPart> parts)
        : cell_{&cell}, config_{&config}, candidates_{cell, config, parts}, near_{8 *
                                                                                  config.size_px} {}

    /// Places a label at the best position that is free. \returns whether there is one
    bool place(const LabelTask& task);

    /// Places a label where others can make room. \returns whether they can
    bool place_by_moving_others(const LabelTask& task);

    std::vector<Label> finished() const;

private:
    using Number = std::size_t;
    struct Placed {
        LabelTask task;
        LabelCandidate candidate;
    };

    std::optional<LabelCandidate> best_of(const LabelTask& task) const;
    bool is_near_its_name(const LabelCandidate& candidate, const std::string& name) const;
    std::vector<Number> others_at(const LabelCandidate& candidate) const;
    bool move_away(const std::vector<Number>& others);
    void put(Number number, LabelTask task, LabelCandidate candidate);
    void take_off(Number number);
    Label label_of(const Placed& placed) const;

    const LabelCell* cell_;
    const LabelConfig* config_;
    LabelCandidates candidates_;
    std::map<Number, Placed> placed_;
    Number next_ = 0;
    BoxGrid near_; ///< boxes of placed labels
    std::map<std::string, std::vector<Number>> of_name_;
};

std::optional<LabelCandidate> Placing::best_of(const LabelTask& task) const {
    std::optional<LabelCandidate> best;
    double limit = std::numeric_limits<double>::infinity();
    candidates_.visit(task, limit, [&](LabelCandidate&& found) {
        if (found.cost < limit && !is_near_its_name(found, task.subject->name) &&
            others_at(found).empty()) {
            limit = found.cost;
            best = std::move(found);
        }
    });
    return best;
}

bool Placing::is_near_its_name(const LabelCandidate& candidate, const std::string& name) const {
    const auto found = of_name_.find(name);
    if (found == of_name_.end()) {
        return false;
    }
    const double min_px = same_name * config_->repeat_px;
    return std::ranges::any_of(found->second, [&](Number number) {
        const auto& other = placed_.at(number).candidate.middle;
        const double x = other.x - candidate.middle.x;
        const double y = other.y - candidate.middle.y;
        return x * x + y * y < min_px * min_px;
    });
}

std::vector<Placing::Number> Placing::others_at(const LabelCandidate& candidate) const {
    std::vector<Number> others;
    const auto hits = [&](const PixelBox& other) {
        return std::ranges::any_of(candidate.boxes,
                                   [&](const auto& own) { return overlap(own, other); });
    };
    near_.any_near(candidate.box, [&](Number number) {
        const auto& other = placed_.at(number).candidate;
        if (overlap(candidate.box, other.box) && std::ranges::any_of(other.boxes, hits) &&
            std::ranges::find(others, number) == others.end()) {
            others.push_back(number);
        }
        return others.size() > max_moved;
    });
    return others;
}

bool Placing::place(const LabelTask& task) {
    auto best = best_of(task);
    if (best) {
        put(next_++, task, *std::move(best));
    }
    return best.has_value();
}

bool Placing::place_by_moving_others(const LabelTask& task) {
    std::vector<LabelCandidate> all;
    double limit = std::numeric_limits<double>::infinity();
    candidates_.visit(task, limit, [&](LabelCandidate&& found) {
        if (!is_near_its_name(found, task.subject->name) && others_at(found).size() <= max_moved) {
            all.push_back(std::move(found));
        }
    });
    std::ranges::stable_sort(all, {}, &LabelCandidate::cost);
    all.resize(std::min(all.size(), max_attempts));
    for (auto& candidate : all) {
        const auto others = others_at(candidate);
        if (std::ranges::any_of(others, [&](Number number) {
                return placed_.at(number).task.subject->kind == LabelSubject::Kind::place;
            })) {
            continue;
        }
        std::vector<Placed> before;
        for (const auto number : others) {
            before.push_back(placed_.at(number));
            take_off(number);
        }
        const auto own = next_++;
        put(own, task, std::move(candidate));
        std::vector<Number> moved;
        for (std::size_t i = 0; i < others.size(); ++i) {
            auto best = best_of(before[i].task);
            if (!best) {
                break;
            }
            put(others[i], before[i].task, *std::move(best));
            moved.push_back(others[i]);
        }
        if (moved.size() == others.size()) {
            return true;
        }
        take_off(own);
        std::ranges::for_each(moved, [&](Number number) { take_off(number); });
        for (std::size_t i = 0; i < others.size(); ++i) {
            put(others[i], before[i].task, std::move(before[i].candidate));
        }
    }
    return false;
}

void Placing::put(Number number, LabelTask task, LabelCandidate candidate) {
    near_.add(candidate.box, number);
    of_name_[task.subject->name].push_back(number);
    placed_.emplace(number, Placed{task, std::move(candidate)});
}

void Placing::take_off(Number number) {
    const auto found = placed_.find(number);
    near_.remove(found->second.candidate.box, number);
    std::erase(of_name_[found->second.task.subject->name], number);
    placed_.erase(found);
}

Label Placing::label_of(const Placed& placed) const {
    const auto& [task, candidate] = placed;
    const auto& subject = *task.subject;
    const auto& corner = cell_->box;
    const bool is_shield = subject.kind == LabelSubject::Kind::road_number;
    const auto box = is_shield
                         ? shield_box(candidate.places[0], subject.line.width_px, subject.look)
                         : candidate.box;
    Label label{.name = subject.name,
                .look = subject.look,
                .quiet = subject.quiet,
                .is_shield = is_shield,
                .halo_px = is_shield ? 0 : config_->halo_px,
                .left = int(std::lround(corner.left)),
                .top = int(std::lround(corner.top)),
                .glyphs = {},
                .box = {box.left + corner.left,
                        box.top + corner.top,
                        box.right + corner.left,
                        box.bottom + corner.top}};
    for (std::size_t i = 0; i < candidate.places.size(); ++i) {
        const auto& [from, along, width_px] = candidate.places[i];
        const auto& cluster = subject.line.clusters[i];
        for (std::size_t g = cluster.first; g < cluster.first + cluster.count; ++g) {
            const auto& glyph = subject.line.glyphs[g];
            const double right = glyph.x_px - cluster.left_px;
            label.glyphs.push_back({glyph,
                                    {from.x + along.x * right + along.y * glyph.y_px,
                                     from.y + along.y * right - along.x * glyph.y_px,
                                     along.x,
                                     along.y}});
        }
        const auto corners = corners_of(candidate.places[i], subject.look);
        LabelQuad letter{corners[0], corners[1], corners[3], corners[2]};
        for (auto& point : letter) {
            point = {point.x + corner.left, point.y + corner.top};
        }
        label.letters.push_back(letter);
    }
    return label;
}

std::vector<Label> Placing::finished() const {
    std::vector<Label> labels;
    labels.reserve(placed_.size());
    for (const auto& [number, placed] : placed_) {
        labels.push_back(label_of(placed));
    }
    return labels;
}

std::vector<BaseLine> base_lines_of(const LabelPath& road,
                                    const TextLook& look,
                                    double half_width_px,
                                    const LabelConfig& config) {
    std::vector<BaseLine> lines;
    for (const auto side : {LabelSide::above, LabelSide::below}) {
        const double upwards_px = base_line_px(look, half_width_px, config, side);
        for (const bool forward : {true, false}) {
            lines.push_back(
                {base_line(road, forward ? upwards_px : -upwards_px, look.size_px), side, forward});
        }
    }
    return lines;
}

/// Text of a road, if it may fit.
std::optional<LabelSubject>
road_subject(const NamedPart& road, bool is_number, const LabelConfig& config, TypeSetter& setter) {
    const double size = is_number ? shield_size : size_of_rank[std::size_t(road.rank)];
    const TextLook look{std::max(config.min_size_px, config.size_px * size), is_number};
    LabelPath path{road.line};
    if (path.length_px() < look.size_px) {
        return {};
    }
    auto line = setter.set(road.name, look);
    if (!line.whole || line.glyphs.empty() || line.width_px > path.length_px()) {
        return {};
    }
    auto base_lines =
        is_number ? std::vector<BaseLine>{} : base_lines_of(path, look, road.half_width_px, config);
    LabelSubject subject{.kind = is_number ? LabelSubject::Kind::road_number
                                           : LabelSubject::Kind::road_name,
                         .name = road.name,
                         .look = look,
                         .quiet = road.quiet,
                         .line = std::move(line)};
    subject.base_lines = std::move(base_lines);
    subject.road = std::move(path);
    return subject;
}

/// Adds the labels of roads, the important roads first; numbers before names.
///
/// \param numbered  the same roads with their numbers as names
void add_road_tasks(const std::vector<NamedPart>& parts,
                    const std::vector<NamedPart>& numbered,
                    const LabelConfig& config,
                    TypeSetter& setter,
                    std::deque<LabelSubject>& subjects,
                    std::vector<LabelTask>& tasks) {
    struct Road {
        NamedPart road;
        bool is_number;
    };
    std::vector<Road> roads;
    for (auto& road : named_chains(numbered)) {
        roads.push_back({std::move(road), true});
    }
    for (auto& road : named_chains(parts)) {
        const bool is_number = is_road_number(road.name);
        roads.push_back({std::move(road), is_number});
    }
    std::ranges::stable_sort(roads, {}, [](const Road& each) {
        const auto& road = each.road;
        return std::tuple{!each.is_number, road.quiet, road.rank, -length_px(road.line)};
    });
    for (const auto& [road, is_number] : roads) {
        auto subject = road_subject(road, is_number, config, setter);
        if (!subject) {
            continue;
        }
        subjects.push_back(*std::move(subject));
        const double length = subjects.back().road->length_px();
        const int count = std::max(1, int(length / config.repeat_px));
        for (int i = 0; i < count; ++i) {
            tasks.push_back({&subjects.back(), (i + 0.5) * length / count, length / count / 2});
        }
    }
}

/// Returns the parts of numbered roads, with their numbers as names.
std::vector<NamedPart> numbered_parts(std::span<const RoadName> roads, const LabelCell& cell) {
    std::vector<RoadName> numbered;
    for (const auto& road : roads) {
        if (!road.number.empty()) {
            numbered.push_back(road);
            numbered.back().name = road.number;
        }
    }
    return parts_in(numbered, cell.box);
}

} // namespace

bool is_road_number(std::string_view name) {
    constexpr std::size_t max_letters = 3;
    constexpr std::size_t max_figures = 4;
    const auto count = [&](std::size_t from, auto is_wanted) {
        const auto rest = name.substr(from);
        return std::size_t(std::ranges::find_if_not(rest, is_wanted) - rest.begin());
    };
    const auto is_capital = [](char c) { return 'A' <= c && c <= 'Z'; };
    std::size_t at = count(0, is_capital);
    if (at > max_letters) {
        return false;
    }
    if (at > 0 && at < name.size() && (name[at] == ' ' || name[at] == '-' || name[at] == '.')) {
        ++at;
    }
    const auto figures = count(at, [](char c) { return '0' <= c && c <= '9'; });
    at += figures;
    if (at < name.size() && (is_capital(name[at]) || ('a' <= name[at] && name[at] <= 'd'))) {
        ++at;
    }
    return 0 < figures && figures <= max_figures && at == name.size();
}

LabelCell label_cell_at(double x_px, double y_px) {
    const double left = std::floor(x_px / label_cell_px) * label_cell_px;
    const double top = std::floor(y_px / label_cell_px) * label_cell_px;
    return {{left, top, left + label_cell_px, top + label_cell_px}, {}};
}

std::vector<Label> placed_labels(std::span<const RoadName> roads,
                                 std::span<const PointName> places,
                                 const LabelCell& cell,
                                 const LabelConfig& config,
                                 TypeSetter& setter) {
    const auto parts = parts_in(roads, cell.box);
    std::deque<LabelSubject> subjects; // whose addresses stay
    std::vector<LabelTask> tasks;
    for (auto place : places) {
        place.at = {place.at.x - cell.box.left, place.at.y - cell.box.top};
        LabelSubject subject{.kind = LabelSubject::Kind::place,
                             .name = place.name,
                             .look = place.look,
                             .line = setter.set(place.name, place.look),
                             .place = place};
        if (subject.line.whole && !subject.line.glyphs.empty()) {
            subjects.push_back(std::move(subject));
            tasks.push_back({&subjects.back()});
        }
    }
    add_road_tasks(parts, numbered_parts(roads, cell), config, setter, subjects, tasks);
    Placing placing{cell, config, parts};
    std::vector<LabelTask> homeless;
    for (const auto& task : tasks) {
        if (!placing.place(task)) {
            homeless.push_back(task);
        }
    }
    if (config.moves_others) {
        for (const auto& task : homeless) {
            placing.place_by_moving_others(task);
        }
    }
    return placing.finished();
}

} // namespace macadam
