#pragma once

#include <cpl_error.h>

#include <string>
#include <string_view>

namespace macadam {

/// GDAL's complaints go into our messages, not to the console.
class Quiet {
public:
    Quiet() {
        CPLPushErrorHandler(CPLQuietErrorHandler);
        CPLErrorReset();
    }
    Quiet(const Quiet&) = delete;
    Quiet& operator=(const Quiet&) = delete;
    ~Quiet() { CPLPopErrorHandler(); }
};

inline std::string gdal_said(std::string_view otherwise) {
    const char* const text = CPLGetLastErrorMsg();
    return text != nullptr && *text != '\0' ? text : std::string{otherwise};
}

} // namespace macadam
