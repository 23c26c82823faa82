#pragma once

#include "app/render/line_collector.hpp"
#include "render/map/map_plan.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Returns the rank of an OSM class for the width of lines, from motorway 0 to service 5.
int rank_of(std::string_view highway);

/// Returns whether a segment is drawn in grey. Segments known from references only have no passes
/// of cars and need none.
bool has_few_passes(std::int32_t passes, int min_passes);

/// Returns whether a line is drawn in full width: its standard deviation is at most half its value.
bool is_certain(IriUm iri_um, IriUm sd_um);

/// Returns the segments of a database that touch a box, in key order, with their classes. Segments
/// without a pass and those that the filter leaves out are roads without a measurement; those with
/// fewer than `min_passes` are marked. Segments known from references only are not marked.
///
/// \param filter             its box does not count
/// \param scale_denominator  of the map, for which segments are joined; 0: none are
std::vector<MapLine> map_lines(const StoreReader& store,
                               const GeoBox& box,
                               const ClassTable& classes,
                               int min_passes = 1,
                               const SegmentFilter& filter = {},
                               double scale_denominator = 0);

/// Returns the segments of a database that touch a box, in key order, as roads without a
/// measurement that `paint` may change.
std::vector<MapLine> map_lines(const StoreReader& store,
                               const GeoBox& box,
                               const std::function<void(const SegmentRecord&, MapLine&)>& paint,
                               const LineJoining& joining = {});

/// Returns a period for people: its first and last day.
std::string period_text(const ObservedPeriod& seen);

/// Request for a picture.
struct MapRequest {
    SegmentFilter filter{};  ///< box: what to show, `std::nullopt`: the extent of the selection
    std::string selection{}; ///< the filter in words, for the subtitle; "" = none
    std::optional<std::string> subtitle{}; ///< instead of period, length, trips and cars
    std::vector<double> class_km{};        ///< instead of the lengths of roughness classes
    std::string title{};
    MapStyle style{};                                            ///< includes the class table
    std::shared_ptr<const PlaneProjection> projection = nullptr; ///< null: spherical Mercator
    std::shared_ptr<const BaseMap> base = nullptr;               ///< null: none
    PictureSize size{};
    std::vector<PictureSize> other_sizes{}; ///< for size_for
    bool events = false;                    ///< also potholes and other events
    double scale_denominator = 0;           ///< 0: as large as fits
    bool insets = false;                    ///< for parts of the data far off the others
    bool details = false;                   ///< at larger scales, on a sheet empty for a third
    bool background = true; ///< water, green and the like, where the database has them
};

/// Returns the roads in a box, joined for a scale's denominator.
using LoadLines = std::function<std::vector<MapLine>(const GeoBox& box, double scale_denominator)>;

/// Plans a picture and loads its roads: the segments on it with their classes, the roads without a
/// measurement, and the text around them.
///
/// \param lines         of the map; empty: map_lines() of the request
/// \throws InputError  if the database has no segment in the box.
MapPlan load_map(const StoreReader& store, const MapRequest& request, const LoadLines& lines = {});

} // namespace macadam
