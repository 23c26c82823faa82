#pragma once

#include "mapping/comparison/method_agreement.hpp"
#include "render/report/document/document.hpp"
#include "render/report/words/localised_text.hpp"

#include <cstddef>
#include <span>

namespace macadam {

/// Bland–Altman plot and the number of pairs outside its frame.
struct AgreementFigure {
    document::Drawing drawing;
    std::size_t outside;
};

/// Draws the difference a - b of each pair over the mean of both, with bias and limits of agreement
/// and their 95 % intervals. Rare differences far beyond the limits are outside the frame.
///
/// \param pairs      at least one; in the unit of `say`.
/// \param agreement  of these pairs.
AgreementFigure agreement_figure(std::span<const AgreementPair> pairs,
                                 const MethodAgreement& agreement,
                                 const Localisation& say);

} // namespace macadam
