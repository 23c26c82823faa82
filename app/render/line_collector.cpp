#include "app/render/line_collector.hpp"

#include "mapping/geometry/line_simplification.hpp"
#include "mapping/geometry/nearest_point.hpp"
#include "render/roads/map_generalisation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

namespace macadam {
namespace {

bool same_place(const GeoPoint& a, const GeoPoint& b) {
    return a.lat_deg == b.lat_deg && a.lon_deg == b.lon_deg;
}

/// Adds a line that is driven after another, at a common point.
void append(std::vector<GeoPoint>& line, const std::vector<GeoPoint>& next) {
    line.insert(line.end(), next.begin() + 1, next.end());
}

} // namespace

LineJoining
joining_at(double scale_denominator, double segment_length_m, const ClassTable& classes) {
    constexpr double tolerance_mm = 0.05;
    constexpr double max_segments = 1000;
    const double m_per_mm = scale_denominator / 1000;
    const double segments = min_run_mm / 2 * m_per_mm / segment_length_m;
    return {static_cast<std::uint32_t>(std::clamp(segments, 1.0, max_segments)),
            &classes,
            tolerance_mm * m_per_mm};
}

/// Leaves out the bends of the last line that nobody sees.
void LineCollector::close() {
    if (joining_.segments == 1 || lines_.empty() || lines_.back().line.size() < 3) {
        return;
    }
    auto& line = lines_.back().line;
    const auto off_m = [&](std::size_t i, std::size_t from, std::size_t to) {
        return foot_on(std::array{line[from], line[to]}, line[i]).distance_m;
    };
    std::vector<bool> kept(line.size(), false);
    kept.front() = kept.back() = true;
    keep_bends(0, line.size() - 1, joining_.tolerance_m, off_m, kept);
    std::vector<GeoPoint> bends;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (kept[i]) {
            bends.push_back(line[i]);
        }
    }
    line = std::move(bends);
    line.shrink_to_fit();
}

bool LineCollector::continues(const Origin& origin, const MapLine& line) const {
    if (lines_.empty() || origins_.back().way_id != origin.way_id ||
        origins_.back().group != origin.group) {
        return false;
    }
    const auto& last = lines_.back();
    const bool has_mean = joining_.classes != nullptr && std::isfinite(last.iri_mm_per_m) &&
                          std::isfinite(line.iri_mm_per_m);
    return last.forward == line.forward && last.few_passes == line.few_passes &&
           (last.iri_class == line.iri_class || has_mean) &&
           (line.forward ? same_place(last.line.back(), line.line.front())
                         : same_place(line.line.back(), last.line.front()));
}

void LineCollector::join(double length_m, MapLine line) {
    auto& last = lines_.back();
    if (line.forward) {
        append(last.line, line.line);
    } else { // keys count against the driving direction
        append(line.line, last.line);
        last.line = std::move(line.line);
    }
    const double sum = last.iri_mm_per_m * length_m_ + line.iri_mm_per_m * length_m;
    length_m_ += length_m;
    last.iri_mm_per_m = sum / length_m_;
    if (std::isfinite(last.iri_mm_per_m) && joining_.classes != nullptr) {
        last.iri_class = static_cast<int>(class_index(*joining_.classes, last.iri_mm_per_m));
    }
    certain_m_ += line.certain ? length_m : 0;
    last.certain = 2 * certain_m_ >= length_m_;
}

void LineCollector::add(const Segment& segment, MapLine line) {
    const double length_m = segment.to_m - segment.from_m;
    const Origin origin{segment.key.way_id, segment.key.index / joining_.segments, lines_.size()};
    if (joining_.segments > 1 && continues(origin, line)) {
        join(length_m, std::move(line));
        return;
    }
    close();
    length_m_ = length_m;
    certain_m_ = line.certain ? length_m : 0;
    lines_.push_back(std::move(line));
    origins_.push_back(origin);
}

std::vector<MapLine> LineCollector::finished() && {
    close();
    const auto group_of = [](const Origin& origin) {
        return std::pair{origin.way_id, origin.group};
    };
    std::ranges::sort(origins_, {}, [](const Origin& origin) {
        return std::tuple{origin.way_id, origin.group, origin.line};
    });
    for (auto first = origins_.begin(); first != origins_.end();) {
        const auto past = std::find_if(first, origins_.end(), [&](const Origin& origin) {
            return group_of(origin) != group_of(*first);
        });
        const auto is_forward = [&](const Origin& origin) { return lines_[origin.line].forward; };
        const bool both_ways =
            std::any_of(first, past, is_forward) && !std::all_of(first, past, is_forward);
        for (; first != past; ++first) {
            lines_[first->line].both_ways = both_ways;
        }
    }
    return std::move(lines_);
}

} // namespace macadam
