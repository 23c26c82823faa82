// How near passes of different cars come to each other on roads whose truth is known, and what that
// does to what they say together. A program to be read as much as passed: it prints what it
// measured.

#include "driven_chunks.hpp"

#include "mapping/alignment/alignment.hpp"
#include "mapping/fusion/fusion.hpp"
#include "mapping/passes/trip_cutting.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <tuple>

namespace macadam::testing {
namespace {

struct Distance {
    double p50_m;
    double p95_m;
};

Distance distance_of(std::vector<double> distances_m) {
    std::ranges::sort(distances_m);
    return {distances_m[distances_m.size() / 2], distances_m[distances_m.size() * 95 / 100]};
}

/// Each drive's lags, chunk by chunk.
using Lags = std::vector<std::vector<LagLine>>;

Lags lags_in(const DrivenChunks& driven) {
    Lags lags(driven.drives.size());
    for (std::size_t chunk = 0; chunk < driven.drives[0].traces.size(); ++chunk) {
        std::vector<RoughnessTrace> traces;
        for (const auto& drive : driven.drives) {
            traces.push_back(drive.traces.at(chunk));
        }
        const auto lines = lags_of(traces, {});
        for (std::size_t i = 0; i < lines.size(); ++i) {
            lags[i].push_back(lines[i]);
        }
    }
    return lags;
}

std::size_t chunk_at(const DrivenChunks& driven, double station_m) {
    const auto last = driven.drives[0].traces.size() - 1;
    return std::min(last, static_cast<std::size_t>(std::max(0.0, station_m) / chunk_length_m));
}

/// Where a drive's place comes to lie: p with p + lag(p) = place.
double laid_m(const DrivenChunks& driven, const std::vector<LagLine>& lags, double place_m) {
    double at_m = place_m;
    for (int round = 0; round < 10; ++round) { // lags change by centimetres a metre
        at_m = place_m - lag_m(lags[chunk_at(driven, at_m)], at_m);
    }
    return at_m;
}

/// How far apart all pairs of drives put the same metre of the road.
Distance apart(const DrivenChunks& driven, const Lags& lags) {
    constexpr double border_m = 15; // the first and last metres of the way are not covered by all
    std::vector<double> distances_m;
    for (double at_m = border_m; at_m < way_m - border_m; at_m += 5) {
        std::vector<double> places_m;
        for (std::size_t i = 0; i < driven.drives.size(); ++i) {
            const auto metre = static_cast<std::size_t>(at_m + way_begins_m);
            const double place_m = at_m + driven.drives[i].place_error_m[metre];
            places_m.push_back(lags.empty() ? place_m : laid_m(driven, lags[i], place_m));
        }
        for (std::size_t i = 0; i < places_m.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                distances_m.push_back(std::abs(places_m[i] - places_m[j]));
            }
        }
    }
    return distance_of(std::move(distances_m));
}

/// How far all drives put each metre from where it is.
Distance off_the_truth(const DrivenChunks& driven, const Lags& lags) {
    constexpr double border_m = 15;
    std::vector<double> distances_m;
    for (double at_m = border_m; at_m < way_m - border_m; at_m += 5) {
        for (std::size_t i = 0; i < driven.drives.size(); ++i) {
            const auto metre = static_cast<std::size_t>(at_m + way_begins_m);
            const double place_m = at_m + driven.drives[i].place_error_m[metre];
            distances_m.push_back(
                std::abs((lags.empty() ? place_m : laid_m(driven, lags[i], place_m)) - at_m));
        }
    }
    return distance_of(std::move(distances_m));
}

/// As if nobody knew how sure the places are.
DrivenChunks with_usual_sd(DrivenChunks driven) {
    for (auto& drive : driven.drives) {
        for (auto& trace : drive.traces) {
            trace.place_sd_mm = 2500; // what a match counts for that does not say
        }
    }
    return driven;
}

/// A part of a trace, with what lies 10 m before and behind.
RoughnessTrace piece_of(const RoughnessTrace& trace, double from_m, double to_m) {
    const auto cell = [&](double station_m) {
        return trace.iri.begin() +
               std::clamp<std::ptrdiff_t>(
                   std::lround(station_m) - trace.first_m, 0, std::ssize(trace.iri));
    };
    auto piece = trace;
    const auto first = cell(from_m - trace_margin_m);
    piece.iri = {first, cell(to_m + trace_margin_m)};
    piece.left.clear();
    piece.first_m += static_cast<std::int32_t>(first - trace.iri.begin());
    return piece;
}

/// As `apart`, where each piece of that length is a street of its own.
Distance apart_on_streets(const DrivenChunks& driven, double street_m) {
    std::vector<double> distances_m;
    constexpr std::size_t chunk = 1; // its traces know what lies beside the streets
    for (double from_m = chunk_length_m + 20; from_m + street_m < 2 * chunk_length_m - 20;
         from_m += street_m) {
        std::vector<RoughnessTrace> traces;
        for (const auto& drive : driven.drives) {
            traces.push_back(piece_of(drive.traces[chunk], from_m, from_m + street_m));
        }
        const auto lags = lags_of(traces, {});
        for (double at_m = from_m; at_m < from_m + street_m; at_m += 5) {
            std::vector<double> places_m;
            for (std::size_t i = 0; i < traces.size(); ++i) {
                const auto metre = static_cast<std::size_t>(at_m + way_begins_m);
                const double place_m = at_m + driven.drives[i].place_error_m[metre];
                places_m.push_back(place_m - lag_m(lags[i], at_m));
                for (std::size_t j = 0; j < i; ++j) {
                    distances_m.push_back(std::abs(places_m[i] - places_m[j]));
                }
            }
        }
    }
    return distance_of(std::move(distances_m));
}

/// What all drives read of one segment, as moved by their lags.
std::vector<FusionInput>
inputs_of(const DrivenChunks& driven, const Lags& lags, const Segment& segment) {
    const auto chunk = chunk_of(segment.key, 20).number;
    std::vector<FusionInput> inputs;
    for (std::size_t i = 0; i < driven.drives.size(); ++i) {
        const auto& drive = driven.drives[i];
        const auto pass = std::ranges::find(drive.passes, segment.key, &Pass::segment);
        if (pass == drive.passes.end()) {
            continue;
        }
        const auto line = lags.empty() ? LagLine{} : lags[i][chunk];
        inputs.push_back({moved(*pass,
                                segment.from_m,
                                segment.to_m,
                                drive.traces[chunk],
                                lag_m(line, segment.from_m),
                                lag_m(line, segment.to_m)),
                          std::to_string(i),
                          static_cast<std::int64_t>(i % 5),
                          std::nullopt});
    }
    return inputs;
}

double sd_of(const std::vector<double>& values) {
    const auto count = static_cast<double>(values.size());
    double sum = 0;
    double square = 0;
    for (const double value : values) {
        sum += value;
        square += value * value;
    }
    return std::sqrt(square / count - sum / count * (sum / count));
}

/// Relative errors at 20 m.
struct Fused {
    double error;   ///< of the fused segments, without what all have in common: cars that read the
                    ///< whole road 10 % too high do so wherever they are put
    double scatter; ///< of passes about the fused segment, without what a pass has in common
};

Fused fused(const DrivenChunks& driven, const Lags& lags) {
    const auto segments = segments_of(driven.roads, EdgeId{0});
    std::vector<double> errors;
    std::vector<std::vector<double>> of_drive(driven.drives.size());
    for (std::size_t k = 1; k + 1 < segments.size(); ++k) {
        const auto inputs = inputs_of(driven, lags, segments[k]);
        if (inputs.size() < driven.drives.size()) {
            continue;
        }
        const double iri_um = fuse(inputs, {}).iri_um;
        errors.push_back(std::log(iri_um / 1000 / driven.true_mri[k]));
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            of_drive[i].push_back(std::log(inputs[i].pass.iri_um / iri_um));
        }
    }
    double square = 0;
    for (const auto& deviations : of_drive) {
        square += std::pow(sd_of(deviations), 2) / static_cast<double>(of_drive.size());
    }
    return {sd_of(errors), std::sqrt(square)};
}

