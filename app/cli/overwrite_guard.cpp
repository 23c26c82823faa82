#include "app/cli/overwrite_guard.hpp"

#include "estimator/common/error.hpp"
#include "storage/store/schema/store_marker.hpp"

#include <fmt/format.h>

namespace fs = std::filesystem;

namespace macadam {

void refuse_to_replace(const fs::path& output, const std::vector<fs::path>& inputs) {
    std::error_code none;
    for (const auto& input : inputs) {
        if (fs::equivalent(output, input, none)) {
            throw InputError{fmt::format("{}: is also an input, expected another file to write "
                                         "to",
                                         output.string())};
        }
    }
    const auto target = fs::status(output, none);
    if (fs::exists(target) && !fs::is_regular_file(target) && !fs::is_directory(target)) {
        throw InputError{
            fmt::format("{}: is a device or pipe, expected a file to write to", output.string())};
    }
    if (output.extension() == ".gpkg" && fs::exists(output, none) && is_store(output)) {
        throw InputError{fmt::format("{}: is a road database, expected another file to write to",
                                     output.string())};
    }
}

} // namespace macadam
