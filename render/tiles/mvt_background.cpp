#include "render/tiles/mvt_background.hpp"

#include "render/tiles/mvt_layer.hpp"

#include <protozero/pbf_writer.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>

namespace macadam {
namespace {

// Field numbers of the specification's vector_tile.proto.
namespace tag {
constexpr protozero::pbf_tag_type layer = 3;
constexpr protozero::pbf_tag_type name = 1, feature = 2, key = 3, value = 4, extent = 5;
constexpr protozero::pbf_tag_type version = 15;
constexpr protozero::pbf_tag_type tags = 2, type = 3, geometry = 4;
constexpr protozero::pbf_tag_type text = 1, whole = 4;
} // namespace tag

constexpr std::uint32_t point_type = 1, line_type = 2, polygon_type = 3;
constexpr std::uint32_t move_command = 1, line_command = 2, close_command = 7;

constexpr std::array layers{BackgroundLayer{"built_up", background_from_zoom},
                            BackgroundLayer{"green", background_from_zoom},
                            BackgroundLayer{"water", background_from_zoom},
                            BackgroundLayer{"buildings", 14},
                            BackgroundLayer{"railways", 9},
                            BackgroundLayer{"places", background_from_zoom}};

/// Name of a kind of background in vector tiles.
struct KindName {
    std::string_view layer, word;
    int min_zoom;
};

constexpr std::array<KindName, background_kinds> kinds{
    KindName{"built_up", "built_up", background_from_zoom},
    KindName{"green", "meadow", 11},
    KindName{"green", "park", 9},
    KindName{"green", "forest", background_from_zoom},
    KindName{"water", "water", background_from_zoom},
    KindName{"water", "river", 8},
    KindName{"water", "stream", 14},
    KindName{"buildings", "building", 14},
    KindName{"railways", "railway", 9},
    KindName{"railways", "siding", 15}};

constexpr std::array<std::string_view, place_ranks> rank_words{"city", "town", "village", "suburb"};
constexpr std::array<int, place_ranks> rank_zooms{background_from_zoom, 8, 11, 12};

using Geometry = std::vector<std::uint32_t>;

/// Writes commands of a geometry.
class Pen {
public:
    void add(const std::vector<CellPoint>& path, bool is_ring) {
        move(path.front());
        command(line_command, path.size() - 1);
        for (std::size_t i = 1; i < path.size(); ++i) {
            step(path[i]);
        }
        if (is_ring) {
            command(close_command, 1);
        }
    }

    void move(const CellPoint& point) {
        command(move_command, 1);
        step(point);
    }

    const Geometry& geometry() const { return geometry_; }

private:
    void command(std::uint32_t id, std::size_t count) {
        geometry_.push_back(id | static_cast<std::uint32_t>(count) << 3U);
    }

    void step(const CellPoint& point) {
        for (const auto difference : {point.x - cursor_.x, point.y - cursor_.y}) {
            geometry_.push_back(protozero::encode_zigzag32(difference));
        }
        cursor_ = point;
    }

    Geometry geometry_;
    CellPoint cursor_{0, 0};
};

double area_of(const std::vector<CellPoint>& ring) {
    double twice = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const auto& a = ring[i];
        const auto& b = ring[i + 1 < ring.size() ? i + 1 : 0];
        twice += double(a.x) * b.y - double(b.x) * a.y;
    }
    return twice / 2;
}

/// Path in units of a tile; empty if too small. \param shrink  bits by which cells are finer
std::vector<CellPoint> scaled(const std::vector<CellPoint>& path, int shrink, bool is_ring) {
    constexpr double smallest_area = 4; // half a pixel of 512
    std::vector<CellPoint> units;
    for (const auto& point : path) {
        const CellPoint unit{point.x >> shrink, point.y >> shrink};
        if (units.empty() || units.back() != unit) {
            units.push_back(unit);
        }
    }
    if (is_ring && units.size() > 1 && units.back() == units.front()) {
        units.pop_back();
    }
    const bool is_seen =
        is_ring ? units.size() > 2 && std::abs(area_of(units)) >= smallest_area : units.size() > 1;
    return is_seen ? units : std::vector<CellPoint>{};
}

/// Pieces of a tile by kind.
class Pieces {
public:
    explicit Pieces(const TileId& tile) : tile_{tile} {}

    void add(const BackgroundTile& source) {
        visit_pieces(source.pieces, [&](const BackgroundPiece& piece) {
            if (tile_.zoom < kinds[static_cast<std::size_t>(piece.kind)].min_zoom) {
                return;
            }
            if (const auto within = piece_within(moved(piece, source.tile), shown(source.tile))) {
                add_scaled(*within, source.tile);
            }
        });
    }

    const std::map<BackgroundKind, Pen>& pens() const { return pens_; }

private:
    /// Bits by which the cells of moved() are finer than those of this tile.
    int finer_than_own(const TileId& source) const { return std::max(0, source.zoom - tile_.zoom); }

    /// The tile with its buffer, in the cells of moved().
    CellSquare shown(const TileId& source) const {
        constexpr std::int32_t buffer = tile_buffer * (background_cells / tile_extent);
        const auto finer = static_cast<unsigned>(finer_than_own(source));
        return {-(buffer << finer), (background_cells + buffer) << finer};
    }

