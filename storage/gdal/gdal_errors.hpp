#pragma once

#include <cpl_error.h>

#include <string>
#include <string_view>

namespace macadam {

/// Captures GDAL's error messages for our own messages and keeps them off the console.
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
