#include "app/site/site_page.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/plugin_library.hpp"

#include <system_error>

namespace macadam {

std::filesystem::path site_page_folder() {
    // From lib/ of a build folder, and from lib/macadam/plugins/ of an installation.
    for (const auto* const place : {"../share/macadam/site", "../../../share/macadam/site"}) {
        std::error_code missing;
        auto folder = std::filesystem::canonical(plugin_path(place), missing);
        if (!missing && std::filesystem::exists(folder / "index.html")) {
            return folder;
        }
    }
    throw InputError{"this build of the program has no web page; './run build' builds it, with the "
                     "packages that web/package-lock.json names"};
}

} // namespace macadam
