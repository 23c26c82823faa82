#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/network/road_network.hpp"
#include "storage/networks/network_cut.hpp"
#include "storage/networks/osm_objects.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace macadam {

/// Tests for an OSM file by suffix: .pbf, .osm, .osm.xml, .osm.gz, .osm.bz2.
bool is_osm_file(const std::filesystem::path& file);

/// Reads all objects of an OSM file, as a blockwise or an XML file by its suffix.
///
/// \throws std::exception  with a message, for a damaged or different file.
void visit_osm(const std::filesystem::path& file, const OsmVisitor& visitor);

/// Positions of wanted nodes, gathered while a file is read.
class NodePositions {
public:
    /// Placeholder for nodes that are missing in the file.
    static constexpr PackedPoint nowhere{std::numeric_limits<std::int32_t>::max(), 0};

    /// \param ids  in rising order; must outlive the gathering
    explicit NodePositions(std::span<const std::int64_t> ids)
        : ids_{ids}, positions_(ids.size(), nowhere) {}

    void see(std::int64_t id, const PackedPoint& position);

    /// One position for each id; `nowhere` if missing in the file.
    std::vector<PackedPoint> found() && { return std::move(positions_); }

private:
    std::span<const std::int64_t> ids_;
    std::size_t at_ = 0;
    std::int64_t last_ = 0;
    std::vector<PackedPoint> positions_;
};

/// Ways that are omitted. Drivable ones are counted: they are no real roads and would be costly, or
/// have no positions.
struct LeftOutWays {
    std::size_t in_circles = 0;     ///< visit the same few nodes again and again
    std::size_t far_steps = 0;      ///< step between points longer than on any road
    std::size_t without_places = 0; ///< fewer than two points have positions
    std::set<std::string> closed{}; ///< values of highway of ways closed to cars, at most 8
};

/// Reads the drivable ways of an OSM file in the order of their ids, with their posted speed limits
/// and the turn restrictions over one node that apply to cars at all hours. Where the file lacks
/// nodes of a way, as at the border of an extract, the way is reduced to its longest part without a
/// missing node.
///
/// \param cut  if given, only ways with a node in its surroundings are read. It takes one more pass
///             over the file, and memory for the nodes there and the turn restrictions of all.
std::vector<Way> read_osm(const std::filesystem::path& file,
                          const Progress& progress,
                          LeftOutWays& left_out,
                          NetworkCut* cut = nullptr);

} // namespace macadam
