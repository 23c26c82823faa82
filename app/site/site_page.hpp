#pragma once

#include <filesystem>

namespace macadam {

/// Returns the folder of the web page that the build made of web/ (index.html, assets/): in
/// share/macadam/site beside the program or, where the program is installed, below the same prefix.
///
/// \throws InputError  if this build has no page; the message says how to build it.
std::filesystem::path site_page_folder();

} // namespace macadam
