#pragma once

#include <string>
#include <string_view>

namespace macadam {

/// Returns the function `symbol` of the shared object `library`, which is opened on first use and
/// stays open. "macadam_NAME.so" is opened in lib/ beside the program (or the Python module) that
/// contains this code or, where the program is installed, in ../lib/macadam/plugins/ from it, by
/// its absolute path; any other name is looked up in the system's library path.
///
/// MRPT and GDAL load more than a hundred shared objects each, and OSMesa loads a compiler.
/// Commands that need none of them should not wait for them.
///
/// \throws InputError  if it cannot be opened or has no such function; the message names both.
void* plugin_symbol(const char* library, const char* symbol);

/// Returns the absolute path of a file of the project that is kept where its plug-ins are, such as
/// a program.
std::string plugin_path(std::string_view file);

/// Typed version: `plugin_function<void(int)>("macadam_gdal.so", "name")(1)`.
template <typename Function>
Function* plugin_function(const char* library, const char* symbol) {
    return reinterpret_cast<Function*>(
        plugin_symbol(library, symbol)); // NOLINT(*-reinterpret-cast)
}

} // namespace macadam
