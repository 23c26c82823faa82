#pragma once

#include "estimator/common/geo.hpp"
#include "mapping/fusion/segment_record.hpp"

#include <map>
#include <string>

namespace macadam {

/// A road of one name, for the search of a site.
struct SiteName {
    std::string name;
    SegmentKey first;
    GeoBox box;
    double length_m = 0;
    double iri_m = 0; ///< mm/m times m
};

/// Roads by their names, case-folded.
using SiteNames = std::map<std::string, SiteName>;

/// Adds a measured segment, unless its road has no name.
void add_name(SiteNames& names, const SegmentRecord& record);

std::string name_json(const SiteNames::value_type& name);

} // namespace macadam
