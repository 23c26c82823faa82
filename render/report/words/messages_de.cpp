#include "render/report/words/catalogues.hpp"

#include <array>

// clang-format off: a line a message

namespace macadam {
namespace {

constexpr std::array messages{
    Message{"all", "Alle"},
    Message{"page", "Seite {page} von {pages}"},
    Message{"period", "{first} bis {last}"},
    Message{"title", "Straßenebenheit"},
    Message{"continued", "{caption} (Fortsetzung)"},

    Message{"cars.one", "{count} Fahrzeug"},
    Message{"cars.other", "{count} Fahrzeuge"},
    Message{"trips.one", "{count} Fahrt"},
    Message{"trips.other", "{count} Fahrten"},
    Message{"passes_over_segments.one", "{count} Überfahrt eines Abschnitts"},
    Message{"passes_over_segments.other", "{count} Überfahrten von Abschnitten"},
    Message{"segments.one", "{count} Abschnitt"},
    Message{"segments.other", "{count} Abschnitte"},

    Message{"range.all", "alle"},
    Message{"range.below", "unter {to}"},
    Message{"range.up_to", "bis {to}"},
    Message{"range.from", "ab {from}"},
    Message{"range.above", "über {from}"},
    Message{"range.change", "{from} bis {to}"},

    Message{"class.good", "Gut"},
    Message{"class.fair", "Mittel"},
    Message{"class.poor", "Schlecht"},
    Message{"class.very good", "Sehr gut"},
    Message{"class.very poor", "Sehr schlecht"},

    Message{"kind.motorway", "Autobahn"},
    Message{"kind.trunk", "Schnellstraße"},
    Message{"kind.primary", "Hauptstraße"},
    Message{"kind.secondary", "Landesstraße"},
    Message{"kind.tertiary", "Kreisstraße"},
    Message{"kind.unclassified", "Nebenstraße"},
    Message{"kind.residential", "Wohnstraße"},
    Message{"kind.living_street", "Verkehrsberuhigter Bereich"},
    Message{"kind.service", "Zufahrt"},
    Message{"kind.track", "Wirtschaftsweg"},
    Message{"kind.other", "Sonstige"},

    Message{"unnamed.motorway", "Autobahn ohne Namen"},
    Message{"unnamed.trunk", "Schnellstraße ohne Namen"},
    Message{"unnamed.primary", "Hauptstraße ohne Namen"},
    Message{"unnamed.secondary", "Landesstraße ohne Namen"},
    Message{"unnamed.tertiary", "Kreisstraße ohne Namen"},
    Message{"unnamed.unclassified", "Nebenstraße ohne Namen"},
    Message{"unnamed.residential", "Wohnstraße ohne Namen"},
    Message{"unnamed.living_street", "Verkehrsberuhigter Bereich ohne Namen"},
    Message{"unnamed.service", "Zufahrt ohne Namen"},
    Message{"unnamed.track", "Wirtschaftsweg ohne Namen"},
    Message{"unnamed.other", "Straße ohne Namen"},

    Message{"heading.N", "N"},
    Message{"heading.NE", "NO"},
    Message{"heading.E", "O"},
    Message{"heading.SE", "SO"},
    Message{"heading.S", "S"},
    Message{"heading.SW", "SW"},
    Message{"heading.W", "W"},
    Message{"heading.NW", "NW"},

    Message{"column.class", "Klasse"},
    Message{"column.classes", "Klassen"},
    Message{"column.iri_in", "IRI, {unit}"},
    Message{"column.share", "Anteil"},
    Message{"column.range_of_km", "90-%-Bereich der {long_unit}"},
    Message{"column.kind", "Straßenart"},
    Message{"column.mean", "Mittel"},
    Message{"column.interval", "90-%-Intervall"},
    Message{"column.median", "Median"},
    Message{"column.on_map", "Auf der Karte"},
    Message{"column.one_pass", "Mindestens 1 Überfahrt"},
    Message{"column.three_passes", "Mindestens 3 Überfahrten"},
    Message{"column.section", "Strecke"},
    Message{"column.from_m", "Von, {short_unit}"},
    Message{"column.to_m", "Bis, {short_unit}"},
    Message{"column.excluded_m", "Ausgenommen, {short_unit}"},
    Message{"column.covered", "Gemessen"},
    Message{"column.passes", "Überfahrten"},
    Message{"column.rank", "Rang"},
    Message{"column.road", "Straße"},
    Message{"column.towards", "Richtung"},
    Message{"column.length_m", "Länge, {short_unit}"},
    Message{"column.worst_segment", "Schlechtester Abschnitt"},
    Message{"column.cars", "Fahrzeuge"},
    Message{"column.car", "Fahrzeug"},
    Message{"column.model", "Modell"},
    Message{"column.method", "Verfahren"},
    Message{"column.trips", "Fahrten"},
    Message{"column.undated", "Ohne Datum"},
    Message{"column.matched", "Auf der Karte"},
    Message{"column.rows_used", "Zeilen genutzt"},
    Message{"column.basis", "Grundlage"},
    Message{"column.segments", "Abschnitte"},
    Message{"column.share_of_km", "Anteil der {long_unit}"},
    Message{"column.reason", "Grund"},
    Message{"column.rows", "Zeilen"},
    Message{"column.share_of_rows", "Anteil aller Zeilen"},
    Message{"column.deteriorated", "Schlechter"},
    Message{"column.no_change", "Keine Änderung gezeigt"},
    Message{"column.improved", "Besser"},
    Message{"column.before_alone", "Nur vorher"},
    Message{"column.since_alone", "Nur seither"},
    Message{"column.mean_change", "Mittlere Änderung"},
    Message{"column.before", "Vorher"},
    Message{"column.since", "Seither"},
    Message{"column.change", "Änderung"},

    Message{"unit.one_long.si", "einem Kilometer"},
    Message{"unit.one_long.us", "einer Meile"},
    Message{"unit.long_plural.si", "Kilometer"},
    Message{"unit.long_plural.us", "Meilen"},
    Message{"unit.short_plural.si", "Meter"},
    Message{"unit.short_plural.us", "Fuß"},
    Message{"head.about", "Unebenheit der Straßen (IRI) aus den Sensoren gewöhnlicher Autos."},
    Message{"head.nothing", "Noch wurde nichts gemessen. „macadam import“ fügt Fahrten hinzu."},
    Message{"head.undated", "Die Fahrten tragen kein Datum."},
    Message{"head.driven", "Gefahren"},
    Message{"head.selection",
            "Ausgewählt durch {options}; Autos, Fahrten und verwendete Daten sind die der "
            "ganzen Datenbank."},
    Message{"key.measured", "Gemessen"},
    Message{"key.measured.more", "{share} des Netzes von {km} {long_unit}, jede Richtung gezählt"},
    Message{"key.mean", "Mittlerer IRI"},
    Message{"key.mean.more", "90-%-Intervall"},
    Message{"key.poor.or_worse", "{class} oder schlechter"},
    Message{"key.poor.more", "{km} {long_unit} über {border}"},
    Message{"key.stretches", "Schlechte Stellen"},
    Message{"key.stretches.more", "von mindestens {least} {short_unit}, zusammen {km} {long_unit}"},
    Message{"key.cars", "Gefahren von"},
    Message{"key.cars.more", "{trips}, {passes}"},
    Message{"key.cars.least", "mindestens {cars}"},

    Message{"condition", "Zustand"},
    Message{"classes.caption", "Straßenlänge nach Klasse der Unebenheit"},
    Message{"kinds.caption", "Unebenheit nach Straßenart, IRI ({unit})"},
    Message{"kind_classes.caption",
            "{long_plural} jeder Klasse nach Straßenart, mit ihren 90-%-Bereichen"},
    Message{"condition.remark",
            "P85: 85 % der Länge sind mindestens so eben. Der Bereich einer Klasse sagt, wie "
            "viel Straße in ihr läge, wenn alle Werte dieselbe systematische Abweichung "
            "hätten."},
    Message{"histogram.axis", "IRI eines Abschnitts, {unit}"},
    Message{"histogram.mean", "Mittel {iri}"},
    Message{"histogram.words", "Histogramm des IRI nach Straßenlänge: Mittel {iri}"},

    Message{"map", "Karte"},
    Message{"map.legend", "IRI ({unit}):"},
    Message{"map.words", "Karte des Straßennetzes"},
    Message{"map.words.classes", " mit der Unebenheit in Farben:"},
    Message{"map.unmeasured", "Keine Messung"},
    Message{"map.few_passes", "Weniger als {least} Überfahrten"},
    Message{"map.few_passes.remark",
            "Straßen mit wenigen Überfahrten sind hier grau; alle Zahlen schließen sie ein."},
    Message{"map.scale", "{length}, Norden oben"},
    Message{"map.remark", "Eine dünne Linie hat wenige Überfahrten oder ein weites Intervall."},

    Message{"event", "Schlaglöcher und andere Ereignisse"},
    Message{"event.about",
            "Ereignisse werden im Straßenprofil jeder Überfahrt gesucht. Aufgeführt ist, worin "
            "mindestens zwei Überfahrten und ein Drittel aller seit der ersten Meldung "
            "übereinstimmen."},
    Message{"event.about.crowd",
            "Ereignisse werden im Straßenprofil jeder Überfahrt gesucht. Aufgeführt ist, worin "
            "Überfahrten von mindestens fünf Fahrzeugen und ein Drittel aller seit der ersten "
            "Meldung übereinstimmen; Daten sind der erste Tag eines Monats."},
    Message{"event.found.one", "{count} Ereignis wurde gefunden;"},
    Message{"event.found.other", "{count} Ereignisse wurden gefunden;"},
    Message{"event.listed.one", "das größte ist aufgeführt."},
    Message{"event.listed.other", "die größten {count} sind aufgeführt."},
    Message{"event.caption", "Ereignisse, die größten zuerst"},
    Message{"event.remark",
            "Größe: Tiefe eines Schlaglochs, Höhe der anderen, ± ihre Standardabweichung. Wo die "
            "Fahrzeuge die Radspuren nicht unterscheiden, ist es das Mittel beider Spuren: Ein "
            "Loch in einer Spur ist bis zu doppelt so tief. Position: Breite, Länge. "
            "Überfahrten: Anzahl derer, die das Ereignis melden, von allen dort durchsuchten."},
    Message{"event.kind", "Art"},
    Message{"event.severity", "Schwere"},
    Message{"event.size_mm", "Größe, {small_unit}"},
    Message{"event.chainage", "Station"},
    Message{"event.position", "Position"},
    Message{"event.last_seen", "Zuletzt"},
    Message{"event.pothole", "Schlagloch"},
    Message{"event.bump", "Erhebung"},
    Message{"event.joint", "Fuge"},
    Message{"event.rail", "Bahnübergang"},
    Message{"event.low", "gering"},
    Message{"event.moderate", "mittel"},
    Message{"event.high", "hoch"},
    Message{"event.share", "{passes} von {over}"},
    Message{"event.place", "Weg {way}, {at} {short_unit}"},
    Message{"event.place_osm", "OSM-Weg {way}, {at} {short_unit}"},

    Message{"worst", "Schlechteste Stellen"},
    Message{
        "worst.none",
        "Keine Stelle von mindestens {least} {short_unit} hat einen mittleren IRI über {border}."},
    Message{"worst.about",
            "Schlechte Abschnitte, die auf einer Straße in einer Richtung aufeinander folgen, sind "
            "eine Stelle; sie reicht so weit, wie ihr Mittel über {border} bleibt."},
    Message{"worst.found.one",
            "{count} Stelle von mindestens {least} {short_unit} wurde gefunden;"},
    Message{"worst.found.other",
            "{count} Stellen von mindestens {least} {short_unit} wurden gefunden;"},
    Message{"worst.listed.one", "die nach mittlerem IRI schlechteste ist aufgeführt."},
    Message{"worst.listed.other", "die nach mittlerem IRI schlechtesten {count} sind aufgeführt."},
    Message{"worst.caption", "Schlechteste Stellen, IRI ({unit})"},
    Message{"worst.remark",
            "Überfahrten je Abschnitt: Minimum – Median. Fahrzeuge: das Maximum eines "
            "Abschnitts. Die Karten zeigen die Stelle in den Farben ihrer Abschnitte, alle "
            "anderen Straßen grau, Norden oben. Station: {short_plural} entlang des Wegs ab seinem "
            "ersten Knoten, in Fahrtrichtung."},
    Message{"stretch.part", "Weg {way}, Station {from}–{to} {short_unit}"},
    Message{"stretch.part_osm", "OSM-Weg {way}, Station {from}–{to} {short_unit}"},
    Message{"stretch.words", "Karte der Stelle {rank}: {road}"},
    Message{"stretch.title", "{rank} · {road}, Richtung {heading}"},
    Message{"stretch.mean", " ({interval}) auf {length} {short_unit}"},
    Message{"stretch.phone.one", ", höchstens {worst}\n{passes} Überfahrt von {cars}"},
    Message{"stretch.phone.other", ", höchstens {worst}\n{passes} Überfahrten von {cars}"},
    Message{"stretch.place", "{reference}\nMittelpunkt {lat}, {lon}"},
    Message{"stretch.undated", "Ohne Datum"},
    Message{"stretch.driven", "Gefahren {period}"},

    Message{"change", "Änderung seit {day}"},
    Message{"change.nothing",
            "Kein Abschnitt hat datierte Überfahrten sowohl vor dem {day} als auch seither: Nichts "
            "lässt sich vergleichen."},
    Message{"change.about",
            "Jeder Abschnitt mit datierten Überfahrten auf beiden Seiten des {day} wird mit sich "
            "selbst verglichen: {compared}. Einzeln geprüft liegen {alone} davon jenseits von 1,96 "
            "Standardabweichungen; hätte sich nirgends etwas geändert, wären es etwa {chance}. "
            "Geändert genannt werden darum weniger: nur so viele, dass unter ihnen höchstens etwa "
            "{share} Zufall zu erwarten sind (Benjamini und Hochberg)."},
    Message{
        "change.caption",
        "{long_plural} nach Änderung; mittlere Änderung des IRI ({unit}), positiv ist unebener"},
    Message{"change.remark",
            "Keine Änderung gezeigt: Der Unterschied kann Zufall sein; das heißt nicht, dass sich "
            "nichts geändert hat. Nur vorher, nur seither: Überfahrten nur auf einer Seite des "
            "Tages, sodass sich nichts vergleichen lässt. Die mittlere Änderung gilt für alles "
            "Vergleichbare."},
    Message{"change.legend", "Änderung des IRI:"},
    Message{"change.not_comparable", "Nicht vergleichbar"},
    Message{"change.words", "Karte der Änderungen seit {day}"},
    Message{"change.mean", " ({interval}), von {before} auf {since} auf {length} {short_unit}"},
    Message{"change.worse.caption", "Am stärksten verschlechterte Stellen, IRI ({unit})"},
    Message{"change.better.caption", "Am stärksten verbesserte Stellen, IRI ({unit})"},
    Message{"change.worse.none",
            "Keine Stelle von mindestens {least} {short_unit} hat sich als unebener erwiesen."},
    Message{"change.better.none",
            "Keine Stelle von mindestens {least} {short_unit} hat sich als ebener erwiesen."},

    Message{"sections", "Strecken"},
    Message{"sections.about",
            "Mittel nach Länge gewichtet. Die Intervalle zählen Fehler, die entlang einer Strecke "
            "gleich sind, wie die von Fahrzeugen und Verfahren, voll. Stationen fallen, wo eine "
            "Straße gegen sie befahren wird. Überfahrten je Abschnitt: Minimum – Median."},
    Message{"sections.caption", "Strecken, IRI ({unit})"},

    Message{"coverage", "Abdeckung"},
    Message{"coverage.caption", "{long_plural} nach Straßenart, jede Richtung gezählt"},
    Message{
        "coverage.remark",
        "{passed} von {segments} Abschnitten von etwa {length} {short_unit} haben eine Überfahrt. "
        "Rampen zählen zu ihrer Straße. Die befahrenen Straßen sind keine "
        "Zufallsstichprobe des Netzes."},

    Message{"data", "Fahrzeuge und Daten"},
    Message{
        "data.own",
        "Der Bericht zeigt die eigenen Fahrzeuge des Betreibers und ist nicht anonymisiert: Wer "
        "weiß, wann ein Fahrzeug auf einer Straße war, erkennt es unter Umständen wieder."},
    Message{"data.crowd",
            "Fahrzeuge Dritter haben diese Straßen befahren. Alle Werte stammen aus der "
            "Veröffentlichung vom {month} und beruhen auf mindestens fünf Fahrzeugen; Zahlen von "
            "Fahrten, Fahrzeugen und Überfahrten sind abgerundet, Zeiten sind Monate. Ausgelassen: "
            "bis zu {segments} Segmente ({km} {long_unit}), die zu wenige Fahrzeuge befuhren."},
    Message{"data.crowd.nothing",
            "Fahrzeuge Dritter haben diese Straßen befahren; veröffentlicht ist davon noch "
            "nichts."},
    Message{"data.nothing", "Noch wurde keine Fahrt aufgenommen."},
    Message{"data.remark",
            "Fahrzeuge sind nach ihrer ersten Fahrt nummeriert. Modell: aus der eigenen Datei des "
            "Benutzers oder "
            "ein eingebautes. Auf der Karte: der Anteil des Weges, der einer Straße zugeordnet "
            "wurde. Zeilen genutzt: der Anteil der Sensorzeilen, der in eine Schätzung einging."},
    Message{"cars.caption", "Fahrzeuge und die Güte ihrer Daten"},
    Message{"car.unnamed", "nicht benannt"},
    Message{"cars.more.one", "{count} weitere Zeile"},
    Message{"cars.more.other", "{count} weitere Zeilen"},
    Message{"model.own", "eigene Datei"},
    Message{"model.built_in", "eingebaut: {model}"},
    Message{"quality.caption", "Datengrundlage der Abschnittswerte"},
    Message{"quality.both_tracks", "Beide Radspuren: MRI beobachtet"},
    Message{"quality.inferred", "Mitte des Fahrzeugs: MRI aus HRI geschätzt"},
    Message{"quality.lateral", "Nur Querbeschleunigung: MRI aus HRI geschätzt"},
    Message{"quality.too_slow", "Ein Teil zu langsam befahren, um zu zählen"},
    Message{"quality.start_up", "Ein Teil im Anlauf des Verfahrens"},
    Message{"quality.gap", "Ein Teil ohne Daten"},
    Message{"quality.remark",
            "MRI ist das Mittel beider Radspuren. Wo nur die Bewegung der Fahrzeugmitte "
            "beobachtet wurde, wurde HRI gemessen und MRI daraus geschätzt: MRI = HRI / "
            "{ratio}; auf wirklichen Straßen beträgt das Verhältnis {low} bis {high}, was das "
            "Intervall einschließt. Die drei Zeilen zu Teilen gelten, wo jede Überfahrt eines "
            "Abschnitts einen solchen Teil hat."},
    Message{"quality.lateral_passes.one",
            "{count} Überfahrt stammt allein aus Querbeschleunigung, weil das Protokoll keine "
            "senkrechte Beschleunigung enthielt: weit weniger genau."},
    Message{"quality.lateral_passes.other",
            "{count} Überfahrten stammen allein aus Querbeschleunigung, weil das Protokoll "
            "keine senkrechte Beschleunigung enthielt: weit weniger genau."},
    Message{"reasons.caption", "Nicht genutzte Sensorwerte, nach Grund"},
    Message{"reasons.not_kept", "Von einer früheren Version nicht festgehalten"},
    Message{"reason.wrong_cell_count", "Falsche Zahl von Zellen"},
    Message{"reason.bad_number", "Keine Zahl"},
    Message{"reason.out_of_range", "Außerhalb des Bereichs"},
    Message{"reason.no_time", "Keine Zeit"},
    Message{"reason.no_sample", "Kein Messwert"},
    Message{"reason.time_not_increasing", "Zeit nicht steigend"},
    Message{"reason.unused_channel", "Sensor nicht benötigt"},
    Message{"reason.too_slow", "Zu langsam"},
    Message{"reason.short_stretch", "Zu kurzes Stück"},
    Message{"reason.no_speed", "Keine Geschwindigkeit"},
    Message{"reason.implausible", "Unglaubhaft"},
    Message{"reason.inaccurate", "Ungenau"},
    Message{"reason.repeated_fix", "Wiederholte Position"},
    Message{"reason.merged", "Zusammengefasst"},
    Message{"reason.trimmed", "Abgeschnitten"},
    Message{"reason.sensor_moved", "Sensor verschoben"},

    Message{"reading", "Wie dieser Bericht zu lesen ist"},
    Message{"reading.iri.mm_per_m",
            "Der International Roughness Index (IRI, ASTM E1926) ist der aufsummierte "
            "Federweg eines Referenz-Viertelfahrzeugs bei 80 km/h je Fahrstrecke: mm/m, was "
            "dasselbe ist wie m/km; 1 mm/m sind 63,36 in/mi. Eine neue Autobahn hat etwa "
            "{new}, eine abgenutzte Stadtstraße {worn} bis {worn_to}, eine zerstörte Straße "
            "{broken} mm/m. Flickstellen, Fugen, Schachtdeckel, Schienen und Bodenschwellen "
            "zählen als Unebenheit."},
    Message{"reading.iri.in_per_mi",
            "Der International Roughness Index (IRI, ASTM E1926) ist der aufsummierte "
            "Federweg eines Referenz-Viertelfahrzeugs bei {80_kmh} je Fahrstrecke, hier in "
            "Zoll je Meile (in/mi). Eine neue Autobahn hat etwa {new}, eine abgenutzte "
            "Stadtstraße {worn} bis {worn_to}, eine zerstörte Straße {broken} in/mi. "
            "Flickstellen, Fugen, Schachtdeckel, Schienen und Bodenschwellen zählen als "
            "Unebenheit."},
    Message{"reading.intervals",
            "Jede Zahl steht für eine Richtung einer Straße: Eine in beiden Richtungen befahrene "
            "Straße zählt doppelt. Mittel und Perzentile sind nach Länge gewichtet. Ein Intervall "
            "enthält den wahren Wert mit 90 % Wahrscheinlichkeit, soweit das Verfahren seine "
            "Fehler kennt; die Hälfte ihrer Varianz gilt als allen Werten gemeinsam, sodass auch "
            "das Mittel vieler Straßen unsicher bleibt."},
    Message{"method", "Verfahren"},
    Message{"method.cars",
            "Gewöhnliche Autos zeichneten Beschleunigung, Geschwindigkeit und Position auf."},
    Message{"method.smoother",
            "Das Verfahren (smoother) findet die wahrscheinlichsten Straßenprofile, die die "
            "gemessene Bewegung des Autos erklären, mit einem Fahrzeugmodell mit zwei Achsen; "
            "das Referenzauto des IRI fährt über sie, und ihre Streuung ergibt das Intervall."},
    Message{
        "method.kf",
        "Ein Kalman-Filter (kf) mit einem Fahrzeugmodell mit einer Achse schätzt das "
        "Straßenprofil, das es erschütterte; das Referenzauto des IRI fährt über dieses Profil."},
    Message{"method.fusion",
            "Positionen werden der Karte zugeordnet. Jede Überfahrt ergibt für jeden Abschnitt "
            "einen Wert mit Standardabweichung; die Überfahrten aller Fahrzeuge werden zu einem "
            "Mittel vereint, in dem eine einzelne schlechte kaum zählt."},
    Message{
        "method.change",
        "Änderung: Die Überfahrten eines Abschnitts vor dem Tag und seither werden getrennt "
        "vereint und die beiden Werte verglichen. Was alle Fahrzeuge nach dem Modell der "
        "Vereinigung gleich falsch lesen, steckt in beiden und zählt nicht als Rauschen des "
        "Unterschieds: Mit den Standardabweichungen s1 und s2 sowie c1 und c2 dieses gemeinsamen "
        "Teils ist die Varianz des Unterschieds s1² − c1² + s2² − c2² + (c1 − c2)². "
        "Geändert genannt werden Abschnitte nach dem Verfahren von Benjamini und Hochberg mit "
        "einer Falscherkennungsrate von {share}. Stellen verbinden so genannte Abschnitte, die "
        "aufeinander folgen; ihre Änderung ist die aller ihrer Abschnitte, die Hälfte der "
        "Varianz ihnen gemeinsam."},
    Message{"limits", "Grenzen"},
    Message{"limits.estimates",
            "Dies sind Schätzungen aus dem Verhalten von Autos, die nur ungefähr bekannt sind. Sie "
            "unterscheiden unebene von ebenen Straßen und zeigen Änderungen; sie ersetzen keinen "
            "Inertialprofilometer (ASTM E950), etwa bei der Abnahme."},
    Message{"limits.tracks",
            "Ein Wert gilt für die Spuren, die die Räder nahmen. Unter {18_kmh} wird nichts "
            "gemessen, und wenig von Löchern, denen Fahrer ausweichen."},
    Message{"limits.segments",
            "Auf {20_m} streut die Unebenheit mehr als auf {100_m} oder {one_long}: Extreme "
            "einzelner Abschnitte sind zum Teil Zufall; darum sind die schlechtesten Straßen als "
            "Stellen aufgeführt."},
    Message{"limits.smoother",
            "Das Verfahren (smoother) hat eine systematische Abweichung, die nicht berichtigt "
            "ist: Bei simulierten Fahrzeugen mit bekannten wahren Werten war die Karte einer "
            "Stadt um 2 % zu hoch, Rampen um 3 % zu niedrig, und die 90-%-Intervalle "
            "enthielten etwa 80 % der wahren Werte."},
    Message{"limits.kf",
            "Das Verfahren (kf) hat eine systematische Abweichung, die nicht berichtigt ist. "
            "Bei hohem Tempo sind seine Werte zu niedrig, weil seine Filter kurze Wellen "
            "abschneiden; das schließt das Intervall ein. Bei simulierten Fahrzeugen mit "
            "bekannten wahren Werten war die Karte einer Stadt um etwa ein Zehntel zu hoch, "
            "Rampen um etwa die Hälfte, was mehr ist, als das Intervall zulässt."},
    Message{"limits.change",
            "Eine Änderung ist eine der Überfahrten, nicht der Straße allein: Andere Fahrzeuge, "
            "andere Beladung oder andere Reifen auf einer Seite des Tages können als Änderung "
            "erscheinen. Kleine Änderungen einzelner Abschnitte bleiben in ihren Intervallen "
            "verborgen, und die größten aufgeführten sind zum Teil durch Zufall so groß."},

    Message{"source", "Quelle der Karte"},
    Message{"source.roads", "Straßen: {source}."},
    Message{"source.traced", "aus den Fahrten gezeichnet"},
};

} // namespace

std::span<const Message> german_messages() {
    return messages;
}

} // namespace macadam
