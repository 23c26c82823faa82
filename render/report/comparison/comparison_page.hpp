#pragma once

#include "mapping/comparison/method_agreement.hpp"
#include "mapping/comparison/profile_agreement.hpp"
#include "render/report/document/document.hpp"
#include "render/report/words/localised_text.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Name of a compared source, for readers.
struct SourceName {
    std::string name; ///< "roads.gpkg"
    std::string kind; ///< "road database"
    std::string car;  ///< "car 1": the only car; "" = all cars, or no cars
};

/// Segments that two sources share, and the others.
struct SharedSegments {
    double km = 0;
    std::size_t only_a = 0;
    std::size_t only_b = 0;
    std::size_t cut_differently = 0; ///< known to both, but at other places of the way
};

/// Agreement by one property: "Road class", or "Speed, km/h".
struct GroupedAgreement {
    std::string property;
    std::vector<AgreementGroup> groups;
};

/// Agreement of one wheel track.
struct ComparedTrack {
    std::string name;
    TrackAgreement agreement;
};

/// Comparison of two sources, as plain values.
struct SourceComparison {
    SourceName a;
    SourceName b;
    std::vector<AgreementPair> pairs;     ///< segments, or intervals of profiles
    MethodAgreement all;                  ///< of these pairs
    std::optional<SharedSegments> shared; ///< `std::nullopt`: profiles
    std::vector<GroupedAgreement> groups; ///< without properties that the sources do not know
    std::vector<ComparedTrack> tracks;    ///< of profiles
    double interval_m = 20;               ///< of profiles
    bool is_own = false;                  ///< a database of the operator's own cars is compared
    IriUnit unit = IriUnit::mm_per_m;     ///< of all IRI; in_per_mi: other lengths are shown as US
};

/// Converts the IRI of a comparison in mm/m.
SourceComparison in_per_mi(SourceComparison comparison);

/// Builds the document, in English.
Document comparison_document(const SourceComparison& comparison);

} // namespace macadam
