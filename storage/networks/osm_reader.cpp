#include "storage/networks/osm_reader.hpp"

#include "estimator/common/error.hpp"
#include "storage/networks/osm_objects.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <exception>
#include <iterator>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

namespace macadam {

namespace {

using NodeIds = std::vector<std::int64_t>;
using ProgressThrottle = std::function<void(std::uint64_t bytes)>;

NodeIds without_repeats(std::span<const std::int64_t> nodes) {
    NodeIds ids;
    ids.reserve(nodes.size());
    std::unique_copy(nodes.begin(), nodes.end(), std::back_inserter(ids));
    return ids;
}

/// Tests whether a way visits its own nodes again and again, as no road does: a few bytes could
/// need a huge amount of memory. Ways of OSM itself have at most 2,000 nodes.
bool runs_in_circles(NodeIds nodes) {
    constexpr std::size_t usual_nodes = 2000;
    constexpr std::size_t max_rounds = 4;
    if (nodes.size() <= usual_nodes) {
        return false;
    }
    const auto count = nodes.size();
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return count > max_rounds * nodes.size();
}

/// Nodes in the surroundings of a cut, in rising order.
NodeIds nodes_in(NetworkCut& cut, const std::filesystem::path& file, const ProgressThrottle& pace) {
    NodeIds ids;
    const auto take = [&](std::int64_t id, const PackedPoint& place) {
        if (cut.see(Unpacked{}(place))) {
            ids.push_back(id);
        }
    };
    visit_osm(file, {.node = take, .way = {}, .relation = {}, .pace = pace});
    std::sort(ids.begin(), ids.end());
    return ids;
}

/// Ways of a cut, which are recognised by their nodes.
struct WaysInCut {
    NetworkCut& cut;
    NodeIds nodes; ///< in rising order

