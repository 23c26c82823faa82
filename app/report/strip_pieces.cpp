#include "app/report/strip_pieces.hpp"

#include <algorithm>
#include <span>

namespace macadam {

StripPiece
strip_piece(const RatedLength& rated, const ClassTable& classes, double from_m, double to_m) {
    const auto mean = road_mean(std::span{&rated, 1});
    return {.from_m = from_m,
            .to_m = to_m,
            .iri = mean.iri,
            .low = mean.low,
            .high = mean.high,
            .iri_class = class_index(classes, mean.iri)};
}

std::vector<StripPiece> strip_of(const WorstSection& section,
                                 const std::vector<MeasuredSegment>& measured,
                                 const ClassTable& classes) {
    std::vector<StripPiece> strip;
    for (const auto i : section.records) {
        const auto& segment = measured[i];
        double before_m = 0;
        for (const auto& part : section.parts) {
            if (part.way_id == segment.key.way_id && part.forward == segment.key.forward &&
                segment.from_m < part.to_m && part.from_m < segment.to_m) {
                const double from_m = before_m + (part.forward ? segment.from_m - part.from_m
                                                               : part.to_m - segment.to_m);
                strip.push_back(strip_piece(rated_length(segment),
                                            classes,
                                            from_m,
                                            from_m + segment.to_m - segment.from_m));
                break;
            }
            before_m += part.to_m - part.from_m;
        }
    }
    std::ranges::sort(strip, {}, &StripPiece::from_m);
    return strip;
}

} // namespace macadam
