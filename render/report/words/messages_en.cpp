#include "render/report/words/catalogues.hpp"

#include <array>

// clang-format off: a line a message

namespace macadam {
namespace {

constexpr std::array messages{
    Message{"all", "All"},
    Message{"page", "Page {page} of {pages}"},
    Message{"period", "{first} to {last}"},
    Message{"title", "Road roughness"},
    Message{"continued", "{caption} (continued)"},

    Message{"cars.one", "{count} car"},
    Message{"cars.other", "{count} cars"},
    Message{"trips.one", "{count} trip"},
    Message{"trips.other", "{count} trips"},
    Message{"passes_over_segments.one", "{count} pass over a segment"},
    Message{"passes_over_segments.other", "{count} passes over segments"},
    Message{"segments.one", "{count} segment"},
    Message{"segments.other", "{count} segments"},

    Message{"range.all", "all"},
    Message{"range.below", "below {to}"},
    Message{"range.up_to", "up to {to}"},
    Message{"range.from", "from {from}"},
    Message{"range.above", "above {from}"},
    Message{"range.change", "{from} to {to}"},

    Message{"class.good", "Good"},
    Message{"class.fair", "Fair"},
    Message{"class.poor", "Poor"},
    Message{"class.very good", "Very good"},
    Message{"class.very poor", "Very poor"},

    Message{"kind.motorway", "Motorway"},
    Message{"kind.trunk", "Trunk"},
    Message{"kind.primary", "Primary"},
    Message{"kind.secondary", "Secondary"},
    Message{"kind.tertiary", "Tertiary"},
    Message{"kind.unclassified", "Unclassified"},
    Message{"kind.residential", "Residential"},
    Message{"kind.living_street", "Living street"},
    Message{"kind.service", "Service"},
    Message{"kind.track", "Track"},
    Message{"kind.other", "Other"},

    Message{"unnamed.motorway", "Motorway without a name"},
    Message{"unnamed.trunk", "Trunk road without a name"},
    Message{"unnamed.primary", "Primary road without a name"},
    Message{"unnamed.secondary", "Secondary road without a name"},
    Message{"unnamed.tertiary", "Tertiary road without a name"},
    Message{"unnamed.unclassified", "Unclassified road without a name"},
    Message{"unnamed.residential", "Residential road without a name"},
    Message{"unnamed.living_street", "Living street without a name"},
    Message{"unnamed.service", "Service road without a name"},
    Message{"unnamed.track", "Track without a name"},
    Message{"unnamed.other", "Road without a name"},

    Message{"heading.N", "N"},
    Message{"heading.NE", "NE"},
    Message{"heading.E", "E"},
    Message{"heading.SE", "SE"},
    Message{"heading.S", "S"},
    Message{"heading.SW", "SW"},
    Message{"heading.W", "W"},
    Message{"heading.NW", "NW"},

    Message{"column.class", "Class"},
    Message{"column.classes", "Classes"},
    Message{"column.iri_in", "IRI, {unit}"},
    Message{"column.share", "Share"},
    Message{"column.range_of_km", "90\u00A0% range of {long_unit}"},
    Message{"column.kind", "Kind of road"},
    Message{"column.mean", "Mean"},
    Message{"column.interval", "90\u00A0% interval"},
    Message{"column.median", "Median"},
    Message{"column.on_map", "On the map"},
    Message{"column.one_pass", "At least 1 pass"},
    Message{"column.three_passes", "At least 3 passes"},
    Message{"column.section", "Section"},
    Message{"column.from_m", "From, {short_unit}"},
    Message{"column.to_m", "To, {short_unit}"},
    Message{"column.excluded_m", "Excluded, {short_unit}"},
    Message{"column.covered", "Covered"},
    Message{"column.passes", "Passes"},
    Message{"column.rank", "Rank"},
    Message{"column.road", "Road"},
    Message{"column.towards", "Towards"},
    Message{"column.length_m", "Length, {short_unit}"},
    Message{"column.worst_segment", "Worst segment"},
    Message{"column.cars", "Cars"},
    Message{"column.car", "Car"},
    Message{"column.model", "Model used"},
    Message{"column.method", "Method"},
    Message{"column.trips", "Trips"},
    Message{"column.undated", "Undated"},
    Message{"column.matched", "On the map"},
    Message{"column.rows_used", "Rows used"},
    Message{"column.basis", "Basis"},
    Message{"column.segments", "Segments"},
    Message{"column.share_of_km", "Share of {long_unit}"},
    Message{"column.reason", "Reason"},
    Message{"column.rows", "Rows"},
    Message{"column.share_of_rows", "Share of all rows"},
    Message{"column.deteriorated", "Deteriorated"},
    Message{"column.no_change", "No change shown"},
    Message{"column.improved", "Improved"},
    Message{"column.before_alone", "Before only"},
    Message{"column.since_alone", "Since only"},
    Message{"column.mean_change", "Mean change"},
    Message{"column.before", "Before"},
    Message{"column.since", "Since"},
    Message{"column.change", "Change"},

    Message{"unit.one_long.si", "a kilometre"},
    Message{"unit.one_long.us", "a mile"},
    Message{"unit.long_plural.si", "Kilometres"},
    Message{"unit.long_plural.us", "Miles"},
    Message{"unit.short_plural.si", "metres"},
    Message{"unit.short_plural.us", "feet"},
    Message{"head.about", "Road roughness (IRI) from the sensors of ordinary cars."},
    Message{"head.nothing", "No measurements yet. 'macadam import' adds trips."},
    Message{"head.undated", "The trips are undated."},
    Message{"head.driven", "Driven"},
    Message{"head.selection",
            "Selected by {options}; cars, trips and data used are those of the whole "
            "database."},
    Message{"key.measured", "Measured"},
    Message{"key.measured.more",
            "{share} of the network of {km} {long_unit}, each direction counted"},
    Message{"key.mean", "Mean IRI"},
    Message{"key.mean.more", "90 % interval"},
    Message{"key.poor.or_worse", "{class} or worse"},
    Message{"key.poor.more", "{km} {long_unit} above {border}"},
    Message{"key.stretches", "Poor sections"},
    Message{"key.stretches.more", "of {least} {short_unit} or more, {km} {long_unit} in total"},
    Message{"key.cars", "Driven by"},
    Message{"key.cars.more", "{trips}, {passes}"},
    Message{"key.cars.least", "at least {cars}"},

    Message{"condition", "Condition"},
    Message{"classes.caption", "Length of road by class of roughness"},
    Message{"kinds.caption", "Roughness by kind of road, IRI ({unit})"},
    Message{"kind_classes.caption",
            "{long_plural} of each class by kind of road, with their 90 % ranges"},
    Message{"condition.remark",
            "P85: 85 % of the length is at least this smooth. The range of a class says how "
            "much road would be in it if all values shared one bias."},
    Message{"histogram.axis", "IRI of a segment, {unit}"},
    Message{"histogram.mean", "mean {iri}"},
    Message{"histogram.words", "Histogram of IRI by length of road: mean {iri}"},

    Message{"map", "Map"},
    Message{"map.legend", "IRI ({unit}):"},
    Message{"map.words", "Map of the road network"},
    Message{"map.words.classes", " with roughness in colours:"},
    Message{"map.unmeasured", "No measurement"},
    Message{"map.few_passes", "Fewer than {least} passes"},
    Message{"map.few_passes.remark",
            "Roads with few passes are grey here; all figures count them."},
    Message{"map.scale", "{length}, north up"},
    Message{"map.remark", "A thin line has few passes or a wide interval."},

    Message{"event", "Potholes and other events"},
    Message{"event.about",
            "Events are found in the road profile of each pass. They are listed if at least two "
            "passes and a third of all passes since the first report agree."},
    Message{"event.about.crowd",
            "Events are found in the road profile of each pass. They are listed if passes of at "
            "least five cars and a third of all passes since the first report agree; dates are "
            "the first day of a month."},
    Message{"event.found.one", "{count} event was found;"},
    Message{"event.found.other", "{count} events were found;"},
    Message{"event.listed.one", "the largest is listed."},
    Message{"event.listed.other", "the largest {count} are listed."},
    Message{"event.caption", "Events, largest first"},
    Message{"event.remark",
            "Size: depth of a pothole, height of the others, ± its standard deviation. Where the "
            "cars do not tell the wheel tracks apart it is the mean of both tracks: a hole in "
            "one track is up to twice as deep. Position: latitude, longitude. Passes: those that "
            "report the event, of all searched there."},
    Message{"event.kind", "Kind"},
    Message{"event.severity", "Severity"},
    Message{"event.size_mm", "Size, {small_unit}"},
    Message{"event.chainage", "Chainage"},
    Message{"event.position", "Position"},
    Message{"event.last_seen", "Last seen"},
    Message{"event.pothole", "Pothole"},
    Message{"event.bump", "Bump"},
    Message{"event.joint", "Joint"},
    Message{"event.rail", "Rail crossing"},
    Message{"event.low", "low"},
    Message{"event.moderate", "moderate"},
    Message{"event.high", "high"},
    Message{"event.share", "{passes} of {over}"},
    Message{"event.place", "way {way}, {at} {short_unit}"},
    Message{"event.place_osm", "OSM way {way}, {at} {short_unit}"},

    Message{"worst", "Worst sections"},
    Message{"worst.none",
            "No section of {least} {short_unit} or more has a mean IRI above {border}."},
    Message{"worst.about",
            "Consecutive poor segments of one road in one direction form one section, which "
            "extends as far as its mean stays above {border}."},
    Message{"worst.found.one", "{count} section of {least} {short_unit} or more was found;"},
    Message{"worst.found.other", "{count} sections of {least} {short_unit} or more were found;"},
    Message{"worst.listed.one", "the worst by mean IRI is listed."},
    Message{"worst.listed.other", "the worst {count} by mean IRI are listed."},
    Message{"worst.caption", "Worst sections, IRI ({unit})"},
    Message{"worst.remark",
            "Passes per segment: minimum – median. Cars: the maximum of one segment. The maps "
            "show the section in the colours of its segments and all other roads in grey, "
            "north up. Chainage: {short_plural} along the way from its first node, in driving "
            "direction."},
    Message{"stretch.part", "Way {way}, chainage {from}–{to} {short_unit}"},
    Message{"stretch.part_osm", "OSM way {way}, chainage {from}–{to} {short_unit}"},
    Message{"stretch.words", "Map of section {rank}: {road}"},
    Message{"stretch.title", "{rank} · {road}, towards {heading}"},
    Message{"stretch.mean", " ({interval}) over {length} {short_unit}"},
    Message{"stretch.phone.one", ", at worst {worst}\n{passes} pass by {cars}"},
    Message{"stretch.phone.other", ", at worst {worst}\n{passes} passes by {cars}"},
    Message{"stretch.place", "{reference}\nMidpoint {lat}, {lon}"},
    Message{"stretch.undated", "Undated"},
    Message{"stretch.driven", "Driven {period}"},

    Message{"change", "Change since {day}"},
    Message{"change.nothing",
            "No segment has dated passes both before and since {day}: no comparison is "
            "possible."},
    Message{"change.about",
            "Each segment with dated passes both before and since {day} is compared with "
            "itself: {compared}. Tested one by one, {alone} of them differ by more than 1.96 "
            "standard deviations; without any change, about {chance} would. Fewer are "
            "therefore reported as changed: only so many that at most about {share} of them "
            "are expected to be chance (Benjamini and Hochberg)."},
    Message{"change.caption",
            "{long_plural} by change; mean change of IRI ({unit}), positive is rougher"},
    Message{"change.remark",
            "No change shown: the difference may be chance; this does not mean that nothing "
            "has changed. Before only, since only: passes on one side of the day only, so no "
            "comparison is possible. The mean change is that of all comparable segments."},
    Message{"change.legend", "Change of IRI:"},
    Message{"change.not_comparable", "Not comparable"},
    Message{"change.words", "Map of changes since {day}"},
    Message{"change.mean", " ({interval}), from {before} to {since} over {length} {short_unit}"},
    Message{"change.worse.caption", "Most deteriorated sections, IRI ({unit})"},
    Message{"change.better.caption", "Most improved sections, IRI ({unit})"},
    Message{"change.worse.none",
            "No section of {least} {short_unit} or more has become demonstrably "
            "rougher."},
    Message{"change.better.none",
            "No section of {least} {short_unit} or more has become demonstrably "
            "smoother."},

    Message{"sections", "Sections"},
    Message{"sections.about",
            "Means are weighted by length. Intervals include errors that are the same along a "
            "section, such as those of cars and method, in full. Stations decrease where a "
            "road is driven against them. Passes per segment: minimum – median."},
    Message{"sections.caption", "Sections, IRI ({unit})"},

    Message{"coverage", "Coverage"},
    Message{"coverage.caption", "{long_plural} by kind of road, each direction counted"},
    Message{"coverage.remark",
            "{passed} of {segments} segments of about {length} {short_unit} have a pass. Slip "
            "roads are "
            "counted with their road. The roads driven are not a random sample of the network."},

    Message{"data", "Cars and data"},
    Message{"data.own",
            "This report is about the operator's own cars and is not anonymised: anyone who "
            "knows when a car was on a road may recognise it."},
    Message{"data.crowd",
            "Other people's cars drove these roads. All values are those of the publication "
            "of {month} and are based on five cars or more; numbers of trips, cars and passes "
            "are rounded down, dates are months. Left out: up to {segments} segments ({km} "
            "{long_unit}) driven by too few cars."},
    Message{"data.crowd.nothing",
            "Other people's cars drove these roads; nothing has been published yet."},
    Message{"data.nothing", "No trips imported yet."},
    Message{"data.remark",
            "Cars are numbered by their first trip. Model: the user's own file or a built-in "
            "one. On the map: share of the distance that was matched to a road. Rows used: "
            "share of the sensor rows that were used in an estimate."},
    Message{"cars.caption", "Cars and the quality of their data"},
    Message{"car.unnamed", "not named"},
    Message{"cars.more.one", "{count} more row"},
    Message{"cars.more.other", "{count} more rows"},
    Message{"model.own", "own file"},
    Message{"model.built_in", "built-in {model}"},
    Message{"quality.caption", "Data basis of segment values"},
    Message{"quality.both_tracks", "Both wheel tracks: MRI observed"},
    Message{"quality.inferred", "Centre of the car: MRI estimated from HRI"},
    Message{"quality.lateral", "Lateral acceleration only: MRI estimated from HRI"},
    Message{"quality.too_slow", "Partly driven too slowly"},
    Message{"quality.start_up", "Partly within the start-up of the method"},
    Message{"quality.gap", "Partly without data"},
    Message{"quality.remark",
            "MRI is the mean of both wheel tracks. Where only the motion of the car's centre "
            "was observed, HRI was measured and MRI estimated from it: MRI = HRI / {ratio}; "
            "on real roads the ratio is {low} to {high}, which the interval includes. The "
            "three rows on parts apply where every pass over a segment has such a part."},
    Message{"quality.lateral_passes.one",
            "{count} pass is from lateral acceleration only, because the log had no vertical "
            "acceleration: far less accurate."},
    Message{"quality.lateral_passes.other",
            "{count} passes are from lateral acceleration only, because the log had no "
            "vertical acceleration: far less accurate."},
    Message{"reasons.caption", "Sensor readings not used, by reason"},
    Message{"reasons.not_kept", "Not recorded by an earlier version"},
    Message{"reason.wrong_cell_count", "Wrong number of cells"},
    Message{"reason.bad_number", "Not a number"},
    Message{"reason.out_of_range", "Out of range"},
    Message{"reason.no_time", "No time"},
    Message{"reason.no_sample", "No sample"},
    Message{"reason.time_not_increasing", "Time not increasing"},
    Message{"reason.unused_channel", "Sensor not needed"},
    Message{"reason.too_slow", "Too slow"},
    Message{"reason.short_stretch", "Continuous drive too short"},
    Message{"reason.no_speed", "No speed"},
    Message{"reason.implausible", "Implausible"},
    Message{"reason.inaccurate", "Inaccurate"},
    Message{"reason.repeated_fix", "Repeated position"},
    Message{"reason.merged", "Merged"},
    Message{"reason.trimmed", "Trimmed"},
    Message{"reason.sensor_moved", "Sensor moved"},

    Message{"reading", "How to read this report"},
    Message{"reading.iri.mm_per_m",
            "The International Roughness Index (IRI, ASTM E1926) is the accumulated "
            "suspension travel of a reference quarter car at 80 km/h per distance: mm/m, "
            "which is the same as m/km; 1 mm/m is 63.36 in/mi. A new motorway has about "
            "{new}, a worn town street {worn} to {worn_to}, a broken road {broken} mm/m. "
            "Patches, joints, manhole covers, rails and speed humps count as roughness."},
    Message{"reading.iri.in_per_mi",
            "The International Roughness Index (IRI, ASTM E1926) is the accumulated "
            "suspension travel of a reference quarter car at {80_kmh} per distance, here in "
            "inches per mile (in/mi). A new motorway has about {new}, a worn town street "
            "{worn} to {worn_to}, a broken road {broken} in/mi. Patches, joints, manhole "
            "covers, rails and speed humps count as roughness."},
    Message{"reading.intervals",
            "Every figure is for one direction of a road: a street driven both ways counts twice. "
            "Means and percentiles are weighted by length. An interval contains the true value "
            "with a probability of 90 %, as far as the method knows its errors; half of their "
            "variance is assumed to be common to all values, so the mean of many roads stays "
            "uncertain."},
    Message{"method", "Method"},
    Message{"method.cars", "Ordinary cars recorded acceleration, speed and position."},
    Message{"method.smoother",
            "The method (smoother) finds the most probable road profiles that explain the "
            "measured motion of the car, with a car model with two axles; the reference car "
            "of the IRI is simulated on them, and their variation gives the interval."},
    Message{"method.kf",
            "A Kalman filter (kf) with a car model with one axle estimates the road profile from "
            "the measured motion of the car; the reference car of the IRI is simulated on that "
            "profile."},
    Message{"method.fusion",
            "Positions are matched to the map. Each pass gives a value for each segment, with "
            "a standard deviation; the passes of all cars are fused into a robust mean, in "
            "which one bad pass hardly counts."},
    Message{"method.change",
            "Change: a segment's passes before the day and since then are fused separately, "
            "and the two values are compared. Errors that all cars share, according to the "
            "fusion model, are in both values and do not count as noise of the difference: "
            "with standard deviations s1 and s2, of which c1 and c2 are common, the variance "
            "of the difference is s1² − c1² + s2² − c2² + (c1 − c2)². Segments are reported "
            "as changed by the procedure of Benjamini and Hochberg with a false discovery "
            "rate of {share}. Sections join consecutive changed segments; the change of a "
            "section is that of all its segments, with half of its variance common to them."},
    Message{"limits", "Limits"},
    Message{"limits.estimates",
            "These are estimates from the response of cars that are known only roughly. They "
            "distinguish rough roads from smooth ones and show changes; they do not replace "
            "an inertial profiler (ASTM E950), for example for acceptance."},
    Message{"limits.tracks",
            "A value is for the tracks that the wheels took. Nothing is measured below "
            "{18_kmh}, and potholes that drivers avoid are mostly missed."},
    Message{"limits.segments",
            "Roughness varies more over {20_m} than over {100_m} or {one_long}: extremes of "
            "single segments are partly chance, which is why the worst roads are listed as "
            "sections."},
    Message{"limits.smoother",
            "The method (smoother) has a systematic bias that is not corrected: on simulated "
            "cars, with known true values, a town's map was 2 % too high and slip roads 3 % "
            "too low, and the 90 % intervals contained about 80 % of the true values."},
    Message{"limits.kf",
            "The method (kf) has a systematic bias that is not corrected. At high speed its "
            "values are low, because its filters remove short waves; the interval includes "
            "this. On simulated cars, with known true values, a town's map was about a tenth "
            "too high and slip roads about a half, which is more than the interval allows."},
    Message{"limits.change",
            "A change is one of the passes, not necessarily of the road: other cars, another "
            "load or other tyres on one side of the day can appear as a change. Small changes "
            "of single segments remain hidden in their intervals, and the largest changes "
            "listed are partly chance."},

    Message{"source", "Source of the map"},
    Message{"source.roads", "Roads: {source}."},
    Message{"source.traced", "traced from the trips"},
};

} // namespace

std::span<const Message> english_messages() {
    return messages;
}

} // namespace macadam
