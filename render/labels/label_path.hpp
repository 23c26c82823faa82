#pragma once

#include "render/labels/label_lines.hpp"

#include <optional>

namespace macadam {

/// Polyline with access to its points by distance from its start.
class LabelPath {
public:
    explicit LabelPath(std::span<const PixelPoint> line);

    double length_px() const { return until_px_.back(); }
    PixelPoint at(double along_px) const;

private:
    std::vector<PixelPoint> line_;
    std::vector<double> until_px_; ///< from the start to each point
};

/// Position of a label's cluster.
struct ClusterPose {
    PixelPoint from;  ///< left end of its baseline
    PixelPoint along; ///< direction of its baseline, of length 1
    double width_px;
};

/// Side of the road in reading direction.
enum class LabelSide { above, below };

/// Returns the distance of the baseline from the centre of the road, positive above and negative
/// below.
double
base_line_px(const TextLook& look, double half_width_px, const LabelConfig& config, LabelSide side);

/// Returns true if an interval of a path is read in its direction: from left to right, or straight
/// up.
bool reads_forward(const LabelPath& path, double from_px, double to_px);

/// Computes the baseline of names beside a road: `left_px` to its left (negative: right) along the
/// path. Kinks and bends shorter than `smooth_px` are rounded off, so that letters keep their
/// spacing.
LabelPath base_line(const LabelPath& road, double left_px, double smooth_px);

/// Places the clusters of a line along its baseline; `std::nullopt` if the baseline bends too much
/// or ends there.
///
/// \param middle_px  middle of the label, along the baseline
/// \param forward    read in the direction of the baseline
std::optional<std::vector<ClusterPose>> set_along(const LabelPath& base,
                                                  const SetLine& line,
                                                  double middle_px,
                                                  bool forward,
                                                  const LabelConfig& config);

/// Extent of letters above the baseline, from descenders to the top of capitals.
struct LetterExtent {
    double low_px, high_px;
};
LetterExtent letter_extent(const TextLook& look);

/// Returns the corners of a cluster's letters, from its descenders to the top of its capitals.
std::vector<PixelPoint> corners_of(const ClusterPose& place, const TextLook& look);

} // namespace macadam
