#include "app/commands.hpp"

#include "estimator/common/error.hpp"
#include "estimator/iri.hpp"
#include "mapping/iri_class.hpp"
#include "storage/json.hpp"
#include "storage/profile_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace macadam {
namespace {

constexpr double reliable_after_m = 60; // of lead-in: 0.1 % of the golden car's transient is left

struct IriOptions {
    std::filesystem::path profile;
    std::optional<double> step_m;
    std::optional<double> from_m;
    std::optional<double> to_m;
    std::optional<double> length_m; ///< nothing: one value for the whole
    bool in_per_mi;
    bool envelope;
    bool json;
};

IriOptions parse_iri(const Arguments& arguments) {
    constexpr std::array<std::string_view, 2> units{"mm/m", "in/mi"};
    IriOptions options{.profile = arguments.operand("PROFILE"),
                       .step_m = arguments.number("--step"),
                       .from_m = arguments.number("--from"),
                       .to_m = arguments.number("--to"),
                       .length_m = arguments.number("--length"),
                       .in_per_mi = arguments.choice("--unit", units) == "in/mi",
                       .envelope = !arguments.flag("--no-envelope"),
                       .json = arguments.flag("--json")};
    if (options.step_m && !(*options.step_m > 0)) {
        throw UsageError{fmt::format("--step is {}, expected a length over 0 m", *options.step_m)};
    }
    if (options.length_m && !(*options.length_m > 0)) {
        throw UsageError{
            fmt::format("--length is {}, expected a length over 0 m", *options.length_m)};
    }
    return options;
}

/// IRI of every piece between two borders, one track.
using Iris = std::vector<double>;

/// Means of `stroke` over the pieces; value i belongs to [i, i + 1) * step_m from `start_m` on.
Iris sampled_means(const std::vector<float>& stroke,
                   double start_m,
                   double step_m,
                   const std::vector<double>& borders_m) {
    const auto index_at = [&](double station_m) {
        const auto index = std::ceil((station_m - start_m) / step_m - 1e-6);
        return std::clamp<std::ptrdiff_t>(
            static_cast<std::ptrdiff_t>(index), 0, std::ssize(stroke));
    };
    Iris means;
    for (std::size_t i = 0; i + 1 < borders_m.size(); ++i) {
        const auto first = stroke.begin() + index_at(borders_m[i]);
        const auto last = stroke.begin() + index_at(borders_m[i + 1]);
        means.push_back(std::accumulate(first, last, 0.0) /
                        static_cast<double>(std::max<std::ptrdiff_t>(1, last - first)));
    }
    return means;
}

struct Analysis {
    const MeasuredProfile& profile;
    const IriOptions& options;
    std::vector<double> borders_m;

    bool sampled() const { return profile.even_step_m.has_value(); }

