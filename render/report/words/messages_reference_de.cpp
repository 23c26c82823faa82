#include "render/report/words/catalogues.hpp"

#include <array>

// clang-format off: a line a message

namespace macadam {
namespace {

constexpr std::array messages{
    Message{"reference.title", "Fahrzeuge und Referenzmessungen"},
    Message{"reference.subtitle.one",
            "Auf {count} Stück von {100_m_of} weichen die Fahrzeuge allein im Mittel um {bias} "
            "{unit} ab und je Stück um {rmse} (RMSE); {coverage} der Referenzwerte liegen in ihrem "
            "90-%-Intervall."},
    Message{"reference.subtitle.other",
            "Auf {count} Stücken von {100_m_of} weichen die Fahrzeuge allein im Mittel um {bias} "
            "{unit} ab und je Stück um {rmse} (RMSE); {coverage} der Referenzwerte liegen in ihrem "
            "90-%-Intervall."},

    Message{"reference.surveys", "Referenzmessungen"},
    Message{"reference.surveys.caption",
            "Messungen, IRI in {unit}; verglichen auf Stücken von {100_m}"},
    Message{"reference.driven", "Befahren"},
    Message{"reference.surveyed", "; gemessen"},
    Message{"reference.days_not_known", "an unbekannten Tagen"},
    Message{"reference.gap",
            "Die Werte der Fahrzeuge gelten für den Tag der jüngsten Überfahrt eines Abschnitts: "
            "im Median {middle} der Messung, frühestens {least}, spätestens {most} ihr."},
    Message{"reference.days.one", "{count} Tag"},
    Message{"reference.days.other", "{count} Tage"},
    Message{"reference.months.one", "{count} Monat"},
    Message{"reference.months.other", "{count} Monate"},
    Message{"reference.years", "{count} Jahre"},
    Message{"reference.before", "{length} vor"},
    Message{"reference.after", "{length} nach"},
    Message{"reference.column.survey", "Messung"},
    Message{"reference.column.measured", "Gemessen"},
    Message{"reference.column.good_to", "Genauigkeit"},
    Message{"reference.column.rows_m", "Zeilenlänge, {short_unit}"},
    Message{"reference.not_known", "unbekannt"},

    Message{"reference.pieces", "Fahrzeuge neben Referenzen"},
    Message{"reference.pieces.none",
            "Kein Fahrzeug ist dort gefahren, wo die Referenzen gemessen wurden."},
    Message{"reference.pieces.about",
            "Abweichung: Fahrzeuge weniger Referenz. Das Intervall ist das der Fahrzeuge allein: "
            "Fehler der Referenz selbst zählen gegen das Intervall."},
    Message{"reference.pieces.hundreds", "Stücke von {100_m}"},
    Message{"reference.pieces.segments", "Abschnitte von {length} {short_unit}"},
    Message{"reference.pieces.left", "Linke Spur, wo beide sie kennen"},
    Message{"reference.pieces.right", "Rechte Spur, wo beide sie kennen"},
    Message{"reference.pieces.too_long",
            "Die Zeilen dieser Messungen sind viel länger als ein Abschnitt: Einzelne Abschnitte "
            "werden nicht verglichen."},
    Message{"reference.column.level", "Referenz, {unit}"},
    Message{"reference.column.pieces", "Stücke"},
    Message{"reference.column.reference", "Referenz"},
    Message{"reference.column.bias", "Abweichung"},
    Message{"reference.column.correlation", "Korrelation"},
    Message{"reference.column.coverage", "Im 90-%-Intervall"},
    Message{"reference.level", "{from} – {to}"},
    Message{"reference.level.last", "ab {from}"},

    Message{"reference.scatter.words",
            "IRI der Fahrzeuge über dem IRI der Referenz, {count} Straßenstücke, 0 bis {most} "
            "{unit}"},
    Message{"reference.scatter.across", "IRI der Referenz, {unit}"},
    Message{"reference.scatter.up", "IRI der Fahrzeuge, {unit}"},
    Message{"reference.differences.words",
            "Histogramme des IRI der Fahrzeuge weniger dem der Referenz"},
    Message{"reference.differences.part", "; {level} {unit}: Mittel {mean}, {count} Stücke"},

    Message{"reference.controls", "Kontrollstrecken"},
    Message{"reference.controls.caption", "Kontrollstrecken, IRI in {unit}, 90-%-Intervalle"},
    Message{"reference.controls.about",
            "Strecken von bekannter Ebenheit, die nicht in die Karte eingehen. Eine Drift ist "
            "signifikant, wo der Trend des Unterschieds von Monat zu Monat über dem Doppelten "
            "seiner Standardabweichung liegt."},
    Message{"reference.column.known", "Bekannt"},
    Message{"reference.column.off", "Abweichung"},
    Message{"reference.column.drift", "Drift"},
    Message{"reference.drift.too_few", "zu wenige Monate ({count})"},
    Message{"reference.drift.a_year", "{drift} ± {interval} pro Jahr"},
    Message{"reference.drift.drifts", "driftet"},
};

} // namespace

std::span<const Message> german_reference_messages() {
    return messages;
}

} // namespace macadam
