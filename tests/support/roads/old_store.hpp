#pragma once

#include <filesystem>
#include <string>

namespace macadam::testing {

/// A store that the program of version 2 made (tests/data/stores): five trips of van-7 and van-8.
/// \returns the file.
std::filesystem::path put_store_of_version_2(const std::filesystem::path& folder,
                                             const std::string& name = "roads.gpkg");

/// What that program said of it.
inline constexpr const char* digest_of_version_2 =
    "ed3c183c32fabb04ab290dd571b022bc3d55f51c9b212456c9c7cd3af529ee7b";

} // namespace macadam::testing
