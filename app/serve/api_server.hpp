#pragma once

#include "app/cli/console.hpp"
#include "app/export/site_export.hpp"
#include "app/http/http_server.hpp"
#include "app/query/section_options.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Address at which a server is reached.
struct ServedAddress {
    std::string base; ///< public address, without a slash at its end; "" = as the client names it
    bool has_access_log = false; ///< a line on standard output for each request
};

/// Whom a server serves, and how it works out the trips that it receives.
struct TripReception {
    std::size_t workers = 1;                 ///< threads; 0: `macadam worker` does it
    std::vector<std::string> import_words{}; ///< upload_arguments()
    std::string staff_header{};              ///< TripsApiConfig::staff_header
    std::string server{}; ///< address of the database whose copy the file is; "": it is no copy
    bool only_with_token = false; ///< also to read, but for the recorder, /health and /metrics
};

/// Serves a database until a stop is requested: OGC API, tiles, trips, /health and /metrics.
/// \param started   called with the port (0 for a Unix socket) when requests are answered
/// \param sections  those of the collection sections; `std::nullopt`: there is none
/// \param look      of the page and of picture tiles; without a title, the page has the name of the
///                  file
/// \throws InputError  if the file is no database or the address is in use.
void serve_database(const std::filesystem::path& file,
                    Audience audience,
                    const HttpServerConfig& config,
                    const ServedAddress& address,
                    const Console& console,
                    const std::function<void(std::uint16_t port)>& started,
                    const TripReception& reception = {},
                    const std::optional<SectionOptions>& sections = {},
                    const SiteLook& look = {});

/// Serves the files of a folder in the same way.
void serve_folder(const std::filesystem::path& folder,
                  const HttpServerConfig& config,
                  const ServedAddress& address,
                  const Console& console,
                  const std::function<void(std::uint16_t port)>& started);

} // namespace macadam
