#include "estimator/common/late_library.hpp"

#include "estimator/common/error.hpp"

#include <fmt/core.h>

#include <dlfcn.h>

namespace macadam {

void* late_symbol(const char* library, const char* symbol) {
    // dlopen counts its openings, so asking again for an open library is cheap and never closes it.
    void* const handle = dlopen(library, RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
        throw InputError{fmt::format("cannot open the library '{}': {}", library, dlerror())};
    }
    void* const found = dlsym(handle, symbol);
    if (found == nullptr) {
        throw InputError{fmt::format("the library '{}' has no function '{}'", library, symbol)};
    }
    return found;
}

} // namespace macadam
