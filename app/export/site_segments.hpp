#pragma once

#include "app/export/site_folder.hpp"
#include "estimator/common/progress.hpp"
#include "mapping/fusion/segment_record.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "storage/store/records/segment_filter.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace macadam {

/// Segments of a site that one file holds: neighbours in the order of keys.
struct SiteShard {
    SegmentKey first, last;
    std::size_t count;
};

/// Shards and months by which a site's files of segments were divided.
struct SiteSegments {
    std::vector<SiteShard> shards;
    std::vector<std::string> months;
};

/// An earlier site of the same database, whose files serve again where nothing has changed.
struct EarlierSite {
    std::filesystem::path folder;
    SiteSegments segments;
    std::vector<SegmentRange> changed; ///< since then; they do not overlap
};

/// Cuts segments into shards of 128 to 512, in places that depend on the keys nearby: another
/// segment moves few of them.
///
/// \param records  in the order of keys
std::vector<SiteShard> shards_of(std::span<const SegmentRecord> records);

/// Writes the segments of a site with the values of each month, by shard and, for the comparison of
/// months, by tile: the same files with an earlier site and without.
///
/// \param records  measured segments, in the order of keys
/// \param months   ascending
/// \param earlier  null: none
/// \throws InputError  on a stop request, or if a file cannot be written.
SiteSegments write_segments(const StoreReader& store,
                            const SegmentFilter& filter,
                            std::span<const SegmentRecord> records,
                            const std::vector<std::string>& months,
                            const SiteFolder& folder,
                            const EarlierSite* earlier,
                            const Progress& progress);

/// Zoom of the tiles by which months are compared.
inline constexpr int compare_zoom = 14;

} // namespace macadam
