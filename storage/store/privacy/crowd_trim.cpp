#include "storage/store/privacy/crowd_trim.hpp"

namespace macadam {

TrimRule crowd_trim(const PrivacyKey& key) {
    return {.min_m = 300,
            .random_m = 200,
            .hides_places = true,
            .draw = [key](const std::string& trip_sha256, std::size_t n) {
                return key.draw(trip_sha256, "trim", n + 1).back();
            }};
}

} // namespace macadam
