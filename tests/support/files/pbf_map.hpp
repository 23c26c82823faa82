#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace macadam::testing {

/// Writer of .osm.pbf files that accepts any content, including invalid content.
class PbfMap {
public:
    enum class Packing : std::uint8_t { raw, zlib };

    /// Node with its id and its position in 1e-7 degrees.
    struct Node {
        std::int64_t id;
        std::int64_t lat_e7;
        std::int64_t lon_e7;
    };
    PbfMap& nodes(const std::vector<Node>& nodes);

    /// Adds a residential road with that name.
    PbfMap&
    way(std::int64_t id, const std::vector<std::int64_t>& refs, const std::string& name = "");

    /// Adds a restriction over a node: no_entry, or only_straight_on if `only`.
    PbfMap& restriction(const std::vector<std::int64_t>& from,
                        std::int64_t via,
                        const std::vector<std::int64_t>& to,
                        bool only = false);

    /// Ends a block with everything added since the last.
    PbfMap& end_block(Packing packing = Packing::zlib);

    /// Adds a blob of any content.
    /// \param told_bytes  stated size after unpacking
    PbfMap&
    blob(std::string_view type, std::string_view content, Packing packing, std::int64_t told_bytes);

    /// Returns the whole file; ends the last block.
    std::string file();

private:
    std::uint32_t text(const std::string& text);

    std::string file_;
    std::string groups_;
    std::vector<std::string> texts_{""};
};

} // namespace macadam::testing