struct Score {
    Distance before;
    Distance after;
    Fused fused_before;
    Fused fused_after;
};

Score score_of(const ChunkScenario& scenario) {
    const auto driven = driven_chunks(scenario);
    const auto lags = lags_in(driven);
    const Score score{
        apart(driven, {}), apart(driven, lags), fused(driven, {}), fused(driven, lags)};
    std::printf("MRI %g, %zu passes, %s, %g patches and %g potholes a km:\n",
                scenario.iri_mm_per_m,
                scenario.passes,
                scenario.smoother ? "smoother" : "kf",
                scenario.patches_per_km,
                scenario.potholes_per_km);
    const auto tell = [](const char* when, const Distance& apart_m, const Fused& at_20_m) {
        std::printf("  %s: apart p50 %.2f m, p95 %.2f m; over 20 m passes differ by %.1f %%, fused "
                    "ones are off by %.1f %%\n",
                    when,
                    apart_m.p50_m,
                    apart_m.p95_m,
                    100 * at_20_m.scatter,
                    100 * at_20_m.error);
    };
    tell("as matched", score.before, score.fused_before);
    tell("laid on each other", score.after, score.fused_after);
    return score;
}

// Bounds of what was asked for (p95 of 1 m) with the default method; else what was reached, with a
// little room.

