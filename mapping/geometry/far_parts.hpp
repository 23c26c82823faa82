#pragma once

#include "estimator/common/geo.hpp"

#include <array>
#include <vector>

namespace macadam {

/// Gathers positions into parts that lie far apart: more than a tenth of the longer side of the box
/// around all.
class FarParts {
public:
    /// \param box  around all positions
    explicit FarParts(const GeoBox& box) : box_{box} {}

    void add(const GeoPoint& at, double weight);

    struct Part {
        GeoBox box; ///< around its positions
        double weight = 0;
    };

    /// Returns the parts, the one with the greatest weight first.
    std::vector<Part> parts() const;

private:
    static constexpr int side = 48; ///< in cells
    GeoBox box_;
    std::array<Part, std::size_t(side) * side> cells_{};
};

} // namespace macadam
