#include "storage/pseudonym.hpp"

#include "storage/sha256.hpp"

namespace macadam {

std::string pseudonym_of(const std::string& vehicle_id) {
    if (vehicle_id.empty()) {
        return "unknown";
    }
    Sha256 hash;
    hash.add(vehicle_id);
    return "v-" + hash.hex().substr(0, 12);
}

} // namespace macadam
