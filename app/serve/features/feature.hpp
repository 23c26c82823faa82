#pragma once

#include "app/serve/features/coordinate_reference.hpp"
#include "estimator/common/geo.hpp"
#include "storage/text/columns.hpp"

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Column of features whatever their rows are; `value` takes a pointer to a row.
struct FeatureColumn {
    std::string name;
    ColumnType type;
    std::function<Cell(const void*)> value;
    std::string member; ///< beginning of its member of a JSON object: "name":
};

/// Columns that JSON has, of rows of one kind.
template <typename Row>
std::vector<FeatureColumn> feature_columns(const Columns<Row>& columns) {
    std::vector<FeatureColumn> erased;
    for (const auto& column : columns) {
        if (is_in(column, ColumnType::Formats::json)) {
            erased.push_back({std::string{column.name},
                              column.type,
                              [value = column.value](const void* row) {
                                  return value(*static_cast<const Row*>(row));
                              },
                              json_text(column.name) + ":"});
        }
    }
    return erased;
}

/// Feature of a collection. It refers to a row and a line that outlive it.
struct Feature {
    std::string id;
    std::span<const GeoPoint> line; ///< one point for events; empty: it has no geometry
    bool is_point = false;
    const void* row = nullptr;
};

/// Condition on features.
using FeatureTest = std::function<bool(const Feature&)>;

/// Appends a feature as GeoJSON on one line, as exports do.
void append_feature(std::string& text,
                    const Feature& feature,
                    std::span<const FeatureColumn> columns,
                    CoordinateReference crs,
                    std::string_view links = {});

/// Tests whether a cell holds the value that a text names: equal text, or an equal number.
bool equals_text(const ColumnType& type, const Cell& cell, std::string_view text);

} // namespace macadam
