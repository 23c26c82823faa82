#include "input_file.hpp"
#include "mapping/network/build_network.hpp"
#include "rules.hpp"
#include "targets.hpp"

#include "mapping/network/segment.hpp"
#include "storage/networks/network_reader.hpp"
#include "storage/surveys/area_file.hpp"
#include "support/files/sealed_image.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace macadam::fuzz {
namespace {

bool is_on_globe(const GeoPoint& at) {
    return std::abs(at.lat_deg) <= 90 && std::abs(at.lon_deg) <= 180;
}

void expect_sound(const std::vector<Way>& ways) {
    expect(!ways.empty(), "a map without a road is refused");
    expect(std::ranges::adjacent_find(ways, std::greater_equal{}, &Way::id) == ways.end(),
           "ids rise");
    for (const auto& way : ways) {
        expect(way.line.size() >= 2, "a way has two ends");
        expect(way.line.size() == way.node_ids.size(), "every node has its place");
        expect(std::ranges::all_of(way.line, is_on_globe), "places are on the globe");
    }
}

/// A way's segments cover it without a gap, as far as that can be told from their borders.
void expect_sound(const RoadNetwork& roads) {
    for (std::uint32_t link = 0; link < link_count(roads); ++link) {
        const auto segments = segments_of(roads, edge_of(LinkId{link}, true));
        expect(segments.size() == link_at(roads, LinkId{link}).segments,
               "a link has the segments it counts");
        expect(segments.front().from_m == link_at(roads, LinkId{link}).from_m,
               "segments begin with the link");
        expect(segments.back().to_m == link_at(roads, LinkId{link}).to_m,
               "segments end with the link");
    }
}

/// What is read around a place of a map includes the way there.
void expect_way_around_its_start(const std::vector<Way>& ways,
                                 const std::filesystem::path& file,
                                 const LayerColumns& columns) {
    Surroundings around{1000};
    around.add(ways.front().line.front());
    NetworkCut cut{.around = around};
    const auto near = read_network(file, columns, {}, {}, &cut);
    expect(std::ranges::find(near, ways.front().id, &Way::id) != near.end(), "the way is there");
    expect(cut.ways >= near.size(), "the map has the ways");
}

Answer read(const std::filesystem::path& file, const LayerColumns& columns = {}) {
    const auto warn = [](const std::string& words) {
        expect(!words.empty(), "a warning has words");
    };
    return may_refuse([&] {
        auto ways = read_network(file, columns, {}, warn);
        expect_sound(ways);
        expect_way_around_its_start(ways, file, columns);
        expect_sound(build_network(std::move(ways)));
    });
}

/// Reads the polygons of a layer, if it has some.
std::optional<Answer> area_in(const std::filesystem::path& file) {
    const auto answer = may_refuse([&] {
        const auto area = read_area(file);
        const auto& [west_deg, south_deg, east_deg, north_deg] = area.box();
        expect(is_on_globe({south_deg, west_deg}) && is_on_globe({north_deg, east_deg}),
               "an area is on the globe");
        area.contains({(south_deg + north_deg) / 2, (west_deg + east_deg) / 2});
    });
    return answer == Answer::accepted ? std::optional{answer} : std::nullopt;
}

Answer read_as(const std::string& name, std::string_view input) {
    return read(input_file(name, input));
}

} // namespace

Answer osm_xml(std::string_view input) {
    return read_as(input.starts_with("\x1f\x8b") ? "a.osm.gz"
                   : input.starts_with("BZh")    ? "a.osm.bz2"
                                                 : "a.osm",
                   input);
}

Answer osm_pbf(std::string_view input) {
    return read_as("a.osm.pbf", input);
}

Answer line_layer(std::string_view input) {
    const auto file = input_file("a.geojson", input);
    read(file, {.layer = "roads", .id = {}, .name = {}, .highway = {}, .oneway = {}});
    read(file, {.layer = {}, .id = "number", .name = "called", .highway = "kind", .oneway = "way"});
    if (const auto area = area_in(file)) {
        return *area;
    }
    return read(file);
}

Answer network_image(std::string_view input) {
    const auto bytes = std::as_bytes(std::span{input});
    std::vector<std::byte> image{bytes.begin(), bytes.end()};
    testing::seal(image);
    return may_refuse([&] { testing::use(testing::opened(std::move(image))); });
}

} // namespace macadam::fuzz
