#include "storage/exports/flatgeobuf_index.hpp"

#include "estimator/common/error.hpp"
#include "mapping/geometry/hilbert_curve.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <span>

namespace macadam {
namespace {

static_assert(std::endian::native == std::endian::little); // byte order of the file

constexpr std::size_t magic_bytes = 8;
constexpr std::uint16_t children = 16;
constexpr std::size_t max_header_bytes = 10'000'000; // GDAL's own limit

/// Node as stored in the file. Its place is the position in bytes of its first child in the tree,
/// or, for a leaf, of its feature after the tree.
struct Node {
    double west = std::numeric_limits<double>::infinity();
    double south = std::numeric_limits<double>::infinity();
    double east = -std::numeric_limits<double>::infinity();
    double north = -std::numeric_limits<double>::infinity();
    std::uint64_t place = 0;
};
static_assert(sizeof(Node) == 40);

[[noreturn]] void fail_reading() {
    throw InputError{"cannot be written: what GDAL wrote is no FlatGeobuf without an index"};
}

template <typename Number>
Number number_in(std::string_view bytes, std::size_t at) {
    if (at + sizeof(Number) > bytes.size()) {
        fail_reading();
    }
    Number number;
    std::memcpy(&number, bytes.data() + at, sizeof(Number));
    return number;
}

// ---------------------------------------------------------------------------------- the header

/// Position of the node size in a size-prefixed header: field 9 of the table, found through its
/// vtable (FlatBuffers, "Internals"). The value 0 means no index.
std::size_t node_size_place(std::string_view header) {
    constexpr std::size_t field = 9;
    const std::size_t table = sizeof(std::uint32_t) + number_in<std::uint32_t>(header, 4);
    const auto vtable = static_cast<std::size_t>(static_cast<std::int64_t>(table) -
                                                 number_in<std::int32_t>(header, table));
    const std::size_t entry = vtable + 2 * sizeof(std::uint16_t) + field * sizeof(std::uint16_t);
    const auto offset = number_in<std::uint16_t>(header, entry);
    if (offset == 0 || number_in<std::uint16_t>(header, table + offset) != 0) {
        fail_reading();
    }
    return table + offset;
}

/// Magic bytes and header, changed to announce an index.
std::string announced(std::ifstream& plain) {
    std::string start(magic_bytes + sizeof(std::uint32_t), '\0');
    plain.read(start.data(), static_cast<std::streamsize>(start.size()));
    const auto header_bytes = number_in<std::uint32_t>(start, magic_bytes);
    if (!plain || header_bytes > max_header_bytes) {
        fail_reading();
    }
    std::string rest(header_bytes, '\0');
    plain.read(rest.data(), static_cast<std::streamsize>(rest.size()));
    start += rest;
    const auto at = magic_bytes + node_size_place(std::string_view{start}.substr(magic_bytes));
    std::memcpy(start.data() + at, &children, sizeof(children));
    return start;
}

// ------------------------------------------------------------------------------------ the tree

void include(Node& whole, const Node& part) {
    whole.west = std::min(whole.west, part.west);
    whole.south = std::min(whole.south, part.south);
    whole.east = std::max(whole.east, part.east);
    whole.north = std::max(whole.north, part.north);
}

/// Sizes of the levels, leaves first; even a single leaf has a root above it.
std::vector<std::size_t> levels_of(std::size_t leaves) {
    std::vector<std::size_t> levels{leaves};
    do {
        levels.push_back((levels.back() + children - 1) / children);
    } while (levels.back() != 1);
    return levels;
}

/// Writes the leaves at the end of the tree, in the order of the curve; their place is the number
/// of the feature.
void put_leaves(std::span<Node> leaves, const std::vector<GeoBox>& boxes) {
    Node all;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const auto& box = boxes[i];
        leaves[i] = {box.west_deg, box.south_deg, box.east_deg, box.north_deg, i};
        include(all, leaves[i]);
    }
    const auto cell = [](double low, double high, double value) {
        constexpr double last = 65535;
        return high > low ? static_cast<std::uint32_t>(last * (value - low) / (high - low)) : 0U;
    };
    for (auto& leaf : leaves) {
        const auto along =
            hilbert_distance(cell(all.west, all.east, (leaf.west + leaf.east) / 2),
                             cell(all.south, all.north, (leaf.south + leaf.north) / 2),
                             16);
        leaf.place |= along << 32U; // feature numbers have 32 bits
    }
    std::ranges::sort(leaves, {}, &Node::place);
    for (auto& leaf : leaves) {
        leaf.place &= 0xffff'ffffU;
    }
}

/// Fills the levels above the leaves, each from the one below. The root comes first.
void put_parents(std::vector<Node>& tree, const std::vector<std::size_t>& levels) {
    std::size_t below = tree.size() - levels.front();
    for (std::size_t level = 1; level < levels.size(); ++level) {
        const std::size_t begin = below - levels[level];
        for (std::size_t i = 0; i < levels[level]; ++i) {
            const std::size_t first = below + i * children;
            const std::size_t end = std::min(first + children, below + levels[level - 1]);
            auto& parent = tree[begin + i];
            parent.place = first;
            for (std::size_t child = first; child < end; ++child) {
                include(parent, tree[child]);
            }
        }
        below = begin;
    }
}

// -------------------------------------------------------------------------------- the features

/// Positions of the features in the file, and the end of the last one.
std::vector<std::uint64_t> starts_of(std::ifstream& plain, std::uint64_t at, std::size_t count) {
    std::vector<std::uint64_t> starts;
    starts.reserve(count + 1);
    starts.push_back(at);
    for (std::size_t i = 0; i < count; ++i) {
        std::uint32_t bytes = 0;
        plain.read(reinterpret_cast<char*>(&bytes), sizeof(bytes)); // NOLINT(*-reinterpret-cast)
        plain.ignore(bytes);
        if (!plain) {
            fail_reading();
        }
        starts.push_back(starts.back() + sizeof(bytes) + bytes);
    }
    return starts;
}

void copy_features(std::ifstream& plain,
                   std::span<const std::uint32_t> order,
                   const std::vector<std::uint64_t>& starts,
                   std::ofstream& out) {
    std::string feature;
    for (const auto number : order) {
        feature.resize(starts[number + 1] - starts[number]);
        plain.seekg(static_cast<std::streamoff>(starts[number]));
        plain.read(feature.data(), static_cast<std::streamsize>(feature.size()));
        out.write(feature.data(), static_cast<std::streamsize>(feature.size()));
    }
    if (!plain) {
        fail_reading();
    }
}

} // namespace

