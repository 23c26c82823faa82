#pragma once

#include "mapping/network/image/network_image.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace macadam::testing {

// Network images that someone changed on purpose: their sums are those of the changed bytes.

/// A little town with names, classes, limits, turn restrictions and a winding street, 20 m
/// segments.
RoadNetwork named_town();

/// An image as the bytes of its file.
std::vector<std::byte> bytes_of(const NetworkImage& image);

/// Makes length and sums in the head those of the bytes. Bytes shorter than a head stay as they
/// are.
void seal(std::vector<std::byte>& image);

/// The network of sealed bytes. \throws InputError  as network_in does.
RoadNetwork opened(std::vector<std::byte> image);

/// Where an array begins in the image. \param array  its number, as in RoadNetwork
struct ImageSection {
    std::size_t offset;
    std::size_t count; ///< of its records
};
ImageSection section_of(const std::vector<std::byte>& image, std::size_t array);

/// Reaches all that the network can be asked for: its ways, links, edges, nodes, turns, segments,
/// names and index, and a trip that is matched to it. \throws InputError  as the readers do.
void use(const RoadNetwork& roads);

} // namespace macadam::testing
