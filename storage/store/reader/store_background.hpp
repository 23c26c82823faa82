#pragma once

#include "mapping/background/background.hpp"
#include "mapping/background/background_levels.hpp"
#include "storage/store/background/background_rows.hpp"

#include <memory>
#include <vector>

namespace macadam {

struct StoreConnection;
class StoreReader;

/// Background of a road database that is a file: what maps show below its roads. Of one on a
/// server, which keeps it for copies alone, it is empty. It has a connection of its own.
///
/// \throws InputError  from every call, if it was modified by another program.
class StoreBackground {
public:
    explicit StoreBackground(const StoreReader& store);

    /// Reads the tiles of a level that meet a box; empty if there is no background.
    std::vector<BackgroundTile> tiles(const BackgroundLevel& level, const GeoBox& box) const;

    /// Reads the places within a box, the most important first.
    std::vector<PlaceName> places(const GeoBox& box) const;

    /// Reads the numbers of roads by way, rising.
    std::vector<RoadRef> road_refs() const;

    BackgroundSize size() const;

private:
    std::shared_ptr<StoreConnection> store_;
};

} // namespace macadam
