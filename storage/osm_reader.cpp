#include "storage/osm_reader.hpp"

#include "estimator/common/error.hpp"
#include "storage/osm_tags.hpp"
#include "storage/osm_turns.hpp"

#include <fmt/core.h>

#include <osmium/io/any_input.hpp>
#include <osmium/osm/relation.hpp>
#include <osmium/osm/way.hpp>

#include <algorithm>
#include <array>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

namespace macadam {

namespace {

using NodeIds = std::vector<std::int64_t>;

void pace(const osmium::io::Reader& reader, std::size_t pass, const Progress& progress) {
    constexpr std::size_t passes = 2;
    progress(pass * reader.file_size() + reader.offset(), passes * reader.file_size());
    if (progress.stop.stop_requested()) {
        throw InputError{"the reading was stopped"};
    }
}

NodeIds nodes_of(const osmium::Way& way) {
    NodeIds ids;
    for (const auto& node : way.nodes()) {
        if (ids.empty() || ids.back() != node.ref()) {
            ids.push_back(node.ref());
        }
    }
    return ids;
}

/// What a file says of ways, yet without places.
struct WaysAndTurns {
    std::vector<Way> ways; ///< the drivable ones
    std::vector<TurnOutOfWay> turns;
};

void add(std::vector<Way>& ways, const osmium::Way& way) {
    const OsmTags tags = [&](const char* key) { return way.tags()[key]; };
    if (!is_drivable(tags)) {
        return;
    }
    ways.push_back({.id = way.id(),
                    .name = std::string{name_of(tags)},
                    .highway = way.tags()["highway"],
                    .oneway = oneway_of(tags),
                    .node_ids = nodes_of(way),
                    .line = {},
                    .speed_limit_cmps = speed_limit_cmps_of(tags),
                    .turns = {}});
}

OsmKind kind_of(osmium::item_type type) {
    return type == osmium::item_type::node  ? OsmKind::node
           : type == osmium::item_type::way ? OsmKind::way
                                            : OsmKind::relation;
}

void add(std::vector<TurnOutOfWay>& turns, const osmium::Relation& relation) {
    const OsmTags tags = [&](const char* key) { return relation.tags()[key]; };
    std::vector<OsmMember> members;
    for (const auto& member : relation.members()) {
        members.push_back({kind_of(member.type()), member.ref(), member.role()});
    }
    const auto found = turns_in(tags, members);
    turns.insert(turns.end(), found.begin(), found.end());
}

WaysAndTurns ways_and_turns(const osmium::io::File& file, const Progress& progress) {
    osmium::io::Reader reader{file,
                              osmium::osm_entity_bits::way | osmium::osm_entity_bits::relation};
    WaysAndTurns all;
    while (const auto buffer = reader.read()) {
        for (const auto& way : buffer.select<osmium::Way>()) {
            add(all.ways, way);
        }
        for (const auto& relation : buffer.select<osmium::Relation>()) {
            add(all.turns, relation);
        }
        pace(reader, 0, progress);
    }
    reader.close();
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

/// Places of the nodes `ids`, which rise; an undefined place where the file has none.
std::vector<osmium::Location>
places_of(const NodeIds& ids, const osmium::io::File& file, const Progress& progress) {
    osmium::io::Reader reader{file, osmium::osm_entity_bits::node};
    std::vector<osmium::Location> places(ids.size());
    auto at = ids.begin();
    osmium::object_id_type last = 0;
    while (const auto buffer = reader.read()) {
        for (const auto& node : buffer.select<osmium::Node>()) {
            // Nearly every file has its nodes in order: then one step forward finds the next.
            if (node.id() < last) {
                at = std::lower_bound(ids.begin(), ids.end(), node.id());
            }
            last = node.id();
            while (at != ids.end() && *at < node.id()) {
                ++at;
            }
            if (at != ids.end() && *at == node.id()) {
                places[static_cast<std::size_t>(at - ids.begin())] = node.location();
            }
        }
        pace(reader, 1, progress);
    }
    reader.close();
    return places;
}

/// The longest part of `way`, by points, all of whose places are known.
Way placed(Way way, const NodeIds& ids, const std::vector<osmium::Location>& places) {
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
        if (!place.valid()) {
            end_part();
            continue;
        }
        part_ids.push_back(id);
        part_line.push_back({place.lat_without_check(), place.lon_without_check()});
    }
    end_part();
    way.node_ids = std::move(best_ids);
    way.line = std::move(best_line);
    return way;
}

std::vector<Way>
placed(std::vector<Way> ways, const NodeIds& ids, const std::vector<osmium::Location>& places) {
    for (auto& way : ways) {
        way = placed(std::move(way), ids, places);
    }
    std::erase_if(ways, [](const Way& way) { return way.line.size() < 2; });
    return ways;
}

/// Extracts that were put together may hold a way of their border twice.
std::vector<Way> in_order(std::vector<Way> ways) {
    const auto by_id = [](const Way& a, const Way& b) { return a.id < b.id; };
    const auto same_id = [](const Way& a, const Way& b) { return a.id == b.id; };
    std::stable_sort(ways.begin(), ways.end(), by_id);
    ways.erase(std::unique(ways.begin(), ways.end(), same_id), ways.end());
    return ways;
}

/// Gives each turn rule to its way. \param ways  in the order of their ids
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

bool is_osm_file(const std::filesystem::path& file) {
    static constexpr std::array<std::string_view, 5> suffixes{
        ".pbf", ".osm", ".osm.xml", ".osm.gz", ".osm.bz2"};
    const auto name = file.filename().string();
    return std::any_of(
        suffixes.begin(), suffixes.end(), [&](auto suffix) { return name.ends_with(suffix); });
}

std::vector<Way> read_osm(const std::filesystem::path& file, const Progress& progress) {
    try {
        // An absolute path, because libosmium takes "-" and "https:..." for something else.
        const osmium::io::File osm{std::filesystem::absolute(file).string()};
        auto all = ways_and_turns(osm, progress);
        const auto ids = used_nodes(all.ways);
        const auto places = places_of(ids, osm, progress);
        return with_turns(in_order(placed(std::move(all.ways), ids, places)), std::move(all.turns));
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw InputError{
            fmt::format("{}: cannot be read as an OSM map: {}", file.string(), error.what())};
    }
}

} // namespace macadam
