#pragma once

#include "app/serve/features/feature_list.hpp"
#include "app/serve/ogc/api_context.hpp"
#include "app/serve/ogc/per_version.hpp"
#include "app/serve/ogc/segment_selections.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// OGC API - Features, Parts 1 to 3, of the collections segments, worst and events.
///
/// Sources: OGC 17-069r4, 18-058r1, 19-079r2.
class FeaturesApi {
public:
    /// Each of these throws UsageError for a bad parameter and InputError for what the database
    /// refuses. Unknown collections and features are a response of status 404.
    HttpResponse collections(const ApiContext& context);
    HttpResponse collection(const ApiContext& context, std::string_view id);
    static HttpResponse queryables(const ApiContext& context, std::string_view id);
    HttpResponse items(const ApiContext& context, std::string_view id);
    HttpResponse item(const ApiContext& context, std::string_view id, const std::string& feature);

private:
    struct Extent {
        GeoBox box;
        ObservedPeriod seen;
    };
    std::string collection_text(const ApiContext& context, std::string_view id);
    HttpResponse segment_items(const ApiContext& context);
    HttpResponse list_items(const ApiContext& context, std::string_view id);
    std::shared_ptr<const FeatureList> list(const ApiContext& context, std::string_view id);

    SegmentSelections selections_;
    PerVersion<Extent> extent_;
    PerVersion<FeatureList> worst_, events_;
};

/// Names of the collections.
std::vector<std::string_view> collection_ids();

} // namespace macadam
