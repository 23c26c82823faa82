#include "storage/objects/object_store.hpp"

#include "estimator/common/error.hpp"
#include "storage/objects/folder_objects.hpp"
#include "storage/objects/s3_objects.hpp"
#include "storage/objects/s3_settings.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <utility>

namespace macadam {

std::unique_ptr<ObjectStore>
open_object_store(const std::string& location, std::stop_token stop, MissingFolder missing) {
    if (location.starts_with("s3://")) {
        return open_s3_objects(s3_settings_of(location), std::move(stop));
    }
    if (location.empty() || location.find("://") != std::string::npos) {
        throw InputError{fmt::format("the object store is {}, expected a folder or s3://BUCKET/"
                                     "PREFIX",
                                     in_quotes(location))};
    }
    return open_folder_objects(location, missing);
}

std::string absolute_location(const std::string& location) {
    return location.find("://") != std::string::npos
               ? location
               : std::filesystem::absolute(location).lexically_normal().string();
}

} // namespace macadam
