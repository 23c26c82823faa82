#include "estimator/common/plugin_library.hpp"

#include "estimator/common/error.hpp"

#include <fmt/core.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>

#include <dlfcn.h>
#include <link.h>

namespace macadam {
namespace {

/// Returns the absolute path of a file without links; "" if there is none.
std::string resolved(const char* path) {
    struct Free {
        void operator()(char* text) const { std::free(text); } // NOLINT(*-no-malloc)
    };
    const std::unique_ptr<char, Free> found{::realpath(path, nullptr)};
    return found ? std::string{found.get()} : std::string{};
}

/// Returns the path of the file that has this code: the program, an extension module of another
/// program, or a plug-in that opens another one.
std::string own_file() {
    constexpr int known = 1;
    link_map* object = nullptr;
    Dl_info symbol{};
    if (dladdr1(reinterpret_cast<const void*>(&plugin_symbol), // NOLINT(*-reinterpret-cast)
                &symbol,
                reinterpret_cast<void**>(&object), // NOLINT(*-reinterpret-cast)
                RTLD_DL_LINKMAP) >= known &&
        object != nullptr && object->l_name != nullptr && *object->l_name != '\0') {
        return resolved(object->l_name);
    }
    auto program = resolved("/proc/self/exe");
    if (program.empty()) {
        throw InputError{
            "cannot find the program's folder with its libraries, expected /proc to be "
            "mounted"};
    }
    return program;
}

constexpr std::string_view our_prefix = "macadam_";

/// Returns the path of a library. The project's own libraries are in lib/ beside the program or
/// module in a build folder, in ../lib/macadam/plugins/ where the program is installed; neither a
/// search path nor an environment variable leads to others of the same name.
std::string path_of(std::string_view library) {
    if (!library.starts_with(our_prefix)) {
        return std::string{library};
    }
    return plugin_path(library);
}

} // namespace

std::string plugin_path(std::string_view name) {
    const auto file = own_file();
    const auto folder = file.substr(0, file.rfind('/'));
    if (std::string_view{file}.substr(folder.size() + 1).starts_with(our_prefix)) {
        return fmt::format("{}/{}", folder, name);
    }
    const auto beside = resolved(fmt::format("{}/lib/{}", folder, name).c_str());
    return beside.empty() ? fmt::format("{}/../lib/macadam/plugins/{}", folder, name) : beside;
}

void* plugin_symbol(const char* library, const char* symbol) {
    // dlopen counts its references, so opening a library again is cheap, and it is never closed.
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
