#include "mapping/surveys/reference_passes.hpp"

#include "estimator/common/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace macadam {
namespace {

constexpr double min_overlap_m = 1; // of two rows: less is position error of the match

struct Part {
    const ReferencePart* part;
    const SurveyRow* row;
    ReferenceIri iri;
};

double length_m(const ReferencePart& part) {
    return part.to_m - part.from_m;
}

bool overlaps(const ReferencePart& a, const ReferencePart& b) {
    const double shared_m = std::min(a.to_m, b.to_m) - std::max(a.from_m, b.from_m);
    return shared_m > std::min(min_overlap_m, std::min(length_m(a), length_m(b)) / 2);
}

/// Disjoint parts of one pass over a segment.
using CoveringParts = std::vector<Part>;

void add_to_first_free(std::vector<CoveringParts>& coverings, const Part& part) {
    for (auto& covering : coverings) {
        if (std::ranges::none_of(
                covering, [&](const Part& other) { return overlaps(*other.part, *part.part); })) {
            covering.push_back(part);
            return;
        }
    }
    coverings.push_back({part});
}

double covered_m(const CoveringParts& covering) {
    double sum_m = 0;
    for (const auto& part : covering) {
        sum_m += length_m(*part.part);
    }
    return std::min(sum_m, covering.front().part->segment_m);
}

/// Computes the length-weighted mean of the parts' rows; `std::nullopt` if a row lacks the value.
template <typename Value>
std::optional<double> mean_of(const CoveringParts& covering, const Value& value) {
    double sum = 0, whole_m = 0;
    for (const auto& part : covering) {
        const std::optional<double> one = value(part);
        if (!one) {
            return std::nullopt;
        }
        sum += length_m(*part.part) * *one;
        whole_m += length_m(*part.part);
    }
    return sum / whole_m;
}

/// Returns the share of the road's scatter within rows that remains in the mean of these parts.
double scatter_share(const CoveringParts& covering) {
    const double whole_m = covered_m(covering);
    double share = 1 - whole_m / covering.front().part->segment_m;
    for (const auto& part : covering) {
        const double part_m = length_m(*part.part);
        const double row_m = std::max(part.part->row_m, part_m);
        share += std::pow(part_m / whole_m, 2) * (1 - part_m / row_m);
    }
    return share;
}

double relative_sd(const CoveringParts& covering, const ReferenceConfig& config) {
    const bool from_hri =
        std::ranges::any_of(covering, [](const Part& part) { return part.iri.from_hri; });
    return std::hypot(config.relative_sd,
                      config.within_row_relative_sd * std::sqrt(scatter_share(covering)),
                      from_hri ? sd_hri_over_mri / hri_over_mri : 0);
}

IriUm whole_um(double mm_per_m) {
    return static_cast<IriUm>(std::lround(mm_per_m * 1000));
}

std::optional<IriUm> known_um(const std::optional<double>& mm_per_m) {
    return mm_per_m ? std::optional{whole_um(*mm_per_m)} : std::nullopt;
}

Pass pass_of(const CoveringParts& covering,
             std::uint32_t occurrence,
             const ReferenceConfig& config) {
    const auto side = [&](std::optional<double> SurveyRow::*iri) {
        return known_um(mean_of(covering, [&](const Part& part) { return part.row->*iri; }));
    };
    const double iri =
        *mean_of(covering, [](const Part& part) { return std::optional{part.iri.mm_per_m}; });
    const double confidence =
        *mean_of(covering, [](const Part& part) { return std::optional{part.part->confidence}; });
    Pass pass{};
    pass.segment = covering.front().part->segment;
    pass.occurrence = occurrence;
    pass.iri_left_um = side(&SurveyRow::left_mm_per_m);
    pass.iri_right_um = side(&SurveyRow::right_mm_per_m);
    pass.iri_centre_um = side(&SurveyRow::hri_mm_per_m);
    pass.iri_um = whole_um(iri);
    pass.sd_um = std::max(1, whole_um(iri * relative_sd(covering, config)));
    pass.centre_only =
        std::ranges::any_of(covering, [](const Part& part) { return part.iri.from_hri; });
    pass.covered_mm = static_cast<std::int32_t>(std::lround(covered_m(covering) * 1000));
    pass.confidence_ppm = static_cast<std::int32_t>(std::lround(confidence * 1e6));
    return pass;
}

/// Returns the reason why a located row cannot enter a pass; "" if it can.
std::string_view fault_of(const SurveyRow& row) {
    if (headline_of(row)) {
        return "";
    }
    return row.left_mm_per_m || row.right_mm_per_m ? "one_track" : "no_iri";
}

} // namespace

ReferencePasses reference_passes(const ReferenceSurvey& survey,
                                 const LocatedReference& placed,
                                 const ReferenceConfig& config) {
    ReferencePasses all;
    std::map<SegmentKey, std::vector<CoveringParts>> segments;
    std::vector<std::string_view> reasons = placed.unplaced;
    std::map<std::size_t, double> lengths_m;
    for (const auto& part : placed.parts) {
        const auto& row = survey.rows[part.row].values;
        lengths_m[part.row] = part.row_m;
        all.placed_m += length_m(part);
        reasons[part.row] = fault_of(row);
        if (reasons[part.row].empty() && part.confidence < config.min_confidence) {
            reasons[part.row] = "unsure_match";
        } else if (reasons[part.row].empty()) {
            add_to_first_free(segments[part.segment], {&part, &row, *headline_of(row)});
        }
    }
    std::vector<bool> used(survey.rows.size(), false);
    for (const auto& [segment, coverings] : segments) {
        std::uint32_t occurrence = 0;
        for (const auto& covering : coverings) {
            if (covered_m(covering) < config.min_cover * covering.front().part->segment_m) {
                continue;
            }
            all.passes.push_back(pass_of(covering, occurrence++, config));
            for (const auto& part : covering) {
                used[part.part->row] = true;
            }
        }
    }
    for (std::size_t row = 0; row < used.size(); ++row) {
        if (used[row]) {
            ++all.used;
        } else {
            ++all.reasons[std::string{reasons[row].empty() ? "short_part" : reasons[row]}];
        }
    }
    std::vector<double> rows_m;
    for (const auto& [row, row_m] : lengths_m) {
        rows_m.push_back(row_m);
    }
    all.row_m = median(std::move(rows_m));
    return all;
}

} // namespace macadam
