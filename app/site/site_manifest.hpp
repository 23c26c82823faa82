#pragma once

#include "app/site/site_totals.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Addresses of a site's data, each a member of site.json as JSON, relative to it.
struct SiteSources {
    std::string tiles;
    std::string segments;
    std::string names;
    std::string compare;
};

/// Description of a site (docs/reference/site.md).
struct SiteManifest {
    std::string title;
    bool left_hand = false;
    GeoBox bounds;
    std::size_t segments = 0;            ///< measured
    std::string digest{};                ///< changes with what is shown; "": to be computed
    std::vector<std::string> months;     ///< "2026-03", ascending
    std::string overview;                ///< picture of all roads; "" = none
    std::optional<GeoBox> first_picture; ///< bounds of first_light.png and first_dark.png
    std::string pictures{};              ///< address of picture tiles with {z}, {y}, {x}; "" = none
    SiteSources sources;
};

/// Formats site.json of what a reader shows now.
std::string
manifest_json(const StoreReader& store, const SiteManifest& manifest, const SiteTotals& totals);

/// Returns the months with trips; of a publication, those in which it has values. Ascending, at
/// most 120.
std::vector<std::string> site_months(const StoreReader& store);

/// Returns the period of a month, "2026-03".
Period period_of_month(const std::string& month);

} // namespace macadam
