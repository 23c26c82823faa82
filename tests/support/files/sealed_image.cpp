#include "sealed_image.hpp"
#include "estimator/motion/make_odometer.hpp"
#include "mapping/matching/arcs.hpp"
#include "mapping/network/build_network.hpp"

#include "estimator/common/error.hpp"
#include "mapping/matching/edge_traversals.hpp"
#include "mapping/matching/map_match.hpp"
#include "mapping/network/segment.hpp"
#include "mapping/routes/linear_route.hpp"
#include "support/roads/town.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>

namespace macadam::testing {
namespace {

// The head, as docs/reference/road-maps.md and mapping/network/image/network_image.cpp have it.
constexpr std::size_t bytes_at = 16;
constexpr std::size_t sections_at = 96;
constexpr std::size_t sum_at = sections_at + 14 * 16;
constexpr std::size_t head_sum_at = sum_at + 8;
constexpr std::size_t head_bytes = 384;

std::uint64_t mixed(std::uint64_t strand, std::uint64_t word) {
    return std::rotl((strand ^ word) * 0x9e3779b97f4a7c15U, 29);
}

std::uint64_t sum_of(std::span<const std::byte> bytes) {
    std::array<std::uint64_t, 4> strands{1, 2, 3, 4};
    std::size_t at = 0;
    for (; at + 32 <= bytes.size(); at += 32) {
        for (std::size_t i = 0; i < 4; ++i) {
            std::uint64_t word = 0;
            std::memcpy(&word, bytes.data() + at + 8 * i, 8);
            strands[i] = mixed(strands[i], word);
        }
    }
    for (; at < bytes.size(); ++at) {
        strands[0] = mixed(strands[0], std::to_integer<std::uint64_t>(bytes[at]));
    }
    std::uint64_t sum = 0;
    for (const auto strand : strands) {
        sum = mixed(sum, strand);
    }
    return sum;
}

void put(std::vector<std::byte>& image, std::size_t at, std::uint64_t value) {
    std::memcpy(image.data() + at, &value, sizeof value);
}

std::uint64_t word_at(const std::vector<std::byte>& image, std::size_t at) {
    std::uint64_t word = 0;
    std::memcpy(&word, image.data() + at, sizeof word);
    return word;
}

const TripLog& trip_through_town() {
    static const TripLog trip = [] {
        const auto roads = named_town();
        std::mt19937_64 random{7};
        const auto journey = wander(roads, 6, random);
        return recorded(roads, journey, {3, 1, true}, random);
    }();
    return trip;
}

void expect(bool holds, const char* what) {
    if (!holds) {
        throw std::logic_error{what};
    }
}

void use_link(const RoadNetwork& roads, LinkId id) {
    const auto link = link_at(roads, id);
    expect(link.segments <= 100'000 || link.to_m > link.from_m, "segments have a length");
    line_on(roads, edge_of(id, true), 0, length_m(roads, id));
    speed_limit_mps(roads, id);
    for (const bool forward : {true, false}) {
        const auto edge = edge_of(id, forward);
        expect(line_of(roads, edge).size() >= 2, "an edge has two ends");
        place_on(roads, edge, length_m(roads, edge) / 2);
        place_of(roads, from_node(roads, edge));
        for (const auto next : out_edges(roads, to_node(roads, edge))) {
            may_turn(roads, edge, next);
        }
        if (link.segments < 10'000) { // a test's time is short
            expect(segments_of(roads, edge).size() == link.segments, "a link has its segments");
        }
    }
}

} // namespace

RoadNetwork named_town() {
    auto ways = copies_of_ways(made_up_town(3));
    for (auto& way : ways) {
        way.name = way.id % 2 == 0 ? "High Street" : "Rue " + std::to_string(way.id);
        way.highway = way.id % 3 == 0 ? "residential" : "secondary";
        way.speed_limit_cmps = way.id % 4 == 0 ? 1389 : 0;
    }
    ways[0].turns = {{ways[0].node_ids.back(), ways[2].id, 0},
                     {ways[0].node_ids.back(), ways[3].id, 1}};
    Way winding{1000, "Serpentine", "track", Oneway::no, {}, {}};
    for (int i = 0; i < 40; ++i) {
        winding.node_ids.push_back(2'000'000 + i);
        winding.line.push_back(
            {town_corner.lat_deg - 0.001 - i * 1e-5, town_corner.lon_deg + (i % 2) * 1e-4});
    }
    winding.node_ids.front() = ways[0].node_ids.front();
    winding.line.front() = ways[0].line.front();
    ways.push_back(std::move(winding));
    return build_network(std::move(ways));
}

std::vector<std::byte> bytes_of(const NetworkImage& image) {
    const auto head = std::as_bytes(std::span{image.head});
    std::vector<std::byte> bytes{head.begin(), head.end()};
    for (const auto& section : image.sections) {
        bytes.insert(bytes.end(), section.begin(), section.end());
        bytes.resize((bytes.size() + image_alignment - 1) / image_alignment * image_alignment);
    }
    return bytes;
}

void seal(std::vector<std::byte>& image) {
    if (image.size() < head_bytes) {
        return;
    }
    put(image, bytes_at, image.size());
    put(image, sum_at, sum_of(std::span{image}.subspan(head_bytes)));
    put(image, head_sum_at, sum_of(std::span{image}.first(head_sum_at)));
}

RoadNetwork opened(std::vector<std::byte> image) {
    const auto kept = std::make_shared<const std::vector<std::byte>>(std::move(image));
    return network_in(*kept, kept).roads;
}

ImageSection section_of(const std::vector<std::byte>& image, std::size_t array) {
    return {word_at(image, sections_at + 16 * array), word_at(image, sections_at + 16 * array + 8)};
}

void use(const RoadNetwork& roads) {
    for (std::uint32_t i = 0; i < way_count(roads); ++i) {
        const auto way = copy_of(way_at(roads, i));
        expect(way.line.size() >= 2 && way.line.size() == way.node_ids.size(), "a way is a line");
        try {
            route_of_named_road(roads, way.name);
        } catch (const InputError&) { // several roads of one name
        }
        expect(!route_along_way(roads, way.id, {}, {}, {}).parts.empty(), "a way can be followed");
    }
    for (std::uint32_t i = 0; i < link_count(roads); ++i) {
        use_link(roads, LinkId{i});
    }
    for (const auto link : links_near(roads, extent_of(roads))) {
        link_at(roads, link);
    }
    const auto& trip = trip_through_town();
    const auto odometer = make_odometer(trip, {}).odometer;
    const auto trace = map_match(trip, odometer, roads, {}).trace;
    edge_traversals(trace);
    arcs_of(trace, roads);
    pieces_of(roads, followed(trace));
    const auto bytes = bytes_of(image_of(roads, std::string(64, 'a')));
    opened(bytes);
}

} // namespace macadam::testing
