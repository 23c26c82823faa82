#pragma once

#include <cstdint>
#include <vector>

namespace macadam {

/// Mark of what a reader sees at a moment, by which it later tells what has changed.
struct StoreMoment {
    std::int64_t maintenance = 0; ///< number of the last operation other than an import
    std::int64_t last_trip = 0;
    std::int64_t last_audit = 0;                ///< number of the last operation of any kind
    std::int64_t publication = 0;               ///< 0: none yet
    bool published_alone = false;               ///< see StoreReader::shows_published_alone()
    std::vector<std::int64_t> waiting_chunks{}; ///< with passes that are not yet fused
};

} // namespace macadam
