#include "app/compare/comparison_output.hpp"

#include "storage/text/columns.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <cmath>

namespace macadam {
namespace {

JsonValue whole(std::size_t count) {
    return static_cast<std::int64_t>(count);
}

// ---------------------------------------------------------------------------------------- JSON

std::string json_of(const Estimate& estimate) {
    JsonObject object;
    object.add("value", json_number(estimate.value, 4))
        .add("low_95", json_number(estimate.low, 4))
        .add("high_95", json_number(estimate.high, 4));
    return object.text();
}

std::string json_of(const LimitsOfAgreement& limits) {
    JsonObject object;
    object.add("bias", JsonRaw{json_of(limits.bias)})
        .add("sd", json_number(limits.sd, 4))
        .add("lower_limit", JsonRaw{json_of(limits.lower)})
        .add("upper_limit", JsonRaw{json_of(limits.upper)})
        .add("independent", json_number(limits.independent, 1));
    return object.text();
}

JsonObject& add_agreement(JsonObject& object, const MethodAgreement& agreement) {
    return object.add("pairs", whole(agreement.pairs))
        .add("mean_a", json_number(agreement.mean_a, 4))
        .add("mean_b", json_number(agreement.mean_b, 4))
        .add("difference", JsonRaw{json_of(agreement.difference)})
        .add("relative_percent", JsonRaw{json_of(agreement.relative)});
}

std::string json_of(const GroupedAgreement& grouped) {
    std::vector<std::string> groups;
    for (const auto& [name, agreement] : grouped.groups) {
        JsonObject object;
        object.add("name", name);
        groups.push_back(add_agreement(object, agreement).text());
    }
    JsonObject object;
    object.add("property", grouped.property).add("groups", JsonRaw{json_array(groups)});
    return object.text();
}

std::string json_of(const SourceName& source) {
    JsonObject object;
    object.add("name", source.name)
        .add("kind", source.kind)
        .add("car", source.car.empty() ? JsonValue{nullptr} : JsonValue{source.car});
    return object.text();
}

std::string json_of(const SharedSegments& shared) {
    JsonObject object;
    object.add("km", JsonNumber{shared.km, 3})
        .add("only_a", whole(shared.only_a))
        .add("only_b", whole(shared.only_b))
        .add("cut_differently", whole(shared.cut_differently));
    return object.text();
}

std::string json_of(const BandAgreement& band) {
    const bool is_iri = band.band.to_m == 0;
    JsonObject object;
    object.add("band", std::string{band.band.name})
        .add("from_m", is_iri ? JsonValue{nullptr} : JsonValue{JsonNumber{band.band.from_m, 2}})
        .add("to_m", is_iri ? JsonValue{nullptr} : JsonValue{JsonNumber{band.band.to_m, 2}})
        .add("score", json_number(band.score, 4))
        .add("correlation", json_number(band.correlation, 4))
        .add("gain", json_number(band.gain, 4))
        .add("lag_m", json_number(band.lag_m, 3));
    return object.text();
}

std::string json_of(const ComparedTrack& track) {
    const auto& agreement = track.agreement;
    std::vector<std::string> bands;
    for (const auto& band : agreement.bands) {
        bands.push_back(json_of(band));
    }
    const double score = agreement.bands.front().score;
    JsonObject object;
    object.add("track", track.name)
        .add("shared_m", json_number(agreement.shared_m, 2))
        .add("iri_a", json_number(agreement.iri_a, 4))
        .add("iri_b", json_number(agreement.iri_b, 4))
        .add("meets_repeatability", score >= min_repeatability_score)
        .add("meets_accuracy", score >= min_accuracy_score)
        .add("bands", JsonRaw{json_array(bands)});
    return object.text();
}

template <typename Values>
std::string array_of(const Values& values) {
    std::vector<std::string> objects;
    for (const auto& value : values) {
        objects.push_back(json_of(value));
    }
    return json_array(objects);
}

// ----------------------------------------------------------------------------------------- CSV

struct GroupRow {
    std::string by; ///< property; "" = all pairs
    std::string name;
    MethodAgreement agreement;
};

struct BandRow {
    std::string track;
    TrackAgreement agreement;
    BandAgreement band;
};

bool is_waveband(const BandRow& row) {
    return row.band.band.to_m > 0;
}

// clang-format off
const Columns<GroupRow> group_columns{
    {"by", as::text, [](auto& r) { return r.by; }},
    {"name", as::text, [](auto& r) { return r.name; }},
    {"pairs", as::integer, [](auto& r) { return r.agreement.pairs; }},
    {"independent", as::real(1), [](auto& r) { return r.agreement.difference.independent; }},
    {"mean_a", as::iri(4), [](auto& r) { return r.agreement.mean_a; }},
    {"mean_b", as::iri(4), [](auto& r) { return r.agreement.mean_b; }},
    {"bias", as::iri(4), [](auto& r) { return r.agreement.difference.bias.value; }},
    {"bias_low_95", as::iri(4), [](auto& r) { return r.agreement.difference.bias.low; }},
    {"bias_high_95", as::iri(4), [](auto& r) { return r.agreement.difference.bias.high; }},
    {"sd", as::iri(4), [](auto& r) { return r.agreement.difference.sd; }},
    {"lower_limit", as::iri(4), [](auto& r) { return r.agreement.difference.lower.value; }},
    {"upper_limit", as::iri(4), [](auto& r) { return r.agreement.difference.upper.value; }},
    {"bias_percent", as::real(4), [](auto& r) { return r.agreement.relative.bias.value; }},
    {"lower_limit_percent", as::real(4), [](auto& r) { return r.agreement.relative.lower.value; }},
    {"upper_limit_percent", as::real(4), [](auto& r) { return r.agreement.relative.upper.value; }},
};

const Columns<BandRow> band_columns{
    {"track", as::text, [](auto& r) { return r.track; }},
    {"shared_m", as::metres(2), [](auto& r) { return r.agreement.shared_m; }},
    {"iri_a", as::iri(4), [](auto& r) { return r.agreement.iri_a; }},
    {"iri_b", as::iri(4), [](auto& r) { return r.agreement.iri_b; }},
    {"band", as::text, [](auto& r) { return r.band.band.name; }},
    {"from_m", as::metres(2), [](auto& r) { return known_if(is_waveband(r), r.band.band.from_m); }},
    {"to_m", as::metres(2), [](auto& r) { return known_if(is_waveband(r), r.band.band.to_m); }},
    {"score", as::real(4), [](auto& r) { return r.band.score; }},
    {"correlation", as::real(4), [](auto& r) { return r.band.correlation; }},
    {"gain", as::real(4), [](auto& r) { return r.band.gain; }},
    {"lag_m", as::metres(3), [](auto& r) { return r.band.lag_m; }},
};
// clang-format on

std::string bands_csv(const std::vector<ComparedTrack>& tracks, UnitSystem units) {
    const auto columns = in_units(band_columns, units);
    auto csv = csv_header(columns);
    for (const auto& [name, agreement] : tracks) {
        for (const auto& band : agreement.bands) {
            csv += csv_line(columns, {name, agreement, band});
        }
    }
    return csv;
}

// ---------------------------------------------------------------------------------------- text

std::string signed_text(double value, int decimals) {
    return std::isfinite(value) ? fmt::format("{:+.{}f}", value, decimals) : "-";
}

std::string plain_text(double value, int decimals) {
    return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "-";
}

std::string estimate_text(const Estimate& estimate) {
    return std::isfinite(estimate.low) ? fmt::format("{} [{}, {}]",
                                                     signed_text(estimate.value, 2),
                                                     signed_text(estimate.low, 2),
                                                     signed_text(estimate.high, 2))
                                       : signed_text(estimate.value, 2);
}

constexpr std::size_t name_width = 22;

std::string agreement_line(std::string name, const MethodAgreement& agreement) {
    if (name.size() > name_width) {
        name.resize(name_width - 2);
        name += "..";
    }
    const auto& difference = agreement.difference;
    return fmt::format("{:<24}{:>7}{:>7}{:>8}{:>8} {:>22}{:>7} {:>22} {:>22}{:>9}\n",
                       name,
                       agreement.pairs,
                       plain_text(difference.independent, 0),
                       plain_text(agreement.mean_a, 2),
                       plain_text(agreement.mean_b, 2),
                       estimate_text(difference.bias),
                       plain_text(difference.sd, 2),
                       estimate_text(difference.lower),
                       estimate_text(difference.upper),
                       signed_text(agreement.relative.bias.value, 1));
}

std::string agreement_head(const std::string& property) {
    return fmt::format("\n{:<24}{:>7}{:>7}{:>8}{:>8} {:>22}{:>7} {:>22} {:>22}{:>9}\n",
                       property,
                       "pairs",
                       "indep.",
                       "mean A",
                       "mean B",
                       "bias",
                       "SD",
                       "lower limit",
                       "upper limit",
                       "bias, %");
}

std::string source_line(const char* letter, const SourceName& source) {
    return fmt::format("{}  {} ({}{}{})\n",
                       letter,
                       source.name,
                       source.kind,
                       source.car.empty() ? "" : ", ",
                       source.car);
}

std::string track_text(const ComparedTrack& track, const Localisation& say) {
    const auto& agreement = track.agreement;
    const bool us = say.unit == IriUnit::in_per_mi;
    const double in_unit = us ? ft_of_m : 1;
    const auto* const length = us ? "ft" : "m";
    auto text = fmt::format("\ntrack {}: {:.0f} {} shared, IRI {:.2f} (A) and {:.2f} {} (B)\n"
                            "{:<24}{:>14}{:>8}{:>13}{:>8}{:>9}\n",
                            track.name,
                            agreement.shared_m * in_unit,
                            length,
                            agreement.iri_a,
                            agreement.iri_b,
                            say.iri_unit(),
                            "band",
                            "wavelengths",
                            "score",
                            "correlation",
                            "gain",
                            us ? "lag, ft" : "lag, m");
    for (const auto& band : agreement.bands) {
        text += fmt::format("{:<24}{:>14}{:>8.3f}{:>13.3f}{:>8.3f}{:>+9.2f}\n",
                            band.band.name,
                            band.band.to_m == 0 ? "golden car"
                                                : fmt::format("{:.3g} to {:.3g} {}",
                                                              band.band.from_m * in_unit,
                                                              band.band.to_m * in_unit,
                                                              length),
                            band.score,
                            band.correlation,
                            band.gain,
                            band.lag_m * in_unit);
    }
    const double score = agreement.bands.front().score;
    return text + fmt::format("AASHTO R 56: repeatability ({:.2f}) {}, accuracy ({:.2f}) {}\n",
                              min_repeatability_score,
                              score >= min_repeatability_score ? "met" : "not met",
                              min_accuracy_score,
                              score >= min_accuracy_score ? "met" : "not met");
}

} // namespace

std::string comparison_json(const SourceComparison& comparison) {
    JsonObject all;
    JsonObject object;
    object.add("a", JsonRaw{json_of(comparison.a)})
        .add("b", JsonRaw{json_of(comparison.b)})
        .add("unit", std::string{Localisation{.unit = comparison.unit}.iri_unit()})
        .add("shared",
             comparison.shared ? JsonValue{JsonRaw{json_of(*comparison.shared)}}
                               : JsonValue{nullptr})
        .add("interval_m",
             comparison.shared ? JsonValue{nullptr} : json_number(comparison.interval_m, 2))
        .add("all", JsonRaw{add_agreement(all, comparison.all).text()})
        .add("by", JsonRaw{array_of(comparison.groups)})
        .add("tracks", JsonRaw{array_of(comparison.tracks)});
    return object.text() + "\n";
}

std::string comparison_csv(const SourceComparison& comparison, UnitSystem units) {
    if (!comparison.shared) {
        return bands_csv(comparison.tracks, units);
    }
    const auto columns = in_units(group_columns, units);
    auto csv = csv_header(columns) + csv_line(columns, {"", "all", comparison.all});
    for (const auto& [property, groups] : comparison.groups) {
        for (const auto& [name, agreement] : groups) {
            csv += csv_line(columns, {property, name, agreement});
        }
    }
    return csv;
}

std::string comparison_text(const SourceComparison& comparison) {
    const Localisation say{.unit = comparison.unit};
    auto text = source_line("A", comparison.a) + source_line("B", comparison.b);
    if (comparison.shared) {
        const auto& shared = *comparison.shared;
        text += fmt::format("{} shared segments, {:.2f} {}; {} in A alone, {} in B alone",
                            comparison.all.pairs,
                            say.long_length(1000 * shared.km),
                            say.long_unit(),
                            shared.only_a,
                            shared.only_b);
        text += shared.cut_differently > 0
                    ? fmt::format(", {} cut differently by the maps\n", shared.cut_differently)
                    : "\n";
    }
    for (const auto& track : comparison.tracks) {
        text += track_text(track, say);
    }
    if (comparison.pairs.empty()) {
        return text;
    }
    text += agreement_head(
                comparison.shared
                    ? fmt::format("IRI, {}", say.iri_unit())
                    : fmt::format("IRI of {}, {}",
                                  length_words(comparison.interval_m,
                                               say.unit == IriUnit::in_per_mi ? UnitSystem::us
                                                                              : UnitSystem::si),
                                  say.iri_unit())) +
            agreement_line("all", comparison.all);
    for (const auto& [property, groups] : comparison.groups) {
        text += agreement_head(property);
        for (const auto& [name, agreement] : groups) {
            text += agreement_line(name, agreement);
        }
    }
    return text + "\nbias: mean of A - B; limits: bias -/+ 1.96 SD; [95 % intervals], for as many "
                  "independent pairs as stated\n";
}

} // namespace macadam
