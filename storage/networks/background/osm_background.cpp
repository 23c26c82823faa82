#include "storage/networks/background/osm_background.hpp"

#include "estimator/common/error.hpp"
#include "storage/networks/background/area_assembly.hpp"
#include "storage/networks/background/osm_background_tags.hpp"
#include "storage/networks/background/sea_assembly.hpp"
#include "storage/networks/osm_objects.hpp"
#include "storage/networks/osm_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {
namespace {

constexpr std::size_t max_area_points = 50'000; // twice the shore of the largest lakes in OSM
constexpr std::size_t max_text_bytes = 255;
constexpr std::size_t max_coast_points = 8'000'000; // those of Norway are half of these

/// Multipolygon of a kind that is shown.
struct Relation {
    BackgroundKind kind;
    std::vector<std::int64_t> ways;
};

/// Way that is a line or an area by itself, a part of multipolygons, a coastline, or several.
struct ShownWay {
    std::int64_t id;
    std::optional<BackgroundKind> kind;
    bool is_part; ///< of a multipolygon
    bool is_coast;
    std::vector<std::int64_t> nodes;
};

bool is_short_text(std::string_view text) {
    return !text.empty() && text.size() <= max_text_bytes;
}

bool meet(const std::vector<PackedPoint>& points, const GeoBox& box) {
    GeoBox around;
    for (const auto& point : points) {
        around = including(around, Unpacked{}(point));
    }
    return around.west_deg <= box.east_deg && around.east_deg >= box.west_deg &&
           around.south_deg <= box.north_deg && around.north_deg >= box.south_deg;
}

class BackgroundReader {
public:
    BackgroundReader(const std::filesystem::path& file,
                     const GeoBox& box,
                     const BackgroundSink& sink,
                     const Progress& progress,
                     std::size_t max_points)
        : file_{file}, box_{box}, sink_{sink}, progress_{progress},
          max_points_{max_points}, bytes_{std::filesystem::file_size(file)} {}

    LeftOutAreas read() {
        read_relations();
        // Multipolygons need all of their ways at a time; the ways by themselves come in turn.
        for (bool first = true; first || !is_last_; first = false) {
            read_ways();
            read_positions(first);
            give_lines_and_areas();
            give_multipolygons();
            if (first) {
                give_sea();
            }
        }
        return left_out_;
    }

private:
    /// Reads the file once more.
    void visit(OsmVisitor visitor) {
        visitor.pace = [this, pass = passes_++](std::uint64_t read) {
            constexpr std::size_t usual_passes = 3;
            progress_(pass * bytes_ + read, std::max(usual_passes, passes_) * bytes_);
            if (progress_.stop.stop_requested()) {
                throw InputError{"reading was stopped"};
            }
        };
        visit_osm(file_, visitor);
    }

    void read_relations() {
        visit({.node = {},
               .way = {},
               .relation =
                   [&](const OsmTags& tags, std::span<const OsmMember> members) {
                       const auto kind = area_kind_of(tags);
                       if (!kind || !is_multipolygon(tags)) {
                           return;
                       }
                       Relation relation{*kind, {}};
                       for (const auto& member : members) {
                           if (member.kind == OsmKind::way) {
                               relation.ways.push_back(member.id);
                               parts_.push_back(member.id);
                           }
                       }
                       relations_.push_back(std::move(relation));
                   },
               .pace = {}});
        std::sort(parts_.begin(), parts_.end());
        parts_.erase(std::unique(parts_.begin(), parts_.end()), parts_.end());
    }

    /// Kind of a way by itself. One that is closed is an area, unless it is tagged as a line alone.
    static std::optional<BackgroundKind> kind_of(const OsmTags& tags,
                                                 std::span<const std::int64_t> nodes) {
        constexpr std::size_t corners_and_end = 4;
        if (nodes.size() >= corners_and_end && nodes.front() == nodes.back()) {
            if (const auto kind = area_kind_of(tags)) {
                return kind;
            }
        }
        return nodes.size() < 2 ? std::nullopt : line_kind_of(tags);
    }

