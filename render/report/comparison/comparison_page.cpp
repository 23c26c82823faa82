#include "render/report/comparison/comparison_page.hpp"

#include "render/report/common_parts.hpp"
#include "render/report/comparison/agreement_figure.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace macadam {

using namespace document;

namespace {

constexpr const char* no_value = "–";

/// Returns the wording of the page.
Localisation english(IriUnit unit = IriUnit::mm_per_m) {
    return {.unit = unit};
}

std::string unit_of(const SourceComparison& comparison) {
    return std::string{english(comparison.unit).iri_unit()};
}

void scale(LimitsOfAgreement& limits, double factor) {
    for (auto* estimate : {&limits.bias, &limits.lower, &limits.upper}) {
        estimate->value *= factor;
        estimate->low *= factor;
        estimate->high *= factor;
    }
    limits.sd *= factor;
}

void scale(MethodAgreement& agreement, double factor) {
    agreement.mean_a *= factor;
    agreement.mean_b *= factor;
    scale(agreement.difference, factor);
}

/// Formats a length on the road of some metres: "20 m", "66 ft".
std::string length_text(double length_m, const SourceComparison& comparison) {
    return comparison.unit == IriUnit::mm_per_m
               ? fmt::format("{:g} m", length_m)
               : english(comparison.unit).short_length(length_m) + " ft";
}

std::string signed_text(double value, int decimals = 2) {
    return std::isfinite(value) ? english().signed_number(value, decimals) : no_value;
}

std::string plain_text(double value, int decimals = 2) {
    return std::isfinite(value) ? english().number(value, decimals) : no_value;
}

std::string interval_text(const Estimate& estimate, int decimals) {
    return std::isfinite(estimate.low) ? fmt::format("{} to {}",
                                                     signed_text(estimate.low, decimals),
                                                     signed_text(estimate.high, decimals))
                                       : std::string{};
}

/// Returns the value with its interval in the line below.
Cell estimate_cell(const Estimate& estimate, int decimals = 2) {
    RichText text = signed_text(estimate.value, decimals);
    if (const auto interval = interval_text(estimate, decimals); !interval.empty()) {
        text.spans.push_back({"\n" + interval, SpanLook::quiet});
    }
    return text;
}

std::string described(const SourceName& source) {
    return source.car.empty() ? source.name : fmt::format("{}, {}", source.name, source.car);
}

const char* piece_word(const SourceComparison& comparison) {
    return comparison.shared ? "segments" : "intervals";
}

std::string limits_text(const LimitsOfAgreement& limits, int decimals) {
    return fmt::format("{} to {}",
                       signed_text(limits.lower.value, decimals),
                       signed_text(limits.upper.value, decimals));
}

KeyNumbers keys_of(const SourceComparison& comparison) {
    const auto& [pairs, mean_a, mean_b, difference, relative] = comparison.all;
    const auto length =
        comparison.shared
            ? fmt::format(
                  "{} {} of road",
                  english().number(
                      english(comparison.unit).long_length(1000 * comparison.shared->km), 2),
                  english(comparison.unit).long_unit())
            : "of " + length_text(comparison.interval_m, comparison);
    KeyNumbers keys{
        {{fmt::format("Shared {}", piece_word(comparison)), english().count(pairs), length}}};
    if (pairs == 0) {
        return keys;
    }
    auto bias = signed_text(relative.bias.value, 1) + " %";
    if (const auto interval = interval_text(difference.bias, 2); !interval.empty()) {
        bias = fmt::format("95 %: {}\n{}", interval, bias);
    }
    keys.numbers.push_back(
        {"Bias A − B, " + unit_of(comparison), signed_text(difference.bias.value), bias});
    if (std::isfinite(difference.sd)) {
        keys.numbers.push_back({"Limits of agreement, " + unit_of(comparison),
                                limits_text(difference, 2),
                                "about 95 % of differences\n" + limits_text(relative, 1) + " %"});
    }
    return keys;
}

std::vector<Column> agreement_columns(const SourceComparison& comparison) {
    return {{"Group"},
            {comparison.shared ? "Segments" : "Intervals", true},
            {"Independent", true},
            {"Mean A", true},
            {"Mean B", true},
            {"Bias", true},
            {"SD", true},
            {"Lower limit", true},
            {"Upper limit", true},
            {"Bias, %", true}};
}

std::vector<Cell> agreement_row(std::string name, const MethodAgreement& agreement) {
    const auto& difference = agreement.difference;
    return {std::move(name),
            english().count(agreement.pairs),
            plain_text(difference.independent, 0),
            plain_text(agreement.mean_a),
            plain_text(agreement.mean_b),
            estimate_cell(difference.bias),
            plain_text(difference.sd),
            estimate_cell(difference.lower),
            estimate_cell(difference.upper),
            estimate_cell(agreement.relative.bias, 1)};
}

DocumentSection agreement_section(const SourceComparison& comparison) {
    DocumentSection section{"Agreement", {}};
    if (comparison.pairs.empty()) {
        section.blocks.emplace_back(Paragraph{"The sources have no " +
                                              std::string{piece_word(comparison)} + " in common."});
        return section;
    }
    auto [drawing, outside] =
        agreement_figure(comparison.pairs, comparison.all, english(comparison.unit));
    section.blocks.emplace_back(Paragraph{fmt::format(
        "Each dot is one of the {}: the difference of both IRI over their mean. Dashed lines are "
        "the bias and the limits of agreement, between which about 95 % of the differences lie; "
        "the orange bars are their 95 % intervals.",
        piece_word(comparison))});
    section.blocks.emplace_back(std::move(drawing));
    if (outside > 0) {
        section.blocks.emplace_back(
            Paragraph{fmt::format("{} with larger differences not shown.",
                                  outside == 1 ? "One dot" : english().count(outside) + " dots"),
                      true});
    }
    return section;
}

DocumentSection groups_section(const SourceComparison& comparison) {
    Table table{fmt::format("IRI in {}; 95 % intervals below the values", unit_of(comparison)),
                agreement_columns(comparison),
                {agreement_row("All", comparison.all)}};
    table.stacks = true;
    for (const auto& [property, groups] : comparison.groups) {
        std::vector<Cell> heading{RichText{std::vector<Span>{{property, SpanLook::strong}}}};
        heading.resize(table.columns.size(), Cell{""});
        table.rows.push_back(std::move(heading));
        for (const auto& [name, agreement] : groups) {
            table.rows.push_back(agreement_row(name, agreement));
        }
    }
    return {"In numbers", {std::move(table)}};
}

std::string waves_text(const ProfileBand& band, const SourceComparison& comparison) {
    if (band.to_m == 0) {
        return "golden car";
    }
    return comparison.unit == IriUnit::mm_per_m
               ? fmt::format("{:g} – {:g} m", band.from_m, band.to_m)
               : fmt::format("{:.1f} – {:.1f} ft", band.from_m / 0.3048, band.to_m / 0.3048);
}

std::string verdict_text(const TrackAgreement& track) {
    const double score = track.bands.front().score;
    const auto meets = [&](double minimum) { return score >= minimum ? "meets" : "is below"; };
    return fmt::format("The score of the IRI-filtered profiles, {:.3f}, {} the {:.2f} that AASHTO "
                       "R 56 requires between runs of one profiler (repeatability), and {} the "
                       "{:.2f} against a reference profile (accuracy); both are means over many "
                       "pairs of runs there.",
                       score,
                       meets(min_repeatability_score),
                       min_repeatability_score,
                       meets(min_accuracy_score),
                       min_accuracy_score);
}

DocumentSection track_section(const ComparedTrack& track, const SourceComparison& comparison) {
    const bool is_us = comparison.unit == IriUnit::in_per_mi;
    const auto& agreement = track.agreement;
    Table table{fmt::format("Track {}, {} {}: IRI {} (A) and {} {} (B)",
                            track.name,
                            english(comparison.unit).short_length(agreement.shared_m),
                            is_us ? "ft" : "m",
                            plain_text(agreement.iri_a),
                            plain_text(agreement.iri_b),
                            unit_of(comparison)),
                {{"Band"},
                 {"Wavelengths"},
                 {"Score", true},
                 {"Correlation", true},
                 {"Gain A/B", true, true},
                 {is_us ? "Lag, ft" : "Lag, m", true}},
                {}};
    for (const auto& band : agreement.bands) {
        table.rows.push_back({std::string{band.band.name},
                              waves_text(band.band, comparison),
                              plain_text(band.score, 3),
                              plain_text(band.correlation, 3),
                              plain_text(band.gain, 3),
                              signed_text(is_us ? band.lag_m / 0.3048 : band.lag_m)});
    }
    return {"Profiles: " + track.name, {Paragraph{verdict_text(agreement)}, std::move(table)}};
}

DocumentSection method_section(const SourceComparison& comparison) {
    Bullets bullets;
    if (comparison.shared) {
        const auto& shared = *comparison.shared;
        bullets.items.emplace_back(fmt::format("{} segments are known to A alone, {} to B alone.",
                                               english().count(shared.only_a),
                                               english().count(shared.only_b)));
        if (shared.cut_differently > 0) {
            bullets.items.emplace_back(
                fmt::format("{} segments are left out because their ends differ between the maps.",
                            english().count(shared.cut_differently)));
        }
    } else {
        bullets.items.emplace_back(
            "A score is the correlation of the filtered profiles times the ratio of the smaller to "
            "the larger standard deviation, at the best lag. A positive lag means that B has the "
            "same road at larger stations.");
    }
    bullets.items.emplace_back(fmt::format(
        "Neighbouring {0} have similar errors. “Independent” is the number of independent {0} that "
        "would tell as much about the bias; all intervals are computed with it.",
        piece_word(comparison)));
    bullets.items.emplace_back(
        "An error that all roads share, such as that of one car, is in the bias and not in its "
        "interval.");
    if (comparison.tracks.size() > 1) {
        bullets.items.emplace_back(
            "The tracks count as independent of each other. Left and right are alike, so that the "
            "intervals over both are too narrow.");
    }
    DocumentSection section{"How to read this", {std::move(bullets)}};
    if (comparison.is_own) {
        section.blocks.emplace_back(Paragraph{english()("data.own")});
    }
    return section;
}

} // namespace