    /// A piece in cells from this tile's corner, as fine as the finer of both tiles.
    BackgroundPiece moved(const BackgroundPiece& piece, const TileId& source) const {
        const auto up = static_cast<unsigned>(std::max(0, tile_.zoom - source.zoom));
        const auto down = static_cast<unsigned>(finer_than_own(source));
        const auto corner = [&](std::uint32_t at, std::uint32_t of_tile) {
            return ((std::int64_t{at} << up) - (std::int64_t{of_tile} << down)) * background_cells;
        };
        const auto x = corner(source.x, tile_.x), y = corner(source.y, tile_.y);
        const auto cell = [&](std::int32_t at, std::int64_t from) {
            return static_cast<std::int32_t>((std::int64_t{at} << up) + from);
        };
        auto result = piece;
        for (auto& path : result.paths) {
            for (auto& point : path) {
                point = {cell(point.x, x), cell(point.y, y)};
            }
        }
        return result;
    }

    void add_scaled(const BackgroundPiece& piece, const TileId& source) {
        constexpr int extent_bits = 12;
        static_assert(tile_extent == 1 << extent_bits);
        const int shrink = finer_than_own(source) + background_cell_bits - extent_bits;
        const bool is_ring = !is_line_kind(piece.kind);
        bool has_outer = false; // of the rings that follow
        for (const auto& path : piece.paths) {
            const auto units = scaled(path, shrink, is_ring);
            if (is_ring && area_of(path) > 0) {
                has_outer = !units.empty();
            }
            if (!units.empty() && (!is_ring || has_outer)) {
                pens_[piece.kind].add(units, is_ring);
            }
        }
    }

    TileId tile_;
    std::map<BackgroundKind, Pen> pens_;
};

/// Layer with keys and values as they come up.
class Layer {
public:
    explicit Layer(std::string_view name) : name_{name} {}

    void add_word(std::string_view key, std::string_view word) {
        std::string value;
        protozero::pbf_writer{value}.add_string(tag::text, word.data(), word.size());
        add(key, value);
    }

    void add_number(std::string_view key, std::int64_t number) {
        std::string value;
        protozero::pbf_writer{value}.add_int64(tag::whole, number);
        add(key, value);
    }

    void end_feature(std::uint32_t type, const Geometry& geometry) {
        std::string feature;
        protozero::pbf_writer writer{feature};
        writer.add_packed_uint32(tag::tags, tags_.begin(), tags_.end());
        writer.add_uint32(tag::type, type);
        writer.add_packed_uint32(tag::geometry, geometry.begin(), geometry.end());
        protozero::pbf_writer{features_}.add_message(tag::feature, feature);
        tags_.clear();
    }

    /// The layer as part of a tile; "" without features.
    std::string tile_bytes() const {
        if (features_.empty()) {
            return {};
        }
        std::string layer;
        protozero::pbf_writer writer{layer};
        writer.add_uint32(tag::version, 2);
        writer.add_string(tag::name, name_.data(), name_.size());
        layer += features_;
        for (const auto key : keys_) {
            writer.add_string(tag::key, key.data(), key.size());
        }
        for (const auto& value : values_) {
            writer.add_message(tag::value, value);
        }
        writer.add_uint32(tag::extent, tile_extent);
        std::string tile;
        protozero::pbf_writer{tile}.add_message(tag::layer, layer);
        return tile;
    }

private:
    template <typename Item>
    static std::uint32_t number_of(std::vector<Item>& known, const Item& item) {
        const auto at = std::find(known.begin(), known.end(), item) - known.begin();
        if (at == std::ssize(known)) {
            known.push_back(item);
        }
        return static_cast<std::uint32_t>(at);
    }

    void add(std::string_view key, const std::string& value) {
        tags_.push_back(number_of(keys_, key));
        tags_.push_back(number_of(values_, value));
    }

    std::string_view name_;
    std::string features_;
    std::vector<std::string_view> keys_;
    std::vector<std::string> values_; ///< encoded
    std::vector<std::uint32_t> tags_; ///< of the current feature
};

std::string places_layer(const TileId& tile, std::span<const PlaceName> places) {
    Layer layer{layers.back().name};
    for (const auto& place : places) {
        const auto rank = static_cast<std::size_t>(place.rank);
        const auto at = tile_position(place.position, tile.zoom);
        if (tile.zoom < rank_zooms[rank] || std::floor(at.x) != tile.x ||
            std::floor(at.y) != tile.y) {
            continue;
        }
        const auto unit = [](double position, std::uint32_t of_tile) {
            return static_cast<std::int32_t>((position - of_tile) * tile_extent);
        };
        Pen pen;
        pen.move({unit(at.x, tile.x), unit(at.y, tile.y)});
        layer.add_word("name", place.name);
        layer.add_word("kind", rank_words[rank]);
        layer.add_number("rank", static_cast<std::int64_t>(rank));
        layer.end_feature(point_type, pen.geometry());
    }
    return layer.tile_bytes();
}

} // namespace

std::span<const BackgroundLayer> background_layers() {
    return layers;
}

const BackgroundLevel& background_level_of_zoom(int zoom) {
    for (const auto& level : background_levels) {
        if (zoom >= level.zoom) {
            return level;
        }
    }
    return background_levels.back();
}

std::string background_layers_of(const TileId& tile,
                                 std::span<const BackgroundTile> tiles,
                                 std::span<const PlaceName> places) {
    if (tile.zoom < background_from_zoom) {
        return {};
    }
    Pieces pieces{tile};
    for (const auto& source : tiles) {
        pieces.add(source);
    }
    std::string bytes;
    for (const auto& each : layers) {
        Layer layer{each.name};
        for (const auto& [kind, pen] : pieces.pens()) {
            const auto& name = kinds[static_cast<std::size_t>(kind)];
            if (name.layer == each.name) {
                layer.add_word("kind", name.word);
                layer.end_feature(is_line_kind(kind) ? line_type : polygon_type, pen.geometry());
            }
        }
        bytes += layer.tile_bytes();
    }
    return bytes + places_layer(tile, places);
}

} // namespace macadam
