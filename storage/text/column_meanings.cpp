#include "storage/text/column_meanings.hpp"

#include <algorithm>
#include <array>

namespace macadam {
namespace {

struct Meaning {
    std::string_view column;
    std::string_view words;
};

constexpr std::array meanings{
    Meaning{"segment",
            "key of about 20 m of road in one direction: WAY+INDEX forward, WAY-INDEX "
            "backward"},
    Meaning{"section", "name of the section"},
    Meaning{"rank", "1 for the roughest section"},
    Meaning{"way_id", "id of the road in the map"},
    Meaning{"way_ids", "ids of the roads, one for each part"},
    Meaning{"name", "name of the road in the map"},
    Meaning{"highway", "class of the road in the map"},
    Meaning{"direction", "forward or backward along the way"},
    Meaning{"directions", "forward or backward along each way"},
    Meaning{"from", "begin, along the road or way"},
    Meaning{"to", "end, along the road or way"},
    Meaning{"way_from", "begin of each part along its way"},
    Meaning{"way_to", "end of each part along its way"},
    Meaning{"length", "length"},
    Meaning{"measured", "length with passes, without what is excluded"},
    Meaning{"excluded", "length that is excluded, such as bridges"},
    Meaning{"covered", "measured share of the length that is not excluded"},
    Meaning{"iri",
            "International Roughness Index: mean of both wheel tracks (MRI), on the day of "
            "the newest pass"},
    Meaning{"iri_sd", "standard deviation of iri"},
    Meaning{"iri_low", "lower end of the 90 % interval"},
    Meaning{"iri_high", "upper end of the 90 % interval"},
    Meaning{"iri_left", "IRI of the left wheel track, where observed"},
    Meaning{"iri_right", "IRI of the right wheel track, where observed"},
    Meaning{"iri_worst", "IRI of the roughest segment within"},
    Meaning{"index", "MRI, or HRI>MRI where MRI was inferred from HRI"},
    Meaning{"class", "class of roughness by the table of the database"},
    Meaning{"passes", "passes of cars"},
    Meaning{"passes_over", "passes that were searched there since the first report"},
    Meaning{"passes_least", "fewest passes of a segment within"},
    Meaning{"passes_median", "median of the passes of segments within"},
    Meaning{"vehicles", "number of cars"},
    Meaning{"first_seen", "day of the first dated pass, UTC"},
    Meaning{"last_seen", "day of the last dated pass, UTC"},
    Meaning{"trend_per_year", "change of iri a year, where passes span more than a year"},
    Meaning{"trend_sd", "standard deviation of trend_per_year"},
    Meaning{"changed", "day of the last step of the road (resurfaced, dug up), UTC"},
    Meaning{"change", "size of that step"},
    Meaning{"validity", "ok, or what holds for every pass"},
    Meaning{"lat_deg", "latitude of the middle, WGS 84"},
    Meaning{"lon_deg", "longitude of the middle, WGS 84"},
    Meaning{"kind", "pothole, bump, joint or rail"},
    Meaning{"severity", "by size: low, moderate or high"},
    Meaning{"track", "wheel track in driving direction"},
    Meaning{"size", "depth of a pothole, height or depth of the others"},
    Meaning{"size_sd", "standard deviation of the size"},
    Meaning{"place_sd", "standard deviation of the place along the road"},
    Meaning{"at", "along the way from its first node"}};

constexpr std::array<std::string_view, 8> unit_suffixes{
    "_in_per_mi", "_km", "_mi", "_ft", "_mm", "_in", "_m", "_mph"};

std::string_view exact_meaning(std::string_view name) {
    const auto* const found = std::ranges::find(meanings, name, &Meaning::column);
    return found != meanings.end() ? found->words : std::string_view{};
}

} // namespace

std::string_view meaning_of_column(std::string_view name) {
    if (const auto words = exact_meaning(name); !words.empty()) {
        return words;
    }
    for (const auto suffix : unit_suffixes) {
        if (name.ends_with(suffix)) {
            return exact_meaning(name.substr(0, name.size() - suffix.size()));
        }
    }
    return {};
}

} // namespace macadam
