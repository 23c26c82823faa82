#pragma once

#include <filesystem>
#include <string>

namespace macadam::testing {

/// Copies a database made by version 2 of the program (tests/data/stores): five trips of van-7 and
/// van-8.
/// \returns  the file
std::filesystem::path put_store_of_version_2(const std::filesystem::path& folder,
                                             const std::string& name = "roads.gpkg");

/// Digest that version 2 printed for that database.
inline constexpr const char* digest_of_version_2 =
    "ed3c183c32fabb04ab290dd571b022bc3d55f51c9b212456c9c7cd3af529ee7b";

} // namespace macadam::testing
