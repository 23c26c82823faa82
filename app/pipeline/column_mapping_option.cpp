#include "app/pipeline/column_mapping_option.hpp"

#include "storage/trips/mappings/column_mapping_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace macadam {

std::shared_ptr<const TripMapping> mapping_of(const Arguments& arguments) {
    const auto name = arguments.value("--mapping");
    if (!name) {
        return nullptr;
    }
    const auto built_in = built_in_mapping_names();
    if (std::ranges::find(built_in, *name) == built_in.end() && !std::filesystem::exists(*name) &&
        !name->ends_with(".toml")) {
        throw UsageError{fmt::format("--mapping is '{}', expected a TOML file or one of {}",
                                     *name,
                                     fmt::join(built_in, ", "))};
    }
    return std::make_shared<const TripMapping>(read_mapping(*name));
}

} // namespace macadam
