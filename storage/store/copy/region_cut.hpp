#pragma once

#include "estimator/common/progress.hpp"
#include "storage/sqlite/lock_wait_policy.hpp"
#include "storage/store/connection/store_connection.hpp"
#include "storage/store/copy/file_copy.hpp"
#include "storage/store/records/segment_filter.hpp"
#include "storage/store/rows/store_digest.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace macadam {

/// Region of a map.
struct Region {
    SegmentFilter place; ///< a box, an area or both
    std::string words;   ///< as the user gave it, for the audit and messages
};

/// Cuts a region of a database out into a new file, a database of its own: the chunks of which a
/// segment lies in it and what belongs to them (cut_out.hpp). The key beside the file is put
/// beside the new one.
///
/// \throws InputError  if the new file exists, no road lies in the region, or of a crowd the key
///                     is missing.
StoreCopy cut_from_file(const std::filesystem::path& from,
                        const Region& region,
                        const std::filesystem::path& file,
                        const LockWaitPolicy& wait_policy,
                        const Progress& progress);

/// Chunks of which a segment lies in a region, in the order of their keys.
std::vector<ChunkRows> chunks_in(StoreConnection& source, const Region& region);

/// Box of the ground that maps of a region show.
GeoBox ground_of(const Region& region);

/// \param roads  the box of all roads, "W,S,E,N"
[[noreturn]] void
refuse_empty_region(const std::string& database, const Region& region, const std::string& roads);

} // namespace macadam
