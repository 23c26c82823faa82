#pragma once

#include "app/serve/features/feature.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace macadam {

/// Collection of features that a server can have.
struct Collection {
    std::string_view id, title, description;
    std::string_view geometry; ///< "geometry-linestring", "geometry-point"; "" = none
    const std::vector<FeatureColumn>& (*columns)();
    bool is_of_operator = false; ///< shown to nobody else
};

/// All of them, in the order in which they are listed.
std::span<const Collection> known_collections();

/// Tests for a path that shows what is for the operator alone.
bool is_path_of_operator(std::string_view path);

} // namespace macadam
