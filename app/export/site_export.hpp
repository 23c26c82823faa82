#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "app/export/site_segments.hpp"
#include "app/tiles/tile_pyramid.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <filesystem>
#include <string>

namespace macadam {

inline constexpr Option site_title_option =
    in_group("site", {"--title", "TEXT", "Title of --format site.", "the database's name"});

/// Look of a site.
struct SiteLook {
    std::string title;
    bool left_hand = false; ///< traffic keeps left, and so does each direction on maps
};

/// Parses --title and --left-hand of a command that has them.
SiteLook parse_site_look(const Arguments& arguments, const std::filesystem::path& store);

/// Settings of a site.
struct SitePlan {
    SiteLook look;
    TilePlan tiles;
    std::string served_version{};         ///< of the tiles of a server; "": the site has its own
    const EarlierSite* earlier = nullptr; ///< must outlive the export; null: none
};

/// Writes the measured segments as a web page with all its data (docs/reference/site.md) into a
/// new or empty folder, and reports what it has. Files have a bounded size: lists that grow are
/// cut into several.
///
/// \returns what an EarlierSite of this one needs
/// \throws InputError  without a page in this build, and for a selection without measured segments.
SiteSegments export_site(const StoreReader& store,
                         const SegmentFilter& filter,
                         const std::filesystem::path& folder,
                         const SitePlan& plan,
                         const Console& console);

} // namespace macadam
