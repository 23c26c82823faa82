#include "storage/networks/osm_writer.hpp"

#include "estimator/common/error.hpp"
#include "storage/atomic/atomic_file_set.hpp"
#include "storage/networks/osm_tags.hpp"

#include <fmt/core.h>

#include <osmium/builder/attr.hpp>
#include <osmium/io/header.hpp>
#include <osmium/io/pbf_output.hpp>
#include <osmium/io/writer.hpp>
#include <osmium/memory/buffer.hpp>

#include <cmath>
#include <cstdint>
#include <exception>
#include <map>
#include <new>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {
namespace {

using namespace osmium::builder::attr; // NOLINT(google-build-using-namespace): names of attributes

constexpr std::size_t buffer_bytes = std::size_t{1} << 20;

osmium::Location location_of(const GeoPoint& place) {
    return osmium::Location{place.lon_deg, place.lat_deg};
}

std::map<std::int64_t, osmium::Location> nodes_of(std::span<const Way> ways) {
    std::map<std::int64_t, osmium::Location> nodes;
    for (const auto& way : ways) {
        for (std::size_t i = 0; i < way.node_ids.size(); ++i) {
            const auto location = location_of(way.line[i]);
            const auto [at, fresh] = nodes.emplace(way.node_ids[i], location);
            if (!fresh && at->second != location) {
                throw InputError{
                    fmt::format("node '{}' of way '{}' has two positions, expected one",
                                way.node_ids[i],
                                way.id)};
            }
        }
    }
    return nodes;
}

/// Checks that libosmium accepts a text as a tag: 256 characters of up to 4 bytes.
void expect_short(const std::string& text, std::string_view what, std::int64_t way) {
    constexpr std::size_t max_bytes = 1024;
    if (text.size() > max_bytes) {
        throw InputError{fmt::format("the {} of way '{}' has {} bytes, expected at most {}",
                                     what,
                                     way,
                                     text.size(),
                                     max_bytes)};
    }
}

/// Class of the way, if OSM readers accept it as a road for cars.
std::string class_of(const Way& way) {
    const OsmTags tags = [&](std::string_view key) -> const char* {
        return key == "highway" ? way.highway.c_str() : key == "tracktype" ? "grade1" : nullptr;
    };
    return is_drivable(tags) ? way.highway : "road";
}

/// Speed in km/h as on signs, or with as many digits as the centimetres need.
std::string kmh_text(std::uint16_t speed_cmps) {
    constexpr double kmh_per_cmps = 0.036;
    const double kmh = speed_cmps * kmh_per_cmps;
    const double whole_kmh = std::round(kmh);
    return std::lround(whole_kmh / kmh_per_cmps) == speed_cmps ? fmt::format("{:.0f}", whole_kmh)
                                                               : fmt::format("{:.2f}", kmh);
}

std::vector<std::pair<std::string, std::string>> tags_of(const Way& way) {
    std::vector<std::pair<std::string, std::string>> tags;
    tags.emplace_back("highway", class_of(way));
    if (way.highway == "track") {
        tags.emplace_back("tracktype", "grade1"); // only such tracks are read
    }
    if (!way.name.empty()) {
        tags.emplace_back("name", way.name);
    }
    if (way.speed_limit_cmps > 0) {
        tags.emplace_back("maxspeed", kmh_text(way.speed_limit_cmps));
    }
    // Written for every way, because some classes are oneway by default.
    tags.emplace_back("oneway",
                      way.oneway == Oneway::no        ? "no"
                      : way.oneway == Oneway::forward ? "yes"
                                                      : "-1");
    return tags;
}

void add_way(osmium::memory::Buffer& buffer, const Way& way) {
    const auto tags = tags_of(way);
    osmium::builder::add_way(buffer, _id(way.id), _nodes(way.node_ids), _tags(tags));
}

/// Adds a turn restriction. Its value names a direction, but readers evaluate only its first word.
void add_turn(osmium::memory::Buffer& buffer,
              std::int64_t id,
              std::int64_t from_way,
              const TurnRule& turn) {
    const auto member = [](osmium::item_type type, std::int64_t ref, const char* role) {
        return member_type{type, ref, role};
    };
    const std::vector members{member(osmium::item_type::way, from_way, "from"),
                              member(osmium::item_type::node, turn.via_node, "via"),
                              member(osmium::item_type::way, turn.to_way, "to")};
    const std::vector<std::pair<std::string, std::string>> tags{
        {"type", "restriction"}, {"restriction", turn.only != 0 ? "only_straight_on" : "no_entry"}};
    osmium::builder::add_relation(buffer, _id(id), _members(members), _tags(tags));
}

/// Passes a full buffer to the writer.
osmium::memory::Buffer flushed(osmium::io::Writer& writer, osmium::memory::Buffer buffer) {
    if (buffer.committed() < buffer_bytes / 2) {
        return buffer;
    }
    writer(std::move(buffer));
    return osmium::memory::Buffer{buffer_bytes, osmium::memory::Buffer::auto_grow::yes};
}

void write(std::span<const Way> ways, const std::filesystem::path& file) {
    osmium::io::File osm{file.string(), "pbf,add_metadata=none"};
    osmium::io::Header header;
    header.set("generator", "macadam");
    header.set("sorting", "Type_then_ID");
    osmium::io::Writer writer{osm, header, osmium::io::overwrite::allow};
    osmium::memory::Buffer buffer{buffer_bytes, osmium::memory::Buffer::auto_grow::yes};
    for (const auto& [id, place] : nodes_of(ways)) {
        osmium::builder::add_node(buffer, _id(id), _location(place));
        buffer = flushed(writer, std::move(buffer));
    }
    for (const auto& way : ways) {
        add_way(buffer, way);
        buffer = flushed(writer, std::move(buffer));
    }
    std::int64_t restrictions = 0;
    for (const auto& way : ways) {
        for (const auto& turn : way.turns) {
            add_turn(buffer, ++restrictions, way.id, turn);
            buffer = flushed(writer, std::move(buffer));
        }
    }
    writer(std::move(buffer));
    writer.close();
}

} // namespace

void expect_osm(std::span<const Way> ways) {
    nodes_of(ways);
    for (const auto& way : ways) {
        expect_short(way.name, "name", way.id);
        expect_short(way.highway, "class", way.id);
    }
}

void write_osm(std::span<const Way> ways, const std::filesystem::path& file) {
    expect_osm(ways);
    AtomicFileSet whole{std::filesystem::absolute(file)};
    try {
        write(ways, whole.main_file());
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& error) {
        throw InputError{fmt::format("{}: cannot be written: {}", file.string(), error.what())};
    }
    whole.commit();
}

} // namespace macadam
