// A large map out of small ones: the maps themselves and further copies of them, each a little
// farther east, with ids of their own. For measuring what a network of millions of edges costs.

#include <osmium/builder/attr.hpp>
#include <osmium/io/any_input.hpp>
#include <osmium/io/header.hpp>
#include <osmium/io/pbf_output.hpp>
#include <osmium/io/reader.hpp>
#include <osmium/io/writer.hpp>
#include <osmium/memory/buffer.hpp>
#include <osmium/osm/box.hpp>
#include <osmium/osm/node.hpp>
#include <osmium/osm/relation.hpp>
#include <osmium/osm/way.hpp>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <exception>
#include <iostream>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

using namespace osmium::builder::attr; // NOLINT(google-build-using-namespace): names of attributes

constexpr const char* usage =
    "usage: shifted_copies OUT.osm.pbf COPIES MAP...\n\n"
    "Writes the maps (.osm.pbf, .osm.gz, ...) and COPIES - 1 further copies of each. Copy k lies "
    "k\n"
    "widths of its map farther east (round the globe, away from the antimeridian) and its ids are\n"
    "those of the map + k * 2^36, so that they need 64 bits. The maps must not share ids.\n";

constexpr unsigned id_bits_of_a_copy = 36; // OSM's own ids have 34
constexpr std::size_t buffer_bytes = std::size_t{1} << 20U;
constexpr std::int64_t per_deg = 10'000'000;
constexpr std::int64_t farthest_lon_e7 = 179 * per_deg;
constexpr std::int64_t margin_e7 = per_deg / 100; // 0.01 degrees between a copy and the next

/// All of a map, and how far its copies lie apart.
struct Map {
    osmium::memory::Buffer content;
    std::int64_t step_e7;
};

Map read(const std::string& file) {
    osmium::io::Reader reader{file};
    osmium::memory::Buffer content{buffer_bytes, osmium::memory::Buffer::auto_grow::yes};
    osmium::Box box;
    while (const auto buffer = reader.read()) {
        for (const auto& node : buffer.select<osmium::Node>()) {
            box.extend(node.location());
        }
        content.add_buffer(buffer);
        content.commit();
    }
    reader.close();
    return {std::move(content),
            std::int64_t{box.top_right().x()} - box.bottom_left().x() + margin_e7};
}

struct Shift {
    std::int64_t id;
    std::int64_t lon_e7;
};

Shift shift_of(const Map& map, std::int64_t copy) {
    return {copy << id_bits_of_a_copy, copy * map.step_e7};
}

osmium::Location moved(const osmium::Location& place, const Shift& shift) {
    if (!place.valid() || shift.lon_e7 == 0) {
        return place;
    }
    auto lon_e7 = (place.x() + shift.lon_e7 + farthest_lon_e7) % (2 * farthest_lon_e7);
    return osmium::Location{static_cast<std::int32_t>(lon_e7 - farthest_lon_e7), place.y()};
}

void copy(osmium::memory::Buffer& out, const osmium::Node& node, const Shift& shift) {
    osmium::builder::add_node(out,
                              _id(node.id() + shift.id),
                              _location(moved(node.location(), shift)),
                              _tags(node.tags()));
}

void copy(osmium::memory::Buffer& out, const osmium::Way& way, const Shift& shift) {
    std::vector<osmium::object_id_type> nodes;
    for (const auto& node : way.nodes()) {
        nodes.push_back(node.ref() + shift.id);
    }
    osmium::builder::add_way(out, _id(way.id() + shift.id), _nodes(nodes), _tags(way.tags()));
}

void copy(osmium::memory::Buffer& out, const osmium::Relation& relation, const Shift& shift) {
    std::vector<member_type> members;
    for (const auto& member : relation.members()) {
        members.emplace_back(member.type(), member.ref() + shift.id, member.role());
    }
    osmium::builder::add_relation(
        out, _id(relation.id() + shift.id), _members(members), _tags(relation.tags()));
}

/// All objects of a kind, copy by copy.
template <typename Object>
void copy_all(std::vector<Map>& maps, std::int64_t copies, osmium::io::Writer& writer) {
    osmium::memory::Buffer out{2 * buffer_bytes, osmium::memory::Buffer::auto_grow::yes};
    for (std::int64_t k = 0; k < copies; ++k) {
        for (auto& map : maps) {
            for (const auto& object : map.content.select<Object>()) {
                copy(out, object, shift_of(map, k));
                if (out.committed() > buffer_bytes) {
                    writer(std::move(out));
                    out = osmium::memory::Buffer{2 * buffer_bytes,
                                                 osmium::memory::Buffer::auto_grow::yes};
                }
            }
        }
    }
    writer(std::move(out));
}

void run(std::span<char*> arguments) {
    std::int64_t copies = 0;
    const std::string_view number{arguments[1]};
    std::from_chars(number.data(), number.data() + number.size(), copies);
    if (copies < 1) {
        throw std::runtime_error{"COPIES is '" + std::string{number} + "', expected 1 or more"};
    }
    std::vector<Map> maps;
    for (const char* const file : arguments.subspan(2)) {
        maps.push_back(read(file));
    }
    osmium::io::Writer writer{osmium::io::File{arguments[0], "pbf,add_metadata=none"},
                              osmium::io::overwrite::allow};
    copy_all<osmium::Node>(maps, copies, writer);
    copy_all<osmium::Way>(maps, copies, writer);
    copy_all<osmium::Relation>(maps, copies, writer);
    writer.close();
}

} // namespace

int main(int count, char** arguments) {
    if (count < 4) {
        std::cerr << usage;
        return 2;
    }
    try {
        run(std::span{arguments + 1, arguments + count});
    } catch (const std::exception& error) {
        std::cerr << "shifted_copies: " << error.what() << '\n';
        return 1;
    }
    return 0;
}
