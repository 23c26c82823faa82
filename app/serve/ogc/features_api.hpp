#pragma once

#include "app/query/section_options.hpp"
#include "app/serve/features/feature_list.hpp"
#include "app/serve/ogc/api_context.hpp"
#include "app/serve/ogc/collections.hpp"
#include "app/serve/ogc/per_version.hpp"
#include "app/serve/ogc/segment_selections.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {

/// OGC API - Features, Parts 1 to 3, of the collections that a server has (collections.hpp).
///
/// Sources: OGC 17-069r4, 18-058r1, 19-079r2.
class FeaturesApi {
public:
    /// \param sections  those of the collection sections, which is missing without them
    explicit FeaturesApi(std::optional<SectionOptions> sections = {})
        : sections_options_{std::move(sections)} {}

    /// Each of these throws UsageError for a bad parameter and InputError for what the database
    /// refuses. Unknown collections and features are a response of status 404.
    HttpResponse collections(const ApiContext& context);
    HttpResponse collection(const ApiContext& context, std::string_view id);
    HttpResponse queryables(const ApiContext& context, std::string_view id) const;
    HttpResponse items(const ApiContext& context, std::string_view id);
    HttpResponse item(const ApiContext& context, std::string_view id, const std::string& feature);

    /// Makes ready what was asked of the version before; for a thread of its own.
    /// \throws InputError
    void prepare(const StoreReader& store, const std::string& version) {
        selections_.prepare(store, version);
    }

    /// Collections that a request may see.
    std::vector<const Collection*> collections_for(bool is_operator) const;

private:
    struct Extent {
        GeoBox box;
        ObservedPeriod seen;
    };
    const Collection* find(const ApiContext& context, std::string_view id) const;
    std::string collection_text(const ApiContext& context, const Collection& collection);
    HttpResponse segment_items(const ApiContext& context, const Collection& collection);
    HttpResponse list_items(const ApiContext& context, const Collection& collection);
    std::shared_ptr<const FeatureList> list(const ApiContext& context, std::string_view id);
    FeatureList sections(const StoreReader& store) const;

    std::optional<SectionOptions> sections_options_;
    SegmentSelections selections_;
    PerVersion<Extent> extent_;
    PerVersion<FeatureList> worst_, events_, sections_, trips_;
};

} // namespace macadam
