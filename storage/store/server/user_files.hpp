#pragma once

#include <filesystem>
#include <string>

namespace macadam {

// Files of this user that belong to databases on servers.

/// File of the key of a database on a server, which the server never sees:
/// $XDG_CONFIG_HOME/macadam/keys/ID.key, else in ~/.config.
///
/// \param key_id  PrivacyKey::id()
/// \throws InputError  if that is no id, or there is no home folder.
std::filesystem::path server_key_file(const std::string& key_id);

/// File in which the roads and settings of a database are kept, as the server at this address gave
/// them: $XDG_CACHE_HOME/macadam/networks/NAME.gpkg, else in ~/.cache.
///
/// \param rows  name of the network's rows, as the server states it: another one may state the same
/// \throws InputError  if it is none, or there is no home folder.
std::filesystem::path network_image_file(const std::string& address, const std::string& rows);

/// Folder in which copies of databases are kept for their next reader:
/// $XDG_CACHE_HOME/macadam/copies, else in ~/.cache.
///
/// \throws InputError  if there is no home folder.
std::filesystem::path mirror_folder();

} // namespace macadam
