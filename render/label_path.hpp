#pragma once

#include "render/label_roads.hpp"

#include <optional>

namespace macadam {

/// A line that is asked for its points by distance from its start.
class LabelPath {
public:
    explicit LabelPath(std::span<const PixelPoint> line);

    double length_px() const { return until_px_.back(); }
    PixelPoint at(double along_px) const;

private:
    std::vector<PixelPoint> line_;
    std::vector<double> until_px_; ///< from the start to each point
};

/// A cluster of a label where it stands.
struct SetPlace {
    PixelPoint from;  ///< left end of its base line
    PixelPoint along; ///< direction of its base line, of length 1
    double width_px;
};

/// On which side of the road as it is read.
enum class LabelSide { above, below };

/// How far the base line is from the middle of the road, above it or (negative) below.
double
base_line_px(const TextLook& look, double half_width_px, const LabelConfig& config, LabelSide side);

/// The clusters of a line along a path, read from left to right (straight up if neither is left);
/// nothing if the path bends too much there, or ends.
///
/// \param middle_px  of the label, along the path
/// \param beside_px  from the path to the base line, upwards as read
std::optional<std::vector<SetPlace>> set_along(const LabelPath& path,
                                               const SetLine& line,
                                               double middle_px,
                                               double beside_px,
                                               const LabelConfig& config);

/// The corners of a cluster's letters: from its descenders to its capitals' tops.
std::vector<PixelPoint> corners_of(const SetPlace& place, const TextLook& look);

} // namespace macadam