SourceComparison in_per_mi(SourceComparison comparison) {
    constexpr double factor = in_per_mi_of_mm_per_m;
    for (auto& pair : comparison.pairs) {
        pair.a *= factor;
        pair.b *= factor;
    }
    scale(comparison.all, factor);
    for (auto& property : comparison.groups) {
        for (auto& group : property.groups) {
            scale(group.agreement, factor);
        }
    }
    for (auto& track : comparison.tracks) {
        track.agreement.iri_a *= factor;
        track.agreement.iri_b *= factor;
    }
    comparison.unit = IriUnit::in_per_mi;
    return comparison;
}

Document comparison_document(const SourceComparison& comparison) {
    const auto title = fmt::format("{} and {}", described(comparison.a), described(comparison.b));
    Document document{.language = "en",
                      .title = title,
                      .subtitle = fmt::format("Comparison of two sources of roughness. A: {} ({}). "
                                              "B: {} ({}).",
                                              described(comparison.a),
                                              comparison.a.kind,
                                              described(comparison.b),
                                              comparison.b.kind),
                      .running_head = title,
                      .page_of = "Page {page} of {pages}",
                      .day = "",
                      .keys = keys_of(comparison),
                      .sections = {},
                      .end = {method_section(comparison)},
                      .words = page_words(Localisation{}, false)};
    for (const auto& track : comparison.tracks) {
        document.sections.push_back(track_section(track, comparison));
    }
    document.sections.push_back(agreement_section(comparison));
    if (!comparison.pairs.empty()) {
        document.sections.push_back(groups_section(comparison));
    }
    return document;
}

} // namespace macadam
