#pragma once

#include "mapping/network/road_network.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

// A network as bytes that are read in place: a header, then the arrays of a RoadNetwork as they are
// in memory, each aligned to image_alignment. docs/reference/road-maps.md specifies the file.

inline constexpr std::size_t image_alignment = 64;

struct NetworkImage {
    std::string head;                                 ///< its size is a multiple of image_alignment
    std::vector<std::span<const std::byte>> sections; ///< each to be padded to such a multiple
};

/// Creates the image of a network.
///
/// \param source  origin of the network: 64 hex digits, stored in the image so that a reader can
///                tell whether it matches.
/// \returns  an image whose sections refer to `roads`.
NetworkImage image_of(const RoadNetwork& roads, std::string_view source);

/// Returns true if the bytes begin like an image, whatever follows.
bool begins_as_image(std::span<const std::byte> bytes);

struct ImageContent {
    RoadNetwork roads;
    std::string source;
};

/// Reads the network from an image. Reads every byte once and allocates no memory.
///
/// \param image  aligned to 8 bytes in memory
/// \param owner  keeps these bytes alive
/// \throws InputError  if the bytes are no image, of another version or byte order, or damaged.
ImageContent network_in(std::span<const std::byte> image, std::shared_ptr<const void> owner);

} // namespace macadam
