#pragma once

#include "estimator/common/progress.hpp"
#include "storage/store/records/segment_filter.hpp"
#include "storage/store/server/copy/store_copy.hpp"

#include <filesystem>
#include <string>

namespace macadam {

/// Region of a map.
struct Region {
    SegmentFilter place; ///< a box, an area or both
    std::string words;   ///< as the user gave it, for the audit and messages
};

/// Cuts a region of a database on a server out into a new file: the chunks of which a segment lies
/// in it, with their passes, traces, events, values and publications, the trips that drove there
/// with their cars, and all settings. What is kept of roads: cut_down(). The key as
/// copy_from_server().
///
/// \throws InputError  if the file exists, or no road lies in the region.
StoreCopy cut_from_server(const std::string& address,
                          const Region& region,
                          const std::filesystem::path& file,
                          const Progress& progress);

} // namespace macadam
