#include "app/serve/ogc/collections.hpp"

#include "app/serve/features/feature_list.hpp"
#include "app/serve/features/trip_features.hpp"
#include "storage/exports/export.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace macadam {
namespace {

const std::vector<FeatureColumn>& segment_feature_columns() {
    static const auto columns = feature_columns(segment_columns());
    return columns;
}

constexpr std::string_view line = "geometry-linestring", point = "geometry-point";

constexpr std::array collections{
    Collection{"segments",
               "Road segments",
               "About 20 m of road in one direction with its roughness (IRI, mm/m), the 90 % "
               "interval, passes and cars",
               line,
               segment_feature_columns},
    Collection{"sections",
               "Sections",
               "The operator's own sections of road with their mean roughness",
               line,
               section_feature_columns},
    Collection{"worst",
               "Worst sections",
               "Sections of poor road, roughest first",
               line,
               worst_feature_columns},
    Collection{"events",
               "Potholes and other events",
               "Single defects, fused over passes",
               point,
               event_feature_columns},
    Collection{"trips",
               "Trips",
               "Trips of cars, without where they went; for the operator",
               "",
               trip_feature_columns,
               true}};

} // namespace

std::span<const Collection> known_collections() {
    return collections;
}

bool is_path_of_operator(std::string_view path) {
    return std::ranges::any_of(collections, [&](const Collection& collection) {
        const auto own = "/collections/" + std::string{collection.id};
        return collection.is_of_operator && (path == own || path.starts_with(own + "/"));
    });
}

} // namespace macadam
