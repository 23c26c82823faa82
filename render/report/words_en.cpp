#include "render/report/catalogues.hpp"

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
    Message{"column.range_of_km", "90\u00A0% range of km"},
    Message{"column.kind", "Kind of road"},
    Message{"column.mean", "Mean"},
    Message{"column.interval", "90\u00A0% interval"},
    Message{"column.median", "Median"},
    Message{"column.on_map", "On the map"},
    Message{"column.one_pass", "At least 1 pass"},
    Message{"column.three_passes", "At least 3 passes"},
    Message{"column.section", "Section"},
    Message{"column.from_m", "From, m"},
    Message{"column.to_m", "To, m"},
    Message{"column.excluded_m", "Excluded, m"},
    Message{"column.covered", "Covered"},
    Message{"column.passes", "Passes"},
    Message{"column.rank", "Rank"},
    Message{"column.road", "Road"},
    Message{"column.towards", "Towards"},
    Message{"column.length_m", "Length, m"},
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
    Message{"column.share_of_km", "Share of km"},
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

    Message{"head.about", "Road roughness (IRI) from the sensors of ordinary cars."},
    Message{"head.nothing", "Nothing was measured yet."},
    Message{"head.undated", "The trips are not dated."},
    Message{"head.driven", "Driven"},
    Message{"key.measured", "Measured"},
    Message{"key.measured.more", "{share} of the network of {km} km, each direction counted"},
    Message{"key.mean", "Mean IRI"},
    Message{"key.mean.more", "90 % interval"},
    Message{"key.poor.or_worse", "{class} or worse"},
    Message{"key.poor.more", "{km} km above {border}"},
    Message{"key.stretches", "Poor stretches"},
    Message{"key.stretches.more", "of {least} m or more, {km} km together"},
    Message{"key.cars", "Driven by"},
    Message{"key.cars.more", "{trips}, {passes}"},
    Message{"key.cars.least", "at least {cars}"},

    Message{"condition", "Condition"},
    Message{"classes.caption", "Length of road by class of roughness"},
    Message{"kinds.caption", "Roughness by kind of road, IRI ({unit})"},
    Message{"kind_classes.caption",
            "Kilometres of each class by kind of road, with their 90 % ranges"},
    Message{"condition.remark",
            "P85: 85 % of the length is as smooth as this or smoother. The range of a class says "
            "how much road would be in it if all readings were too high, or too low, together."},
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

    Message{"worst", "Worst stretches"},
    Message{"worst.none", "No stretch of {least} m or more has a mean IRI above {border}."},
    Message{"worst.about",
            "Poor segments that follow each other on one road in one direction are one stretch; it "
            "goes on while its mean stays above {border}."},
    Message{"worst.found.one", "{count} stretch of {least} m or more was found;"},
    Message{"worst.found.other", "{count} stretches of {least} m or more were found;"},
    Message{"worst.listed.one", "the worst by mean IRI is listed."},
    Message{"worst.listed.other", "the worst {count} by mean IRI are listed."},
    Message{"worst.caption", "Worst stretches, IRI ({unit})"},
    Message{"worst.remark",
            "Passes: the least that a segment has, and the median. Cars: the most that one segment "
            "has seen. The maps show the stretch in the colours of its segments, all other roads "
            "in grey, north up. Way: its number on the map, and metres from its first node, in the "
            "direction of driving."},
    Message{"stretch.part", "{way} from {from} to {to} m"},
    Message{"stretch.words", "Map of stretch {rank}: {road}"},
    Message{"stretch.title", "{rank} · {road}, towards {heading}"},
    Message{"stretch.mean", " ({interval}) over {length} m"},
    Message{"stretch.phone.one", ", at worst {worst}\n{passes} pass by {cars}"},
    Message{"stretch.phone.other", ", at worst {worst}\n{passes} passes by {cars}"},
    Message{"stretch.place", "Way {reference}\nMiddle {lat}, {lon}"},
    Message{"stretch.undated", "Not dated"},
    Message{"stretch.driven", "Driven {period}"},

    Message{"change", "Change since {day}"},
    Message{"change.nothing",
            "No segment has dated passes both before and since {day}: nothing can be compared."},
    Message{"change.about",
            "Each segment with dated passes on both sides of {day} is compared with itself: "
            "{compared}. Tested alone, {alone} of them lie beyond 1.96 standard deviations; if "
            "nothing had changed anywhere, about {chance} would. Called changed is therefore less: "
            "only so many that of those called about {share} at most are expected to be chance "
            "(Benjamini and Hochberg)."},
    Message{"change.caption",
            "Kilometres by what has become of them; mean change of IRI ({unit}), more than 0 is "
            "rougher"},
    Message{"change.remark",
            "No change shown: what differs may be chance; it does not say that nothing has "
            "changed. Before only, since only: passes on one side of the day alone, so that "
            "nothing can be compared. The mean change is of all that is comparable."},
    Message{"change.legend", "Change of IRI:"},
    Message{"change.not_comparable", "Not comparable"},
    Message{"change.words", "Map of what has changed since {day}"},
    Message{"change.mean", " ({interval}), from {before} to {since} over {length} m"},
    Message{"change.worse.caption", "Most deteriorated stretches, IRI ({unit})"},
    Message{"change.better.caption", "Most improved stretches, IRI ({unit})"},
    Message{"change.worse.none", "No stretch of {least} m or more has shown to be rougher."},
    Message{"change.better.none", "No stretch of {least} m or more has shown to be smoother."},

    Message{"sections", "Sections"},
    Message{"sections.about",
            "Means weighted by length. Intervals count errors that are alike all along a section, "
            "as of cars and method, in full. Stations fall where a road is driven against them. "
            "Passes: the least that a segment has, and the median."},
    Message{"sections.caption", "Sections, IRI ({unit})"},

    Message{"coverage", "Coverage"},
    Message{"coverage.caption", "Kilometres by kind of road, each direction counted"},
    Message{"coverage.remark",
            "{passed} of {segments} segments of about {length} m have a pass. Slip roads count "
            "with their road. What was driven is no random sample of the network."},

    Message{"data", "Cars and data"},
    Message{"data.own",
            "The report is of the operator's own cars and is not anonymised: who knows when a car "
            "was on a road may recognise it."},
    Message{"data.crowd",
            "Cars of others drove these roads. All figures are of the publication of {month} and "
            "rest on five cars or more; numbers of trips, cars and passes are rounded down, dates "
            "are months. Left out: up to {segments} segments ({km} km) that too few cars drove."},
    Message{"data.crowd.nothing",
            "Cars of others drove these roads, and nothing of them was published yet."},
    Message{"data.nothing", "No trip was imported yet."},
    Message{"data.remark",
            "Cars are numbered in the order in which they first drove. Model: from the user's own "
            "file, or a built-in one. On "
            "the map: the share of the distance that was matched to a road. Rows used: the share "
            "of the sensors' rows that entered an estimate."},
    Message{"cars.caption", "Cars and the quality of their data"},
    Message{"car.unnamed", "not named"},
    Message{"cars.more.one", "{count} more row"},
    Message{"cars.more.other", "{count} more rows"},
    Message{"model.own", "own file"},
    Message{"model.built_in", "built-in {model}"},
    Message{"quality.caption", "What the values of segments rest on"},
    Message{"quality.both_tracks", "Both wheel tracks: MRI observed"},
    Message{"quality.inferred", "Middle of the car: MRI inferred"},
    Message{"quality.lateral", "Lateral vibration alone: MRI inferred"},
    Message{"quality.too_slow", "A part driven too slowly to count"},
    Message{"quality.start_up", "A part within the start-up of the method"},
    Message{"quality.gap", "A part without data"},
    Message{"quality.remark",
            "MRI is the mean of both wheel tracks. Where only the middle of the car was felt, its "
            "HRI was measured and MRI inferred: MRI = HRI / {ratio}; real roads have {low} to "
            "{high}, which the interval counts. Such values are indicative. The three rows on "
            "parts hold for what every pass over a segment has."},
    Message{"quality.lateral_passes.one",
            "{count} pass is from lateral vibration alone, because the log had no vertical "
            "acceleration: far less accurate."},
    Message{"quality.lateral_passes.other",
            "{count} passes are from lateral vibration alone, because the log had no vertical "
            "acceleration: far less accurate."},
    Message{"reasons.caption", "Rows of the logs that entered no estimate, by reason"},
    Message{"reasons.not_kept", "Not kept by an earlier version"},
    Message{"reason.wrong_cell_count", "Wrong cell count"},
    Message{"reason.bad_number", "Bad number"},
    Message{"reason.out_of_range", "Out of range"},
    Message{"reason.no_time", "No time"},
    Message{"reason.no_sample", "No sample"},
    Message{"reason.time_not_increasing", "Time not increasing"},
    Message{"reason.unused_channel", "Unused channel"},
    Message{"reason.too_slow", "Too slow"},
    Message{"reason.short_stretch", "Short stretch"},
    Message{"reason.no_speed", "No speed"},
    Message{"reason.implausible", "Implausible"},
    Message{"reason.inaccurate", "Inaccurate"},
    Message{"reason.repeated_fix", "Repeated fix"},
    Message{"reason.merged", "Merged"},
    Message{"reason.trimmed", "Trimmed"},
    Message{"reason.sensor_moved", "Sensor moved"},

    Message{"reading", "How to read this report"},
    Message{"reading.iri.mm_per_m",
            "The International Roughness Index (IRI, ASTM E1926) is the stroke that the suspension "
            "of a reference car gathers at 80 km/h for each length of road: mm/m, which is the "
            "same as m/km; 1 mm/m is 63.36 in/mi. A new motorway has about {new}, a worn town "
            "street {worn} to {worn_to}, a broken road {broken} mm/m. Patches, joints, manhole "
            "covers, rails and speed humps count as roughness."},
    Message{"reading.iri.in_per_mi",
            "The International Roughness Index (IRI, ASTM E1926) is the stroke that the suspension "
            "of a reference car gathers at 80 km/h for each length of road, here in inches per "
            "mile (in/mi). A new motorway has about {new}, a worn town street {worn} to {worn_to}, "
            "a broken road {broken} in/mi. Patches, joints, manhole covers, rails and speed humps "
            "count as roughness."},
    Message{
        "reading.intervals",
        "Every figure stands for one direction of a road: a street driven both ways counts twice. "
        "Means and percentiles are weighted by length. An interval holds the true value with 90 % "
        "probability as far as the method knows its errors; half of their variance is taken to be "
        "common to all readings, so that the mean of many roads stays uncertain."},
    Message{"method", "Method"},
    Message{"method.cars", "Ordinary cars recorded acceleration, speed and position."},
    Message{"method.smoother",
            "Of all roads that could have made the car shake so, the method (smoother) finds the "
            "most probable ones, with a model of the car that has two axles; the reference car of "
            "the IRI is driven over them, and how they differ gives the interval."},
    Message{
        "method.kf",
        "A Kalman filter (kf) with a model of the car that has one axle estimates the road profile "
        "that made it shake; the reference car of the IRI is driven over that profile."},
    Message{"method.fusion",
            "Positions are matched to the map. Each pass gives a value for each segment, with a "
            "standard deviation; the passes of all cars are fused to a mean in which one bad pass "
            "hardly counts."},
    Message{"method.change",
            "Change: a segment's passes before the day and since are fused apart, and the two "
            "values compared. What all cars read wrong alike, by the model of the fusion, is on "
            "both sides and is not counted as noise of the difference: with standard deviations s1 "
            "and s2, and c1 and c2 of that common part, the variance of the difference is s1² − "
            "c1² + s2² − c2² + (c1 − c2)². Segments are called changed "
            "by the procedure of Benjamini and Hochberg with a false discovery rate of {share}. "
            "Stretches join segments that are called and that follow each other; their change is "
            "of all their segments, half of its variance common to them."},
    Message{"limits", "Limits"},
    Message{"limits.estimates",
            "These are estimates from the response of cars that are known only roughly. They tell "
            "rough roads from smooth ones and show change; they do not replace an inertial "
            "profiler (ASTM E950), for example for acceptance."},
    Message{"limits.tracks",
            "A value is of the tracks that the wheels took. Nothing is measured below 18 km/h, and "
            "little of holes that drivers avoid."},
    Message{"limits.segments",
            "Over 20 m, roughness scatters more than over 100 m or a kilometre: extremes of single "
            "segments are partly chance, which is why the worst roads are listed as stretches."},
    Message{"limits.smoother",
            "The method (smoother) has errors that go one way and are not corrected: on simulated "
            "cars, where the truth is known, a town's map read high by 2 %, slip roads low by 3 %, "
            "and intervals held about eight truths in ten."},
    Message{"limits.kf",
            "The method (kf) has errors that go one way and are not corrected. At speed it reads "
            "low, because its filters take off short waves; that is counted in the interval. On "
            "simulated cars, where the truth is known, a town's map read high by about a tenth, "
            "slip roads by about a half, which is more than the interval allows."},
    Message{"limits.change",
            "A change is of the passes, not of the road alone: other cars, another load or other "
            "tyres on one side of the day than on the other can pass for one. Small changes of "
            "single segments stay hidden in their intervals, and the largest changes listed are "
            "partly so large by chance."},

    Message{"source", "Source of the map"},
    Message{"source.roads", "Roads: {source}."},
    Message{"source.traced", "traced from the trips"},
};

} // namespace

std::span<const Message> english_messages() {
    return messages;
}

} // namespace macadam
