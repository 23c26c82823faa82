#include "app/cli/overwrite_guard.hpp"

#include "estimator/common/error.hpp"
#include "storage/store/road_store.hpp"

#include <fmt/format.h>

namespace fs = std::filesystem;

namespace macadam {

bool is_store(const fs::path& file) {
    try {
        RoadStore::open(file, RoadStore::Access::read);
        return true;
    } catch (const InputError&) {
        return false;
    }
}

void refuse_to_replace(const fs::path& output, const std::vector<fs::path>& inputs) {
    std::error_code none;
    for (const auto& input : inputs) {
        if (fs::equivalent(output, input, none)) {
            throw InputError{fmt::format("{}: is also an input, expected another file to write "
                                         "to",
                                         output.string())};
        }
    }
    if (output.extension() == ".gpkg" && fs::exists(output, none) && is_store(output)) {
        throw InputError{fmt::format("{}: is a road database, expected another file to write to",
                                     output.string())};
    }
}

} // namespace macadam
