#include "render/report/words/catalogues.hpp"

#include <array>

// clang-format off: a line a message

namespace macadam {
namespace {

constexpr std::array messages{
    Message{"reference.title", "Cars compared with reference surveys"},
    Message{"reference.subtitle.one",
            "Over {count} section of {100_m_of} the cars have a mean bias of {bias} {unit} "
            "and an RMSE of {rmse}; {coverage} of the references are within their 90\u00A0% "
            "interval."},
    Message{"reference.subtitle.other",
            "Over {count} sections of {100_m_of} the cars have a mean bias of {bias} {unit} "
            "and an RMSE of {rmse}; {coverage} of the references are within their 90\u00A0% "
            "interval."},

    Message{"reference.surveys", "References"},
    Message{"reference.surveys.caption", "Surveys, IRI in {unit}; scores of sections of {100_m}"},
    Message{"reference.driven", "Cars drove there"},
    Message{"reference.surveyed", "; surveyed"},
    Message{"reference.days_not_known", "on unknown days"},
    Message{"reference.gap",
            "The cars' values are for the day of the latest pass over a segment: in the "
            "median {middle} the survey, at the earliest {least} and at the latest {most} it."},
    Message{"reference.days.one", "{count} day"},
    Message{"reference.days.other", "{count} days"},
    Message{"reference.months.one", "{count} month"},
    Message{"reference.months.other", "{count} months"},
    Message{"reference.years", "{count} years"},
    Message{"reference.before", "{length} before"},
    Message{"reference.after", "{length} after"},
    Message{"reference.column.survey", "Survey"},
    Message{"reference.column.measured", "Measured"},
    Message{"reference.column.good_to", "Accuracy"},
    Message{"reference.column.rows_m", "Row length, {short_unit}"},
    Message{"reference.not_known", "unknown"},

    Message{"reference.pieces", "Cars and references"},
    Message{"reference.pieces.none", "No car has driven where the references were measured."},
    Message{"reference.pieces.about",
            "Bias is cars minus reference. The interval is that of the cars only: errors of "
            "the reference itself count against it."},
    Message{"reference.pieces.hundreds", "Sections of {100_m}"},
    Message{"reference.pieces.segments", "Segments of {length} {short_unit}"},
    Message{"reference.pieces.left", "Left track, where both have it"},
    Message{"reference.pieces.right", "Right track, where both have it"},
    Message{"reference.pieces.too_long",
            "Rows of these surveys are much longer than a segment: single segments are not "
            "compared."},
    Message{"reference.column.level", "Reference, {unit}"},
    Message{"reference.column.pieces", "Sections"},
    Message{"reference.column.reference", "Reference"},
    Message{"reference.column.bias", "Bias"},
    Message{"reference.column.correlation", "Correlation"},
    Message{"reference.column.coverage", "In the 90\u00A0% interval"},
    Message{"reference.level", "{from} – {to}"},
    Message{"reference.level.last", "{from} and more"},

    Message{"reference.scatter.words",
            "IRI of the cars against IRI of the reference, {count} sections, 0 to {most} {unit}"},
    Message{"reference.scatter.across", "IRI of the reference, {unit}"},
    Message{"reference.scatter.up", "IRI of the cars, {unit}"},
    Message{"reference.differences.words",
            "Histograms of the difference between the cars' "
            "IRI and the reference"},
    Message{"reference.differences.part", "; {level} {unit}: mean {mean}, {count} sections"},

    Message{"reference.controls", "Control sections"},
    Message{"reference.controls.caption", "Control sections, IRI in {unit}, 90 % intervals"},
    Message{"reference.controls.about",
            "Sections of known roughness that are not part of the map. A drift is significant "
            "where the monthly trend of the difference exceeds twice its standard deviation."},
    Message{"reference.column.known", "Known"},
    Message{"reference.column.off", "Bias"},
    Message{"reference.column.drift", "Drift"},
    Message{"reference.drift.too_few", "too few months ({count})"},
    Message{"reference.drift.a_year", "{drift} ± {interval} per year"},
    Message{"reference.drift.drifts", "drifts"},
};

} // namespace

std::span<const Message> english_reference_messages() {
    return messages;
}

} // namespace macadam
