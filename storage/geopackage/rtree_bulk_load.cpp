#include "storage/geopackage/rtree_bulk_load.hpp"

#include "storage/sqlite/bulk_insert.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>

namespace macadam {
namespace {

// Format of a node, big endian: depth of the tree (in the root, else 0) and number of cells, two
// bytes each; then the cells, each a number of eight bytes (of a row, or of a child node) and a box
// of four floats.
constexpr std::size_t head_bytes = 4;
constexpr std::size_t cell_bytes = 24;
constexpr std::uint32_t root = 1;

using Cell = RtreeBulkLoad::Cell;
using Limits = decltype(Cell::limits);

float not_above(double value) {
    const auto near = static_cast<float>(value);
    return near > value ? std::nextafter(near, -std::numeric_limits<float>::infinity()) : near;
}

float not_below(double value) {
    return -not_above(-value);
}

Limits limits_of(const GeoBox& box) {
    return {not_above(box.west_deg),
            not_below(box.east_deg),
            not_above(box.south_deg),
            not_below(box.north_deg)};
}

Limits around(std::span<const Cell> cells) {
    auto whole = cells.front().limits;
    for (const auto& [limits, number] : cells) {
        whole = {std::min(whole[0], limits[0]),
                 std::max(whole[1], limits[1]),
                 std::min(whole[2], limits[2]),
                 std::max(whole[3], limits[3])};
    }
    return whole;
}

/// Sorts cells by their centre in one dimension, in the same order on every machine.
void sort_by_place(std::span<Cell> cells, std::size_t dimension) {
    std::ranges::sort(cells, {}, [=](const Cell& cell) {
        return std::pair{cell.limits[2 * dimension] + cell.limits[2 * dimension + 1], cell.number};
    });
}

std::size_t parts_of(std::size_t count, std::size_t most) {
    return (count + most - 1) / most;
}

/// Part of the cells when they are divided evenly.
std::span<Cell> part(std::span<Cell> cells, std::size_t number, std::size_t parts) {
    const auto first = number * cells.size() / parts;
    return cells.subspan(first, (number + 1) * cells.size() / parts - first);
}

/// Slices from north to south, each divided into nodes.
std::vector<std::span<Cell>> tiles_of(std::span<Cell> cells, std::size_t most) {
    const auto nodes = parts_of(cells.size(), most);
    const auto chunks = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(nodes))));
    std::vector<std::span<Cell>> tiles;
    tiles.reserve(nodes + chunks);
    sort_by_place(cells, 0);
    for (std::size_t s = 0; s < chunks; ++s) {
        const auto chunk = part(cells, s, chunks);
        sort_by_place(chunk, 1);
        const auto parts = parts_of(chunk.size(), most);
        for (std::size_t i = 0; i < parts; ++i) {
            tiles.push_back(part(chunk, i, parts));
        }
    }
    return tiles;
}

template <typename Whole>
char* put(char* to, Whole value) {
    for (std::size_t i = sizeof(Whole); i-- > 0; ++to) {
        *to = static_cast<char>(value >> (8 * i));
    }
    return to;
}

/// Nodes of the level below, which were written consecutively.
struct Below {
    std::int64_t first;
    /// Row ids of the lowest level; empty for other levels.
    std::span<const std::int64_t> rows;

    std::int64_t id_of(std::size_t number) const {
        return rows.empty() ? first + static_cast<std::int64_t>(number) : rows[number];
    }
};

std::string node_of(std::span<const Cell> cells,
                    const Below& below,
                    std::size_t depth,
                    std::size_t node_bytes) {
    std::string node(node_bytes, '\0');
    char* to = put(node.data(), static_cast<std::uint16_t>(depth));
    to = put(to, static_cast<std::uint16_t>(cells.size()));
    for (const auto& [limits, number] : cells) {
        to = put(to, static_cast<std::uint64_t>(below.id_of(number)));
        for (const float limit : limits) {
            to = put(to, std::bit_cast<std::uint32_t>(limit));
        }
    }
    return node;
}

/// Writes an R-tree level by level.
class Packing {
public:
    Packing(Database& database, std::string_view rtree, std::span<const std::int64_t> ids)
        : add_node_{database.prepare(
              fmt::format("INSERT OR REPLACE INTO {}_node VALUES (?, ?)", rtree))},
          add_row_{database, fmt::format("INSERT INTO {}_rowid", rtree), 2},
          add_parent_{database, fmt::format("INSERT INTO {}_parent", rtree), 2}, below_{0, ids},
          node_bytes_{static_cast<std::size_t>(database.number(
              fmt::format("SELECT length(data) FROM {}_node WHERE nodeno = {}", rtree, root)
                  .c_str()))} {}

    void write(std::vector<Cell> cells) {
        const auto most = (node_bytes_ - head_bytes) / cell_bytes;
        for (std::size_t depth = 0;; ++depth) {
            const auto tiles = tiles_of(cells, most);
            if (tiles.size() == 1) {
                add_node_.run(std::int64_t{root}, Blob{node_of(cells, below_, depth, node_bytes_)});
                write_parents(std::vector<std::uint32_t>(cells.size(), root));
                return;
            }
            cells = write_level(tiles, cells.size());
        }
    }

private:
    /// \returns  the cells of the level above
    std::vector<Cell> write_level(const std::vector<std::span<Cell>>& tiles, std::size_t count) {
        const auto first = next_;
        std::vector<Cell> above;
        std::vector<std::uint32_t> parents(count);
        for (const auto& tile : tiles) {
            for (const auto& cell : tile) {
                parents[cell.number] = static_cast<std::uint32_t>(next_);
            }
            add_node_.run(next_, Blob{node_of(tile, below_, 0, node_bytes_)});
            above.push_back({around(tile), static_cast<std::uint32_t>(next_ - first)});
            ++next_;
        }
        write_parents(parents);
        below_ = {first, {}};
        return above;
    }

    /// \param parents  node of each child, by the number of the child.
    void write_parents(const std::vector<std::uint32_t>& parents) {
        auto& add = below_.rows.empty() ? add_parent_ : add_row_;
        for (std::size_t i = 0; i < parents.size(); ++i) {
            add.add(below_.id_of(i), std::int64_t{parents[i]});
        }
        add.flush();
    }

    Statement add_node_;
    BulkInsert add_row_;
    BulkInsert add_parent_;
    Below below_;
    std::size_t node_bytes_;
    std::int64_t next_ = std::int64_t{root} + 1;
};

} // namespace

void RtreeBulkLoad::add(std::int64_t id, const GeoBox& box) {
    cells_.push_back({limits_of(box), static_cast<std::uint32_t>(ids_.size())});
    ids_.push_back(id);
}

void RtreeBulkLoad::write_to(Database& database, std::string_view rtree) && {
    if (!ids_.empty()) {
        Packing{database, rtree, ids_}.write(std::move(cells_));
    }
}

} // namespace macadam