    /// Reads the next ways of the file, in the first round with all parts of multipolygons.
    void read_ways() {
        ways_.clear();
        is_last_ = true;
        std::size_t points = 0;
        std::size_t number = 0;
        const bool first = done_ == 0;
        visit({.node = {},
               .way =
                   [&](std::int64_t id, const OsmTags& tags, std::span<const std::int64_t> nodes) {
                       auto kind = kind_of(tags, nodes);
                       if (kind && ++number <= done_) {
                           kind.reset();
                       } else if (kind && points > max_points_) {
                           is_last_ = false;
                           kind.reset();
                       } else if (kind) {
                           points += nodes.size();
                           next_ = number;
                       }
                       const bool is_part =
                           first && std::binary_search(parts_.begin(), parts_.end(), id);
                       const bool is_coast = first && is_coastline(tags) && nodes.size() > 1;
                       coast_points_ += is_coast ? nodes.size() : 0;
                       if (first) {
                           give_road_ref(id, tags);
                       }
                       if ((kind || is_part) && nodes.size() > max_area_points) {
                           ++left_out_.too_long;
                       } else if (kind || is_part ||
                                  (is_coast && coast_points_ <= max_coast_points)) {
                           ways_.push_back(
                               {id, kind, is_part, is_coast, {nodes.begin(), nodes.end()}});
                       }
                   },
               .relation = {},
               .pace = {}});
        done_ = std::max(next_, std::size_t{1});
        const auto by_id = [](const ShownWay& a, const ShownWay& b) { return a.id < b.id; };
        const auto same_id = [](const ShownWay& a, const ShownWay& b) { return a.id == b.id; };
        std::stable_sort(ways_.begin(), ways_.end(), by_id);
        ways_.erase(std::unique(ways_.begin(), ways_.end(), same_id), ways_.end());
    }

    void give_road_ref(std::int64_t id, const OsmTags& tags) const {
        const auto ref = value(tags, "ref");
        if (is_short_text(ref) && is_drivable(tags)) {
            sink_.road_ref({id, std::string{ref}});
        }
    }

    void read_positions(bool with_places) {
        nodes_.clear();
        for (const auto& way : ways_) {
            nodes_.insert(nodes_.end(), way.nodes.begin(), way.nodes.end());
        }
        std::sort(nodes_.begin(), nodes_.end());
        nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
        NodePositions positions{nodes_};
        OsmVisitor visitor{
            .node = [&](std::int64_t id, const PackedPoint& at) { positions.see(id, at); },
            .way = {},
            .relation = {},
            .pace = {}};
        if (with_places) {
            visitor.bounds = [&](const GeoBox& box) { bounds_ = box; };
            visitor.node = [&](std::int64_t id, const PackedPoint& at) {
                positions.see(id, at);
                around_nodes_ = including(around_nodes_, Unpacked{}(at));
            };
            visitor.tagged_node = [&](const OsmTags& tags, const PackedPoint& at) {
                give_place(tags, at);
            };
        }
        visit(std::move(visitor));
        positions_ = std::move(positions).found();
    }

    void give_place(const OsmTags& tags, const PackedPoint& at) const {
        const auto rank = place_rank_of(tags);
        const auto name = value(tags, "name");
        const auto position = Unpacked{}(at);
        if (rank && is_short_text(name) && contains(box_, position)) {
            sink_.place({std::string{name}, *rank, position, population_of(tags)});
        }
    }

    PackedPoint position_of(std::int64_t node) const {
        const auto at = std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin();
        return positions_[static_cast<std::size_t>(at)];
    }

    /// Way with the positions of its nodes; `std::nullopt` if one is missing.
    std::optional<PlacedWay> placed(const ShownWay& way) const {
        PlacedWay found{way.id, way.nodes, {}};
        found.points.reserve(way.nodes.size());
        for (const auto node : way.nodes) {
            const auto position = position_of(node);
            if (position == NodePositions::nowhere) {
                return std::nullopt;
            }
            found.points.push_back(position);
        }
        return found;
    }

    void give_area(BackgroundKind kind, std::span<const PlacedWay* const> ways) {
        const bool is_valid = assemble_area(ways, [&](std::vector<std::vector<PackedPoint>> rings) {
            if (meet(rings.front(), box_)) {
                sink_.feature({kind, std::move(rings)});
            }
        });
        left_out_.not_closed += is_valid ? 0 : 1;
    }

    /// Counts a ring of one way. \returns false if the file has too many rings longer than ways of
    /// OpenStreetMap are (2000 nodes): each may cost the square of its nodes, as pairs of its sides
    /// may cross.
    bool has_room_for_ring(std::size_t nodes) {
        constexpr std::size_t usual_nodes = 5'000;
        constexpr double most_pairs = 2e10;
        if (nodes > usual_nodes) {
            pairs_of_long_rings_ += static_cast<double>(nodes) * static_cast<double>(nodes);
        }
        return nodes <= usual_nodes || pairs_of_long_rings_ <= most_pairs;
    }

