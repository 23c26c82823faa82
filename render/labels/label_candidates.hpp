#pragma once

#include "render/labels/label_boxes.hpp"
#include "render/labels/label_lines.hpp"
#include "render/labels/label_occupancy.hpp"
#include "render/labels/label_path.hpp"
#include "render/labels/label_placement.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace macadam {

/// Baseline of a road's names: on its left or right, read along it or against it.
struct BaseLine {
    LabelPath path;
    LabelSide side;
    bool forward;
};

/// Text with what it names.
struct LabelSubject {
    enum class Kind { place, road_number, road_name };
    Kind kind;
    std::string name;
    TextLook look;
    bool quiet = false;
    SetLine line;
    std::optional<PointName> place{};   ///< of Kind::place, in pixels from the cell's corner
    std::optional<LabelPath> road{};    ///< of the others, likewise
    std::vector<BaseLine> base_lines{}; ///< of Kind::road_name
};

/// One label to place.
struct LabelTask {
    const LabelSubject* subject;
    double ideal_px = 0; ///< best position of the label's middle, along the road
    double reach_px = 0; ///< maximum distance from there
};

/// Possible position of a label.
struct LabelCandidate {
    std::vector<ClusterPose> places;
    std::vector<PixelBox> boxes; ///< of its letters with halo, or of its frame
    PixelBox box;                ///< union of boxes
    PixelPoint middle;
    double cost;
};

/// Possible positions of labels in a cell as far as they do not depend on other labels: within its
/// box, off areas kept free and the cores of junctions, not over too many roads. Distances are in
/// pixels from the cell's corner.
class LabelCandidates {
public:
    LabelCandidates(const LabelCell& cell,
                    const LabelConfig& config,
                    std::span<const NamedPart> parts);

    /// Visits the positions of a label from its ideal position outwards, up to those that cannot
    /// cost less than `limit`, which the visitor may lower.
    void visit(const LabelTask& task,
               double& limit,
               const std::function<void(LabelCandidate&&)>& visitor) const;

private:
    using Visitor = std::function<void(LabelCandidate&&)>;

    /// Shares of a label's area.
    struct Cover {
        double roads;    ///< weighted
        double measured; ///< on measured roads
    };
    void visit_around(const LabelSubject& subject, const Visitor& visitor) const;
    void visit_along(const LabelTask& task, double& limit, const Visitor& visitor) const;
    std::optional<LabelCandidate>
    beside_road(const LabelTask& task, double middle_px, const BaseLine& base) const;
    std::optional<LabelCandidate> on_road(const LabelTask& task, double middle_px) const;
    LabelCandidate upright(const LabelSubject& subject, const PixelPoint& left_end) const;
    void find_boxes(LabelCandidate& candidate, const TextLook& look) const;
    bool is_allowed(const LabelCandidate& candidate) const;
    bool is_on_core(const LabelCandidate& candidate, const TextLook& look) const;
    Cover covered(const LabelCandidate& candidate, const TextLook& look) const;

    PixelBox cell_; ///< from (0, 0)
    LabelConfig config_;
    OccupancyGrid ground_;
    std::vector<JunctionCore> cores_;
    BoxGrid cores_near_;
    std::vector<PixelBox> kept_free_;
};

/// Returns the frame of a road's number whose text has that size.
PixelBox shield_box(const ClusterPose& first, double text_px, const TextLook& look);

} // namespace macadam