TEST(AlignmentAccuracy, OnASmoothRoad) {
    const auto score = score_of({.iri_mm_per_m = 1, .passes = 8, .smoother = true, .seed = 5});
    EXPECT_GT(score.before.p95_m, 4);
    EXPECT_LT(score.after.p95_m, 1);
    EXPECT_LT(score.fused_after.scatter, score.fused_before.scatter);
}

TEST(AlignmentAccuracy, OnAUsualRoad) {
    const auto score = score_of({.iri_mm_per_m = 2, .passes = 8, .smoother = true, .seed = 6});
    EXPECT_GT(score.before.p95_m, 4);
    EXPECT_LT(score.after.p95_m, 1);
    EXPECT_LT(score.fused_after.scatter, score.fused_before.scatter);
}

TEST(AlignmentAccuracy, OnARoughRoadWithPotholes) {
    const auto score = score_of({.iri_mm_per_m = 4,
                                 .passes = 8,
                                 .smoother = true,
                                 .seed = 7,
                                 .patches_per_km = 8,
                                 .potholes_per_km = 4});
    EXPECT_GT(score.before.p95_m, 4);
    EXPECT_LT(score.after.p95_m, 1);
    EXPECT_LT(score.fused_after.scatter, score.fused_before.scatter);
}

TEST(AlignmentAccuracy, OfTwoPasses) {
    EXPECT_LT(score_of({.iri_mm_per_m = 2, .passes = 2, .smoother = true, .seed = 8}).after.p95_m,
              1.2);
}

TEST(AlignmentAccuracy, OfCarsAndPhones) {
    const auto driven = driven_chunks({.iri_mm_per_m = 2,
                                       .passes = 8,
                                       .smoother = true,
                                       .seed = 9,
                                       .place_sd_m = 1,
                                       .phones_place_sd_m = 3});
    const auto usual = with_usual_sd(driven);
    const auto tell = [](const char* what, const Distance& apart_m, const Distance& off_m) {
        std::printf("  %s: apart p50 %.2f m, p95 %.2f m; off the truth p50 %.2f m, p95 %.2f m\n",
                    what,
                    apart_m.p50_m,
                    apart_m.p95_m,
                    off_m.p50_m,
                    off_m.p95_m);
    };
    std::printf("MRI 2, 4 cars whose places err by 1 m and 4 phones whose by 3 m:\n");
    tell("as matched", apart(driven, {}), off_the_truth(driven, {}));
    const auto by_usual = lags_in(usual);
    const auto by_own = lags_in(driven);
    tell("all taken for 2.5 m", apart(usual, by_usual), off_the_truth(usual, by_usual));
    tell("each by its own sd", apart(driven, by_own), off_the_truth(driven, by_own));
    EXPECT_LT(apart(driven, by_own).p95_m, 1.2); // places that err more change quicker, too
    EXPECT_LT(off_the_truth(driven, by_own).p95_m, 0.85 * off_the_truth(usual, by_usual).p95_m);
}

TEST(AlignmentAccuracy, OnStreets) {
    const auto driven =
        driven_chunks({.iri_mm_per_m = 2, .passes = 8, .smoother = true, .seed = 6});
    for (const double street_m : {60.0, 90.0, 120.0}) {
        const auto apart_m = apart_on_streets(driven, street_m);
        std::printf("MRI 2, 8 passes, streets of %g m: apart p50 %.2f m, p95 %.2f m\n",
                    street_m,
                    apart_m.p50_m,
                    apart_m.p95_m);
        EXPECT_LT(apart_m.p50_m, 0.6) << street_m; // as matched: 2.3 m
    }
}

TEST(AlignmentAccuracy, OfThePublishedFilter) {
    const auto score = score_of({.iri_mm_per_m = 2, .passes = 8, .smoother = false, .seed = 6});
    EXPECT_LT(score.after.p95_m, 2.2);
}

} // namespace
} // namespace macadam::testing
