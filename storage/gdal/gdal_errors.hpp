#pragma once

#include <cpl_error.h>

#include <string>
#include <string_view>

namespace macadam {

/// GDAL's complaints go into our messages, not to the console.
class GdalErrorScope {
public:
    GdalErrorScope() {
        CPLPushErrorHandler(CPLQuietErrorHandler);
        CPLErrorReset();
    }
    GdalErrorScope(const GdalErrorScope&) = delete;
    GdalErrorScope& operator=(const GdalErrorScope&) = delete;
    ~GdalErrorScope() { CPLPopErrorHandler(); }
};

inline std::string gdal_error(std::string_view otherwise) {
    const char* const text = CPLGetLastErrorMsg();
    return text != nullptr && *text != '\0' ? text : std::string{otherwise};
}

} // namespace macadam
