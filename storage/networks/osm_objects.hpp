#pragma once

#include "mapping/network/network_records.hpp"
#include "storage/networks/osm_tags.hpp"
#include "storage/networks/osm_turn_restrictions.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

namespace macadam {

/// Takes the objects of an OSM file as they come. What it is given is valid during the call alone;
/// objects for which there is no function are passed over.
struct OsmVisitor {
    std::function<void(std::int64_t id, const PackedPoint& at)> node; ///< with a place on the globe
    std::function<void(std::int64_t id, const OsmTags& tags, std::span<const std::int64_t> nodes)>
        way;
    std::function<void(const OsmTags& tags, std::span<const OsmMember> members)> relation;
    std::function<void(std::uint64_t bytes)> pace; ///< of the file that are read; may throw
};

// Compressed maps are held to what maps are: a few times smaller than what they hold. Beyond the
// free bytes more is a bomb, and refused.

inline constexpr std::uint64_t max_pbf_expansion = 20; // real maps reach 4
inline constexpr std::uint64_t free_pbf_bytes = std::uint64_t{1} << 20U;
inline constexpr std::uint64_t max_xml_expansion = 100; // real maps reach 25
inline constexpr std::uint64_t free_xml_bytes = std::uint64_t{16} << 20U;

/// Reads .osm.pbf, block by block: raw or zlib blobs of at most 32 MiB, as the format has it.
///
/// \throws std::exception  with words for a file that is damaged or something else.
void visit_osm_pbf(const std::filesystem::path& file, const OsmVisitor& visitor);

/// Reads .osm, .osm.gz and .osm.bz2, also with the root <osmChange>, less what that deletes.
///
/// \throws std::exception  with words for a file that is damaged or something else.
void visit_osm_xml(const std::filesystem::path& file, const OsmVisitor& visitor);

} // namespace macadam
