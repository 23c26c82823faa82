#include "render/report/catalogues.hpp"

#include <array>

// clang-format off: a line a message

namespace macadam {
namespace {

constexpr std::array messages{
    Message{"reference.title", "Cars beside reference surveys"},
    Message{"reference.subtitle.one",
            "Over {count} piece of 100\u00A0m the cars alone are off by {bias} {unit} on average "
            "and {rmse} (RMSE) in a piece; {coverage} of the references lie within their "
            "90\u00A0% interval."},
    Message{"reference.subtitle.other",
            "Over {count} pieces of 100\u00A0m the cars alone are off by {bias} {unit} on average "
            "and {rmse} (RMSE) in a piece; {coverage} of the references lie within their "
            "90\u00A0% interval."},

    Message{"reference.surveys", "References"},
    Message{"reference.surveys.caption", "Surveys, IRI in {unit}; scores of pieces of 100 m"},
    Message{"reference.driven", "Cars drove there"},
    Message{"reference.surveyed", "; surveyed"},
    Message{"reference.days_not_known", "on days that are not known"},
    Message{"reference.gap",
            "The cars' values are of the day of a segment's newest pass: {middle} the survey in "
            "the middle, from {least} to {most} it."},
    Message{"reference.days.one", "{count} day"},
    Message{"reference.days.other", "{count} days"},
    Message{"reference.months.one", "{count} month"},
    Message{"reference.months.other", "{count} months"},
    Message{"reference.years", "{count} years"},
    Message{"reference.before", "{length} before"},
    Message{"reference.after", "{length} after"},
    Message{"reference.column.survey", "Survey"},
    Message{"reference.column.measured", "Measured"},
    Message{"reference.column.good_to", "Good to"},
    Message{"reference.column.rows_m", "Rows, m"},
    Message{"reference.not_known", "not known"},

    Message{"reference.pieces", "Cars beside references"},
    Message{"reference.pieces.none", "No car has driven where the references were measured."},
    Message{"reference.pieces.about",
            "Bias is cars less reference. The interval is that of the cars alone: what the "
            "reference itself is off by counts against it."},
    Message{"reference.pieces.hundreds", "Pieces of 100 m"},
    Message{"reference.pieces.segments", "Segments of {length} m"},
    Message{"reference.pieces.left", "Left track, where both know it"},
    Message{"reference.pieces.right", "Right track, where both know it"},
    Message{"reference.pieces.too_long",
            "Rows of these surveys are much longer than a segment: single segments are not "
            "compared."},
    Message{"reference.column.level", "Reference, {unit}"},
    Message{"reference.column.pieces", "Pieces"},
    Message{"reference.column.reference", "Reference"},
    Message{"reference.column.bias", "Bias"},
    Message{"reference.column.correlation", "Correlation"},
    Message{"reference.column.coverage", "In the 90\u00A0% interval"},
    Message{"reference.level", "{from} – {to}"},
    Message{"reference.level.last", "{from} and more"},

    Message{
        "reference.scatter.words",
        "IRI of the cars over IRI of the reference, {count} pieces of road, 0 to {most} {unit}"},
    Message{"reference.scatter.across", "IRI of the reference, {unit}"},
    Message{"reference.scatter.up", "IRI of the cars, {unit}"},
    Message{"reference.differences.words", "Histograms of the cars' IRI less the reference's"},
    Message{"reference.differences.part", "; {level} {unit}: mean {mean}, {count} pieces"},

    Message{"reference.controls", "Control sections"},
    Message{"reference.controls.caption", "Control sections, IRI in {unit}, 90 % intervals"},
    Message{"reference.controls.about",
            "Stretches of known roughness that do not enter the map. A drift is significant where "
            "the trend of the difference, month by month, is over twice its standard deviation."},
    Message{"reference.column.known", "Known"},
    Message{"reference.column.off", "Off by"},
    Message{"reference.column.drift", "Drift"},
    Message{"reference.drift.too_few", "too few months ({count})"},
    Message{"reference.drift.a_year", "{drift} ± {interval} a year"},
    Message{"reference.drift.drifts", "drifts"},
};

} // namespace

std::span<const Message> english_reference_messages() {
    return messages;
}

} // namespace macadam
