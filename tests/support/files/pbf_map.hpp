#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace macadam::testing {

/// Writes an .osm.pbf file as nobody should: whatever it is asked for.
class PbfMap {
public:
    enum class Packing : std::uint8_t { raw, zlib };

    /// Nodes with those ids at those places, in 1e-7 degrees.
    struct Node {
        std::int64_t id;
        std::int64_t lat_e7;
        std::int64_t lon_e7;
    };
    PbfMap& nodes(const std::vector<Node>& nodes);

    /// A residential road with that name.
    PbfMap&
    way(std::int64_t id, const std::vector<std::int64_t>& refs, const std::string& name = "");

    /// A no_entry or, of `only`, an only_straight_on restriction over a node.
    PbfMap& restriction(const std::vector<std::int64_t>& from,
                        std::int64_t via,
                        const std::vector<std::int64_t>& to,
                        bool only = false);

    /// Ends a block of what was added since the last.
    PbfMap& end_block(Packing packing = Packing::zlib);

    /// A blob of any content. \param told_bytes  that it says to unpack to
    PbfMap&
    blob(std::string_view type, std::string_view content, Packing packing, std::int64_t told_bytes);

    /// The whole file; ends the last block.
    std::string file();

private:
    std::uint32_t text(const std::string& text);

    std::string file_;
    std::string groups_;
    std::vector<std::string> texts_{""};
};

} // namespace macadam::testing
