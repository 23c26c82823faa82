#include "mapping/network/network_arrays.hpp"

#include <algorithm>

namespace macadam {

std::optional<std::uint32_t> number_of_node(const std::vector<std::int64_t>& nodes,
                                            std::int64_t id) {
    const auto found = std::lower_bound(nodes.begin(), nodes.end(), id);
    return found != nodes.end() && *found == id
               ? std::optional{static_cast<std::uint32_t>(found - nodes.begin())}
               : std::nullopt;
}

} // namespace macadam