    bool hold(std::span<const std::int64_t> way) const {
        cut.ways += way.size() < 2 ? 0 : 1;
        return std::any_of(way.begin(), way.end(), [&](std::int64_t id) {
            return std::binary_search(nodes.begin(), nodes.end(), id);
        });
    }
};

void note_closed(const OsmTags& tags, LeftOutWays& left_out) {
    constexpr std::size_t most = 8;
    const auto highway = value(tags, "highway");
    if (!highway.empty() && left_out.closed.size() < most) {
        left_out.closed.emplace(highway);
    }
}

/// Ways and turn rules of a file, without positions.
struct WaysAndTurns {
    std::vector<Way> ways; ///< drivable ways
    std::vector<TurnOutOfWay> turns;
};

std::string name_in(const OsmTags& tags, std::int64_t way) {
    constexpr std::size_t longest = 1024; // OSM has up to 255 characters
    const auto name = name_of(tags);
    if (name.size() > longest) {
        throw InputError{fmt::format(
            "the name of way '{}' has {} bytes, expected at most {}", way, name.size(), longest)};
    }
    return std::string{name};
}

WaysAndTurns ways_and_turns(const std::filesystem::path& file,
                            const ProgressThrottle& pace,
                            LeftOutWays& left_out,
                            const std::optional<WaysInCut>& wanted) {
    WaysAndTurns all;
    visit_osm(file,
              {.node = {},
               .way =
                   [&](std::int64_t id, const OsmTags& tags, std::span<const std::int64_t> nodes) {
                       if (!is_drivable(tags)) {
                           note_closed(tags, left_out);
                           return;
                       }
                       if (wanted && !wanted->hold(nodes)) {
                           return;
                       }
                       auto ids = without_repeats(nodes);
                       if (runs_in_circles(ids)) {
                           ++left_out.in_circles;
                           return;
                       }
                       all.ways.push_back({.id = id,
                                           .name = name_in(tags, id),
                                           .highway = tags("highway"),
                                           .oneway = oneway_of(tags),
                                           .node_ids = std::move(ids),
                                           .line = {},
                                           .speed_limit_cmps = speed_limit_cmps_of(tags),
                                           .turns = {}});
                   },
               .relation =
                   [&](const OsmTags& tags, std::span<const OsmMember> members) {
                       const auto found = turns_in(tags, members);
                       all.turns.insert(all.turns.end(), found.begin(), found.end());
                   },
               .pace = pace});
    return all;
}

NodeIds used_nodes(const std::vector<Way>& ways) {
    NodeIds ids;
    for (const auto& way : ways) {
        ids.insert(ids.end(), way.node_ids.begin(), way.node_ids.end());
    }
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    ids.shrink_to_fit();
    return ids;
}

/// Positions of the nodes `ids`, in rising order; `nowhere` if missing in the file.
std::vector<PackedPoint>
places_of(const NodeIds& ids, const std::filesystem::path& file, const ProgressThrottle& pace) {
    NodePositions positions{ids};
    const auto take = [&](std::int64_t id, const PackedPoint& at) { positions.see(id, at); };
    visit_osm(file, {.node = take, .way = {}, .relation = {}, .pace = pace});
    return std::move(positions).found();
}

/// Reduces `way` to its longest part, by points, with known positions.
Way placed(Way way, const NodeIds& ids, const std::vector<PackedPoint>& places) {
    NodeIds best_ids;
    std::vector<GeoPoint> best_line;
    NodeIds part_ids;
    std::vector<GeoPoint> part_line;
    const auto end_part = [&] {
        if (part_ids.size() > best_ids.size()) {
            best_ids = part_ids;
            best_line = part_line;
        }
        part_ids.clear();
        part_line.clear();
    };
    for (const auto id : way.node_ids) {
        const auto found = std::lower_bound(ids.begin(), ids.end(), id) - ids.begin();
        const auto& place = places[static_cast<std::size_t>(found)];
        if (place == NodePositions::nowhere) {
            end_part();
            continue;
        }
        part_ids.push_back(id);
        part_line.push_back(Unpacked{}(place));
    }
    end_part();
    way.node_ids = std::move(best_ids);
    way.line = std::move(best_line);
    return way;
}

std::vector<Way>
placed(std::vector<Way> ways, const NodeIds& ids, const std::vector<PackedPoint>& places) {
    for (auto& way : ways) {
        way = placed(std::move(way), ids, places);
    }
    std::erase_if(ways, [](const Way& way) { return way.line.size() < 2; });
    return ways;
}

/// Sorts ways by id and drops duplicates, which merged extracts may have at their borders.
std::vector<Way> in_order(std::vector<Way> ways) {
    const auto by_id = [](const Way& a, const Way& b) { return a.id < b.id; };
    const auto same_id = [](const Way& a, const Way& b) { return a.id == b.id; };
    std::stable_sort(ways.begin(), ways.end(), by_id);
    ways.erase(std::unique(ways.begin(), ways.end(), same_id), ways.end());
    return ways;
}

/// Assigns each turn rule to its way. \param ways  in the order of their ids
std::vector<Way> with_turns(std::vector<Way> ways, std::vector<TurnOutOfWay> turns) {
    std::sort(turns.begin(), turns.end(), [](const auto& a, const auto& b) {
        return std::tie(a.from_way, a.rule.via_node, a.rule.to_way, a.rule.only) <
               std::tie(b.from_way, b.rule.via_node, b.rule.to_way, b.rule.only);
    });
    for (const auto& turn : turns) {
        const auto way = std::lower_bound(ways.begin(),
                                          ways.end(),
                                          turn.from_way,
                                          [](const Way& a, std::int64_t id) { return a.id < id; });
        const bool known = way != ways.end() && way->id == turn.from_way;
        if (known && (way->turns.empty() || way->turns.back() != turn.rule)) {
            way->turns.push_back(turn.rule);
        }
    }
    return ways;
}

} // namespace

void visit_osm(const std::filesystem::path& file, const OsmVisitor& visitor) {
    (file.extension() == ".pbf" ? visit_osm_pbf : visit_osm_xml)(file, visitor);
}

void NodePositions::see(std::int64_t id, const PackedPoint& position) {
    // Most files have their nodes in order; then one step forward finds the next.
    if (id < last_) {
        at_ =
            static_cast<std::size_t>(std::lower_bound(ids_.begin(), ids_.end(), id) - ids_.begin());
    }
    last_ = id;
    while (at_ < ids_.size() && ids_[at_] < id) {
        ++at_;
    }
    if (at_ < ids_.size() && ids_[at_] == id) {
        positions_[at_] = position;
    }
}

bool is_osm_file(const std::filesystem::path& file) {
    static constexpr std::array<std::string_view, 5> suffixes{
        ".pbf", ".osm", ".osm.xml", ".osm.gz", ".osm.bz2"};
    const auto name = file.filename().string();
    return std::any_of(
        suffixes.begin(), suffixes.end(), [&](auto suffix) { return name.ends_with(suffix); });
}

std::vector<Way> read_osm(const std::filesystem::path& file,
                          const Progress& progress,
                          LeftOutWays& left_out,
                          NetworkCut* cut) {
    const auto bytes = std::filesystem::file_size(file);
    const std::size_t passes = cut == nullptr ? 2 : 3;
    const auto pace = [&](std::size_t pass) {
        return [&progress, bytes, passes, pass](std::uint64_t read) {
            progress(pass * bytes + read, passes * bytes);
            if (progress.stop.stop_requested()) {
                throw InputError{"reading was stopped"};
            }
        };
    };
    try {
        std::optional<WaysInCut> wanted;
        if (cut != nullptr) {
            wanted.emplace(WaysInCut{*cut, nodes_in(*cut, file, pace(0))});
        }
        auto all = ways_and_turns(file, pace(passes - 2), left_out, wanted);
        wanted.reset();
        const auto ids = used_nodes(all.ways);
        const auto places = places_of(ids, file, pace(passes - 1));
        const auto count = all.ways.size();
        auto ways = placed(std::move(all.ways), ids, places);
        left_out.without_places = count - ways.size();
        return with_turns(in_order(std::move(ways)), std::move(all.turns));
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw InputError{
            fmt::format("{}: cannot be read as an OSM map: {}", file.string(), error.what())};
    }
}

} // namespace macadam
