#pragma once

#include "mapping/network/road_network.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

// A network as bytes that are read in place: a head, then the arrays of a RoadNetwork as they lie
// in memory, each from a multiple of image_alignment on. What docs/reference/road-maps.md says of
// the file.

inline constexpr std::size_t image_alignment = 64;

struct NetworkImage {
    std::string head;                                 ///< as long as a multiple of image_alignment
    std::vector<std::span<const std::byte>> sections; ///< each to be filled up to such a multiple
};

/// \param source  what the network was made of: 64 hex digits. It stands in the image, so that
///                whoever finds one knows whether it is his.
/// The sections look into `roads`.
NetworkImage image_of(const RoadNetwork& roads, std::string_view source);

/// Whether bytes begin as an image does, whatever comes then.
bool begins_as_image(std::span<const std::byte> bytes);

struct ImageContent {
    RoadNetwork roads;
    std::string source;
};

/// The network that an image holds. Costs one look at every byte and no memory.
///
/// \param image  begins at a multiple of 8 in memory
/// \param owner  keeps these bytes
/// \throws InputError  if they are no image, one of another version or byte order, or damaged.
ImageContent network_in(std::span<const std::byte> image, std::shared_ptr<const void> owner);

} // namespace macadam
