#include "app/site/site_manifest.hpp"

#include "app/site/site_json.hpp"
#include "mapping/style/class_colours.hpp"
#include "render/report/words/messages.hpp"
#include "storage/store/reader/store_background.hpp"
#include "storage/text/json.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <set>

namespace macadam {
namespace {

constexpr std::size_t max_months = 120;
constexpr std::int64_t day_ms = 86'400'000;

std::string month_of(std::int64_t utc_ms) {
    return utc_day(utc_ms).substr(0, 7);
}

std::string month_after(const std::string& month) {
    return month_of(*period_of_month(month).from_ms + 32 * day_ms);
}

JsonValue day(std::optional<std::int64_t> utc_ms) {
    return utc_ms ? JsonValue{utc_day(*utc_ms)} : nullptr;
}

std::string classes_json(const ClassTable& classes) {
    std::vector<std::string> rows;
    for (const auto& each : classes.classes) {
        rows.push_back(
            JsonObject{}
                .add("name", std::string{each.name})
                .add("below", json_number(each.to_mm_per_m, 4))
                .add("colour",
                     fmt::format("#{:06x}", class_rgb(rows.size(), classes.classes.size())))
                .text());
    }
    return json_array(rows);
}

/// Returns a text that changes with what is shown, and with nothing else: the digest of a database
/// would tell of data that is not yet published.
std::string digest_of(const StoreReader& store, const std::optional<Publication>& publication) {
    return store.shows_published_alone()
               ? fmt::format("publication-{}", publication ? publication->number : 0)
               : store.digest();
}

JsonValue published_json(const std::optional<Publication>& publication) {
    if (!publication) {
        return nullptr;
    }
    return JsonRaw{
        JsonObject{}.add("number", publication->number).add("month", publication->month).text()};
}

/// Tests whether any segment has a value of a month; often none has, for a publication needs five
/// cars in it.
bool has_values(const StoreReader& store, const std::string& month) {
    bool found = false;
    SegmentFilter filter;
    filter.period = period_of_month(month);
    store.visit(
        filter,
        [&](const SegmentRecord& record) { found = found || record.state.has_value(); },
        StateDetail::tiles);
    return found;
}

} // namespace

std::string
manifest_json(const StoreReader& store, const SiteManifest& manifest, const SiteTotals& totals) {
    const auto& settings = store.settings();
    const auto seen = store.seen();
    const auto publication =
        store.shows_published_alone() ? store.latest_publication() : std::nullopt;
    std::vector<std::string> codes;
    for (const auto* const each : languages()) {
        codes.push_back(each->code);
    }
    return JsonObject{}
        .add("format", "macadam-site 1")
        .add("title", manifest.title)
        .add("digest", manifest.digest.empty() ? digest_of(store, publication) : manifest.digest)
        .add("published", published_json(publication))
        .add("first_seen", day(seen.first_ms))
        .add("last_seen", day(seen.last_ms))
        .add("attribution", settings.attribution)
        .add("left_hand", manifest.left_hand)
        .add("bounds", JsonRaw{box_json(manifest.bounds)})
        .add("segments_count", static_cast<std::int64_t>(manifest.segments))
        .add("km", JsonNumber{totals.km(), 3})
        .add("languages", JsonRaw{json_string_array(codes)})
        .add("classes", JsonRaw{classes_json(*class_table(settings.class_table))})
        .add("highways", JsonRaw{json_string_array(totals.highways())})
        .add("tiles", JsonRaw{manifest.sources.tiles})
        .add("background", !StoreBackground{store}.size().is_empty())
        .add("segments", JsonRaw{manifest.sources.segments})
        .add("names", JsonRaw{manifest.sources.names})
        .add("worst", "worst.json")
        .add("totals", "totals.json")
        .add("overview", manifest.overview.empty() ? JsonValue{nullptr} : manifest.overview)
        .add("first_picture",
             JsonRaw{manifest.first_picture ? box_json(*manifest.first_picture) : "null"})
        .add("pictures", manifest.pictures.empty() ? JsonValue{nullptr} : manifest.pictures)
        .add("months", JsonRaw{json_string_array(manifest.months)})
        .add("compare", JsonRaw{manifest.sources.compare})
        .text();
}

std::vector<std::string> site_months(const StoreReader& store) {
    std::set<std::string> months;
    if (store.shows_published_alone()) {
        const auto seen = store.seen();
        if (seen.first_ms && seen.last_ms) {
            const auto last = month_of(*seen.last_ms);
            for (auto month = month_of(*seen.first_ms); month <= last && months.size() < max_months;
                 month = month_after(month)) {
                if (has_values(store, month)) {
                    months.insert(month);
                }
            }
        }
    } else {
        for (const auto& day : store.usage().days) {
            months.insert(day.day.substr(0, 7));
        }
    }
    while (months.size() > max_months) {
        months.erase(months.begin());
    }
    return {months.begin(), months.end()};
}

Period period_of_month(const std::string& month) {
    const auto begin_ms = [](const std::string& text) {
        return std::llround(*parse_utc_s(text + "-01T00:00:00Z") * 1000);
    };
    const auto from_ms = begin_ms(month);
    return {from_ms, begin_ms(month_of(from_ms + 32 * day_ms))};
}

} // namespace macadam
