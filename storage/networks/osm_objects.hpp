#pragma once

#include "estimator/common/geo.hpp"
#include "mapping/network/network_records.hpp"
#include "storage/networks/osm_tags.hpp"
#include "storage/networks/osm_turn_restrictions.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

namespace macadam {

/// Callbacks for the objects of an OSM file. Arguments are valid only during the call; objects
/// without a callback are skipped.
struct OsmVisitor {
    std::function<void(std::int64_t id, const PackedPoint& at)> node; ///< with valid coordinates
    std::function<void(std::int64_t id, const OsmTags& tags, std::span<const std::int64_t> nodes)>
        way;
    std::function<void(const OsmTags& tags, std::span<const OsmMember> members)> relation;
    std::function<void(std::uint64_t bytes)> pace; ///< bytes of the file read so far; may throw
    std::function<void(const OsmTags& tags, const PackedPoint& at)> tagged_node{};
    std::function<void(const GeoBox& box)> bounds{}; ///< that the file states, if they are valid
};

// Limits on the decompressed size of maps, against decompression bombs. Up to the free bytes, any
// ratio is accepted.

inline constexpr std::uint64_t max_pbf_expansion = 20; // real maps reach 4
inline constexpr std::uint64_t free_pbf_bytes = std::uint64_t{1} << 20U;
inline constexpr std::uint64_t max_xml_expansion = 100; // real maps reach 25
inline constexpr std::uint64_t free_xml_bytes = std::uint64_t{16} << 20U;

/// Gives the bounds that a file states to a visitor, if they are a box on the globe.
inline void give_bounds(const OsmVisitor& visitor, const GeoBox& box) {
    const bool is_valid = -180 <= box.west_deg && box.west_deg < box.east_deg &&
                          box.east_deg <= 180 && -90 <= box.south_deg &&
                          box.south_deg < box.north_deg && box.north_deg <= 90;
    if (visitor.bounds && is_valid) {
        visitor.bounds(box);
    }
}

/// Reads .osm.pbf block by block: raw or zlib blobs of at most 32 MiB, as the format specifies.
///
/// \throws std::exception  with a message, for a damaged or different file.
void visit_osm_pbf(const std::filesystem::path& file, const OsmVisitor& visitor);

/// Reads .osm, .osm.gz and .osm.bz2. A file with the root <osmChange> is read without the objects
/// that it deletes.
///
/// \throws std::exception  with a message, for a damaged or different file.
void visit_osm_xml(const std::filesystem::path& file, const OsmVisitor& visitor);

} // namespace macadam
