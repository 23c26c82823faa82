#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace macadam::testing {

using TileValue = std::variant<std::string, double, std::int64_t>;

struct ReadFeature {
    std::optional<std::uint64_t> id;
    std::map<std::string, TileValue> values;
    std::vector<std::vector<std::pair<int, int>>> lines;
};

/// The only layer of a vector tile.
struct ReadTile {
    std::string layer;
    std::uint32_t version = 0;
    std::uint32_t extent = 0;
    std::vector<std::string> keys;
    std::vector<TileValue> values; ///< all stored values
    std::vector<ReadFeature> features;
};

/// Reads a tile by the Mapbox Vector Tile Specification 2.1, without Macadam's code.
/// \throws std::runtime_error  if the tile violates the specification.
ReadTile read_vector_tile(std::string_view bytes);

} // namespace macadam::testing