    void give_lines_and_areas() {
        for (const auto& way : ways_) {
            if (!way.kind) {
                continue;
            }
            auto line = placed(way);
            if (!line) {
                ++left_out_.not_closed;
            } else if (!is_line_kind(*way.kind) && !has_room_for_ring(way.nodes.size())) {
                ++left_out_.too_long;
            } else if (!is_line_kind(*way.kind)) {
                const PlacedWay* const ring = &*line;
                give_area(*way.kind, {&ring, 1});
            } else if (meet(line->points, box_)) {
                BackgroundFeature feature{*way.kind, {}};
                feature.paths.push_back(std::move(line->points));
                sink_.feature(feature);
            }
        }
    }

    void give_multipolygons() {
        for (const auto& relation : std::exchange(relations_, {})) {
            give_multipolygon(relation);
        }
        parts_.clear();
    }

    void give_multipolygon(const Relation& relation) {
        std::vector<PlacedWay> ways;
        std::size_t points = 0;
        for (const auto id : relation.ways) {
            const auto way = std::lower_bound(
                ways_.begin(), ways_.end(), id, [](const ShownWay& a, std::int64_t sought) {
                    return a.id < sought;
                });
            const bool is_there = way != ways_.end() && way->id == id && way->is_part;
            points += is_there ? way->nodes.size() : 0;
            auto line = is_there && points <= max_area_points ? placed(*way) : std::nullopt;
            if (!line) {
                ++(points > max_area_points ? left_out_.too_long : left_out_.not_closed);
                return;
            }
            ways.push_back(std::move(*line));
        }
        // A file of a few bytes can name the same ways again and again.
        constexpr std::size_t free_points = 1'000'000;
        constexpr std::size_t rounds = 16;
        points_assembled_ += points;
        if (points_assembled_ > free_points + rounds * nodes_.size()) {
            ++left_out_.too_long;
            return;
        }
        std::vector<const PlacedWay*> parts;
        for (const auto& way : ways) {
            parts.push_back(&way);
        }
        give_area(relation.kind, parts);
    }

    /// Gives the sea within the bounds that the file states, or else around its nodes.
    void give_sea() {
        std::vector<PlacedWay> coast;
        for (const auto& way : ways_) {
            if (way.is_coast) {
                auto& line = coast.emplace_back(PlacedWay{way.id, way.nodes, {}});
                std::ranges::transform(way.nodes,
                                       std::back_inserter(line.points),
                                       [&](std::int64_t node) { return position_of(node); });
            }
        }
        if (coast_points_ > max_coast_points) {
            left_out_.has_broken_coast = true;
            return;
        }
        constexpr double margin_m = 3000; // to the edge of the outermost tiles
        const auto room = grown(box_, margin_m);
        const auto bounds = bounds_.value_or(around_nodes_);
        auto sea = assemble_sea(coast,
                                {std::max(bounds.west_deg, room.west_deg),
                                 std::max(bounds.south_deg, room.south_deg),
                                 std::min(bounds.east_deg, room.east_deg),
                                 std::min(bounds.north_deg, room.north_deg)},
                                room);
        left_out_.has_broken_coast = sea.is_broken;
        for (auto& rings : sea.areas) {
            sink_.feature({BackgroundKind::water, std::move(rings)});
        }
    }

    const std::filesystem::path& file_;
    const GeoBox& box_;
    const BackgroundSink& sink_;
    const Progress& progress_;
    std::size_t max_points_;
    std::uint64_t bytes_;
    std::size_t passes_ = 0; ///< over the file, begun
    LeftOutAreas left_out_;

    std::vector<Relation> relations_;
    std::vector<std::int64_t> parts_; ///< ids of the ways of multipolygons, rising
    std::size_t points_assembled_ = 0;
    double pairs_of_long_rings_ = 0; ///< of nodes, in rings of one way
    std::size_t coast_points_ = 0;
    std::optional<GeoBox> bounds_; ///< that the file states
    GeoBox around_nodes_;

    // Ways of the current round.
    std::size_t done_ = 0; ///< ways with a kind of all rounds before
    std::size_t next_ = 0;
    bool is_last_ = true;
    std::vector<ShownWay> ways_;         ///< by id
    std::vector<std::int64_t> nodes_;    ///< of the ways, rising
    std::vector<PackedPoint> positions_; ///< one for each node
};

} // namespace

LeftOutAreas read_osm_background(const std::filesystem::path& file,
                                 const GeoBox& box,
                                 const BackgroundSink& sink,
                                 const Progress& progress,
                                 std::size_t max_points) {
    try {
        return BackgroundReader{file, box, sink, progress, max_points}.read();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw InputError{
            fmt::format("{}: its background cannot be read: {}", file.string(), error.what())};
    }
}

} // namespace macadam
