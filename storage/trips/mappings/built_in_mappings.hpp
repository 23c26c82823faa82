#pragma once

#include <span>
#include <string_view>

namespace macadam {

struct BuiltInMapping {
    std::string_view name;
    std::string_view toml;
    std::string_view first_line; ///< prefix by which a file of the logger is recognised
};

/// Mappings for loggers with a fixed layout.
std::span<const BuiltInMapping> built_in_mappings();

} // namespace macadam
