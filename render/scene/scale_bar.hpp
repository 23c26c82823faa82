#pragma once

#include <string>

namespace macadam {

struct ScaleBar {
    double length_m;
    double width_px;
    std::string label;
};

/// Returns the longest bar of a round length (1, 2 or 5 times a power of ten, in metres and
/// kilometres, or in feet and miles) that is no wider than `room_px`.
ScaleBar scale_bar(double metres_per_px, double room_px, bool miles);

} // namespace macadam
