#include "mapping/surveys/reference_survey.hpp"

#include "mapping/passes/pass.hpp"

namespace macadam {

std::optional<ReferenceIri> headline_of(const SurveyRow& row) {
    if (row.mri_mm_per_m) {
        return ReferenceIri{*row.mri_mm_per_m, false};
    }
    if (row.left_mm_per_m && row.right_mm_per_m) {
        return ReferenceIri{(*row.left_mm_per_m + *row.right_mm_per_m) / 2, false};
    }
    if (row.iri_mm_per_m) {
        return ReferenceIri{*row.iri_mm_per_m, false};
    }
    return row.hri_mm_per_m ? std::optional{ReferenceIri{*row.hri_mm_per_m / hri_over_mri, true}}
                            : std::nullopt;
}

} // namespace macadam
