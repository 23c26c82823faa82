#include "estimator/common/late_library.hpp"

#include "estimator/common/error.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <string_view>

#include <dlfcn.h>

namespace macadam {
namespace {

/// Our own libraries stand in lib/ beside the program; no search path, and no variable of the
/// environment, leads to others of their names.
std::filesystem::path path_of(std::string_view library) {
    constexpr std::string_view our_prefix = "macadam_";
    if (!library.starts_with(our_prefix)) {
        return library;
    }
    static const auto folder =
        std::filesystem::read_symlink("/proc/self/exe").parent_path() / "lib";
    return folder / library;
}

} // namespace

void* late_symbol(const char* library, const char* symbol) {
    // dlopen counts its openings, so asking again for an open library is cheap and never closes it.
    void* const handle = dlopen(path_of(library).c_str(), RTLD_NOW | RTLD_LOCAL);
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
