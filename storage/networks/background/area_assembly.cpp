#include "storage/networks/background/area_assembly.hpp"

// What g++ 12 says of libosmium's objects, which are longer than their class, is not so.
#pragma GCC diagnostic ignored "-Wstringop-overread"

#include <osmium/area/geom_assembler.hpp>
#include <osmium/builder/attr.hpp>
#include <osmium/memory/buffer.hpp>
#include <osmium/osm/area.hpp>

#include <utility>

namespace macadam {
namespace {

constexpr std::size_t first_buffer_bytes = 16384;

void add_way(osmium::memory::Buffer& ways, const PlacedWay& way) {
    std::vector<osmium::NodeRef> nodes;
    nodes.reserve(way.nodes.size());
    for (std::size_t i = 0; i < way.nodes.size(); ++i) {
        const auto& point = way.points[i];
        nodes.emplace_back(way.nodes[i], osmium::Location{point.lon_e7, point.lat_e7});
    }
    using namespace osmium::builder::attr; // NOLINT(google-build-using-namespace)
    osmium::builder::add_way(ways, _id(way.id), _nodes(nodes));
}

std::vector<PackedPoint> points_of(const osmium::NodeRefList& ring) {
    std::vector<PackedPoint> points;
    points.reserve(ring.size());
    for (const auto& node : ring) {
        points.push_back({node.location().y(), node.location().x()});
    }
    if (points.size() > 1 && points.back() == points.front()) {
        points.pop_back();
    }
    return points;
}

} // namespace

bool assemble_area(std::span<const PlacedWay* const> ways,
                   const std::function<void(std::vector<std::vector<PackedPoint>> rings)>& take) {
    osmium::memory::Buffer parts{first_buffer_bytes, osmium::memory::Buffer::auto_grow::yes};
    for (const auto* way : ways) {
        add_way(parts, *way);
    }
    osmium::memory::Buffer relations{first_buffer_bytes, osmium::memory::Buffer::auto_grow::yes};
    using namespace osmium::builder::attr; // NOLINT(google-build-using-namespace)
    const auto at = osmium::builder::add_relation(relations, _id(1));
    osmium::memory::Buffer areas{first_buffer_bytes, osmium::memory::Buffer::auto_grow::yes};
    osmium::area::AssemblerConfig config;
    osmium::area::GeomAssembler assembler{config};
    if (!assembler(relations.get<osmium::Relation>(at), parts, areas)) {
        return false;
    }
    for (const auto& area : areas.select<osmium::Area>()) {
        for (const auto& outer : area.outer_rings()) {
            std::vector<std::vector<PackedPoint>> rings{points_of(outer)};
            for (const auto& inner : area.inner_rings(outer)) {
                rings.push_back(points_of(inner));
            }
            take(std::move(rings));
        }
    }
    return true;
}

} // namespace macadam
