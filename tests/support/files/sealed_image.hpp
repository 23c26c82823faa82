#pragma once

#include "mapping/network/image/network_image.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace macadam::testing {

// Network images that were changed on purpose and whose checksums match the changed bytes.

/// Builds a small town with names, classes, limits, turn restrictions and a winding street, in
/// segments of 20 m.
RoadNetwork named_town();

/// Returns an image as the bytes of its file.
std::vector<std::byte> bytes_of(const NetworkImage& image);

/// Sets the length and checksums in the header to those of the bytes. Does not change bytes shorter
/// than a header.
void seal(std::vector<std::byte>& image);

/// Opens the network of sealed bytes.
/// \throws InputError  as network_in does.
RoadNetwork opened(std::vector<std::byte> image);

/// Position of an array in the image; section_of() takes its number, as in RoadNetwork.
struct ImageSection {
    std::size_t offset;
    std::size_t count; ///< number of records
};
ImageSection section_of(const std::vector<std::byte>& image, std::size_t array);

/// Reads everything that the network provides: its ways, links, edges, nodes, turns, segments,
/// names and index, and a trip that is matched to it.
/// \throws InputError  as the readers do.
void use(const RoadNetwork& roads);

} // namespace macadam::testing