void index_flatgeobuf(const std::filesystem::path& plain,
                      std::vector<GeoBox> boxes,
                      const std::filesystem::path& file) {
    assert(!boxes.empty());
    std::ifstream in{plain, std::ios::binary};
    const auto start = announced(in);
    const auto starts = starts_of(in, start.size(), boxes.size());

    const auto levels = levels_of(boxes.size());
    std::vector<Node> tree;
    std::size_t nodes = 0;
    for (const auto level : levels) {
        nodes += level;
    }
    tree.resize(nodes);
    const auto leaves = std::span{tree}.last(boxes.size());
    put_leaves(leaves, boxes);
    boxes = {};
    put_parents(tree, levels);
    std::vector<std::uint32_t> order;
    order.reserve(leaves.size());
    std::uint64_t at = 0;
    for (auto& leaf : leaves) {
        const auto number = static_cast<std::uint32_t>(leaf.place);
        order.push_back(number);
        leaf.place = at;
        at += starts[number + 1] - starts[number];
    }

    std::ofstream out{file, std::ios::binary};
    out.write(start.data(), static_cast<std::streamsize>(start.size()));
    out.write(reinterpret_cast<const char*>(tree.data()), // NOLINT(*-reinterpret-cast)
              static_cast<std::streamsize>(tree.size() * sizeof(Node)));
    copy_features(in, order, starts, out);
    out.close();
    if (!out) {
        throw InputError{"cannot be written; the disk may be full"};
    }
}

} // namespace macadam