    Iris of(const std::vector<double>& elevation_m) const {
        if (sampled()) {
            return sampled_means(
                rectified_stroke_mm_per_m(elevation_m, *profile.even_step_m, options.envelope),
                profile.station_m.front(),
                *profile.even_step_m,
                borders_m);
        }
        return exact_iri_mm_per_m(profile.station_m, elevation_m, borders_m, options.envelope);
    }
};

/// Where the last value of the rectified stroke ends: the envelope eats the end of the profile.
double last_station_m(const MeasuredProfile& profile, const IriOptions& options) {
    const double end_m = profile.station_m.back();
    if (!options.envelope || !profile.even_step_m) {
        return end_m;
    }
    const double steps = std::max(1.0, std::floor(contact_patch_m / *profile.even_step_m + 0.5));
    return end_m - (steps - 1) * *profile.even_step_m;
}

std::vector<double> borders_of(const MeasuredProfile& profile, const IriOptions& options) {
    const double start_m = profile.station_m.front();
    const double end_m = last_station_m(profile, options);
    const double from_m = options.from_m.value_or(start_m);
    const double to_m = std::min(options.to_m.value_or(end_m), end_m);
    if (!(from_m >= start_m && from_m < to_m)) {
        throw InputError{fmt::format(
            "{}: --from {:g} --to {:g} holds nothing of the profile, expected {:g} to {:g} m",
            options.profile.string(),
            from_m,
            options.to_m.value_or(end_m),
            start_m,
            end_m)};
    }
    if (!options.length_m) {
        return {from_m, to_m};
    }
    const double step_m =
        (profile.station_m.back() - start_m) / static_cast<double>(profile.station_m.size() - 1);
    if (*options.length_m < step_m) {
        throw InputError{fmt::format("{}: has a point every {:.3f} m, --length {} is shorter",
                                     options.profile.string(),
                                     step_m,
                                     *options.length_m)};
    }
    std::vector<double> borders_m{from_m};
    while (borders_m.back() + *options.length_m <= to_m + 1e-6) {
        borders_m.push_back(from_m + static_cast<double>(borders_m.size()) * *options.length_m);
    }
    borders_m.back() = std::min(borders_m.back(), to_m);
    if (borders_m.size() < 2) {
        throw InputError{fmt::format("{}: {:g} m from {:g} to {:g} are shorter than --length {:g}",
                                     options.profile.string(),
                                     to_m - from_m,
                                     from_m,
                                     to_m,
                                     *options.length_m)};
    }
    return borders_m;
}

const std::vector<double>* track_named(const MeasuredProfile& profile, std::string_view name) {
    const auto found = std::ranges::find(profile.tracks, name, &MeasuredProfile::Track::name);
    return found == profile.tracks.end() ? nullptr : &found->elevation_m;
}

std::vector<double> mean_of(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> mean(a.size());
    std::ranges::transform(a, b, mean.begin(), [](double x, double y) { return (x + y) / 2; });
    return mean;
}

/// Everything there is to print, in mm/m.
struct IriReport {
    std::vector<double> borders_m;
    struct Channel {
        std::string name;
        Iris iri;
    };
    std::vector<Channel> channels;
    std::optional<Iris> mri;
    std::optional<Iris> hri;
    std::vector<bool> lead_in;
};

/// Length-weighted: all pieces are of one length, but for rounding at the ends.
double whole_of(const Iris& iri) {
    return std::accumulate(iri.begin(), iri.end(), 0.0) / static_cast<double>(iri.size());
}

IriReport report_of(const MeasuredProfile& profile, const IriOptions& options) {
    const Analysis analysis{profile, options, borders_of(profile, options)};
    IriReport report{
        .borders_m = analysis.borders_m, .channels = {}, .mri = {}, .hri = {}, .lead_in = {}};
    for (const auto& track : profile.tracks) {
        report.channels.push_back({track.name, analysis.of(track.elevation_m)});
    }
    const auto* const left_m = track_named(profile, "left");
    const auto* const right_m = track_named(profile, "right");
    if (left_m && right_m) {
        report.mri = mean_of(analysis.of(*left_m), analysis.of(*right_m));
        report.hri = analysis.of(mean_of(*left_m, *right_m));
    }
    for (std::size_t i = 0; i + 1 < report.borders_m.size(); ++i) {
        report.lead_in.push_back(report.borders_m[i] - profile.station_m.front() <
                                 reliable_after_m - 1e-6);
    }
    return report;
}

std::string
json_of(const IriReport& report, const MeasuredProfile& profile, const IriOptions& options) {
    const double scale = options.in_per_mi ? in_per_mi_of_mm_per_m : 1;
    const auto value = [&](double iri) { return JsonNumber{scale * iri, 6}; };

    std::vector<std::string> channels;
    for (const auto& channel : report.channels) {
        std::vector<std::string> segments;
        for (std::size_t i = 0; i < channel.iri.size(); ++i) {
            JsonObject segment;
            segment.add("from_m", JsonNumber{report.borders_m[i], 3})
                .add("to_m", JsonNumber{report.borders_m[i + 1], 3})
                .add("iri", value(channel.iri[i]))
                .add("lead_in", bool{report.lead_in[i]});
            if (report.mri) {
                segment.add("mri", value((*report.mri)[i])).add("hri", value((*report.hri)[i]));
            }
            segments.push_back(segment.text());
        }
        JsonObject object;
        object.add("name", channel.name)
            .add("iri", value(whole_of(channel.iri)))
            .add("segments", JsonRaw{json_array(segments)});
        channels.push_back(object.text());
    }
    const bool sampled = profile.even_step_m.has_value();
    const auto whole = [&](const std::optional<Iris>& iri) {
        return iri ? json_number(scale * whole_of(*iri), 6) : JsonValue{nullptr};
    };
    JsonObject object;
    object.add("channels", JsonRaw{json_array(channels)})
        .add("mri", whole(report.mri))
        .add("hri", whole(report.hri))
        .add("unit", std::string{options.in_per_mi ? "in/mi" : "mm/m"})
        .add("method", std::string{sampled ? "sampled" : "exact"})
        .add("step_m", json_number(profile.even_step_m, 6))
        .add("envelope_samples",
             sampled && options.envelope
                 ? JsonValue{static_cast<std::int64_t>(
                       std::max(1.0, std::floor(contact_patch_m / *profile.even_step_m + 0.5)))}
                 : JsonValue{nullptr});
    return object.text() + "\n";
}

std::string csv_of(const IriReport& report, const IriOptions& options) {
    const double scale = options.in_per_mi ? in_per_mi_of_mm_per_m : 1;
    std::string csv = "from_m,to_m";
    for (const auto& channel : report.channels) {
        csv += fmt::format(",iri_{}", channel.name);
    }
    csv += report.mri ? ",mri,hri,lead_in\n" : ",lead_in\n";
    for (std::size_t i = 0; i + 1 < report.borders_m.size(); ++i) {
        csv += fmt::format("{:.3f},{:.3f}", report.borders_m[i], report.borders_m[i + 1]);
        for (const auto& channel : report.channels) {
            csv += fmt::format(",{:.4f}", scale * channel.iri[i]);
        }
        if (report.mri) {
            csv +=
                fmt::format(",{:.4f},{:.4f}", scale * (*report.mri)[i], scale * (*report.hri)[i]);
        }
        csv += report.lead_in[i] ? ",yes\n" : ",no\n";
    }
    return csv;
}

/// The profile from `from_m` on, where so little lies before it (less than the base of the start
/// slope) that the car had better start there. Otherwise all of it: what lies before is lead-in.
MeasuredProfile started_at(MeasuredProfile profile, std::optional<double> from_m) {
    if (!from_m || *from_m - profile.station_m.front() >= start_up_m) {
        return profile;
    }
    // The last station at or before it, so that the line to the next one is not lost.
    const auto after = std::ranges::upper_bound(profile.station_m, *from_m + 1e-6);
    const auto skipped = std::max<std::ptrdiff_t>(0, after - profile.station_m.begin() - 1);
    const auto first = profile.station_m.begin() + skipped;
    for (auto& track : profile.tracks) {
        track.elevation_m.erase(track.elevation_m.begin(), track.elevation_m.begin() + skipped);
    }
    profile.station_m.erase(profile.station_m.begin(), first);
    return profile;
}

void run_iri(const Arguments& arguments, const Console&) {
    const auto options = parse_iri(arguments);
    const auto profile = started_at(read_profile(options.profile, options.step_m), options.from_m);
    const auto report = report_of(profile, options);
    print(options.json ? json_of(report, profile, options) : csv_of(report, options));
}

constexpr std::array operands{Operand{
    "PROFILE", "Elevations of one or more wheel tracks: .csv with a header, or .txt without one."}};

constexpr std::array options{
    Option{"--step",
           "METRES",
           "The file has no stations: all columns are tracks, this far from row to row."},
    Option{"--from", "METRES", "Station at which the reported part begins.", "the first"},
    Option{"--to", "METRES", "Station at which it ends.", "the last"},
    Option{"--length", "METRES", "Report pieces of this length.", "one for the whole"},
    Option{"--unit", "UNIT", "mm/m (the same as m/km) or in/mi.", "mm/m"},
    Option{"--no-envelope", "", "The profile is already smoothed over the tyre's 250 mm contact."},
    Option{"--json", "", "One JSON object instead of CSV."}};

} // namespace

const Command iri_command{
    .name = "iri",
    .summary = "Reference IRI of a measured profile, by ASTM E1926",
    .about = "The golden car runs once through the whole profile; pieces are cut from its response "
             "afterwards, so\n"
             "their borders do not disturb it. Even stations are taken as they are, never "
             "resampled; uneven ones\n"
             "are solved exactly. Columns left_m and right_m also give MRI (the mean of the two "
             "IRI) and HRI (the\n"
             "IRI of the mean profile). lead_in marks pieces that begin within 60 m of the "
             "profile's start, where\n"
             "the car's start may still show. With --from, what lies before serves as lead-in; "
             "where that is less\n"
             "than 11 m the car starts there.",
    .example = "  macadam iri profile.csv --length 100          station_m,left_m,right_m\n"
               "  macadam iri heights.txt --step 0.25 --unit in/mi --json",
    .operands = operands,
    .options = options,
    .run = run_iri};

} // namespace macadam
