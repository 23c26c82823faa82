#pragma once

#include "render/labels/label_lines.hpp"

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

/// Whether a stretch of a path is read in its direction: from left to right, or straight up.
bool reads_forward(const LabelPath& path, double from_px, double to_px);

/// The base line of names beside a road: so far to its left (negative: right) along the path. Kinks
/// and bends shorter than `smooth_px` are rounded off, so that letters keep their distances.
LabelPath base_line(const LabelPath& road, double left_px, double smooth_px);

/// The clusters of a line along its base line; nothing if that bends too much there, or ends.
///
/// \param middle_px  of the label, along the base line
/// \param forward    read in the direction of the base line
std::optional<std::vector<SetPlace>> set_along(const LabelPath& base,
                                               const SetLine& line,
                                               double middle_px,
                                               bool forward,
                                               const LabelConfig& config);

/// The corners of a cluster's letters: from its descenders to its capitals' tops.
std::vector<PixelPoint> corners_of(const SetPlace& place, const TextLook& look);

} // namespace macadam
