#pragma once

namespace macadam {

/// The function `symbol` of the shared object `library`, which is opened when first asked for and
/// stays open. "macadam_NAME.so" is opened in lib/ beside the running program, by its absolute
/// path; any other name where the system keeps its libraries.
///
/// MRPT and GDAL bring more than a hundred shared objects each, OSMesa a compiler: a command that
/// needs none of them should not wait for them to load.
///
/// \throws InputError  if it cannot be opened or has no such function; the message names both.
void* plugin_symbol(const char* library, const char* symbol);

/// The same, typed: `plugin_function<void(int)>("macadam_geodesy.so", "name")(1)`.
template <typename Function>
Function* plugin_function(const char* library, const char* symbol) {
    return reinterpret_cast<Function*>(
        plugin_symbol(library, symbol)); // NOLINT(*-reinterpret-cast)
}

} // namespace macadam
