#include "app/store/truth_output.hpp"

#include "app/cli/row_writer.hpp"
#include "estimator/common/error.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/surveys/truth_file.hpp"

#include <fmt/format.h>

#include <string_view>
#include <vector>

namespace macadam {
namespace {

using Row = TruthComparison::Class;
using Band = TruthComparison::Band;

double bias_share(const Row& row) {
    return row.score.bias / row.score.mean_truth;
}

// clang-format off
const Columns<Row> columns{
    {"group", as::csv_only(as::text),
     [](auto& r) { return r.highway.empty() ? "(no class)" : r.highway; }},
    {"", as::text, [](auto& r) { return r.highway.empty() ? "(no class)" : r.highway; },
     {"against truth", "{:<16}"}},
    {"segments", as::integer, [](auto& r) { return r.score.segments; }, {"segments", "{:>9}"}},
    {"km", as::real(3, "km"), [](auto& r) { return r.score.km; }, {"km", "{:>8}", 2}},
    {"mean_truth", as::iri(4), [](auto& r) { return r.score.mean_truth; }, {"truth", "{:>8}", 2}},
    {"bias", as::iri(4), [](auto& r) { return r.score.bias; }, {"bias", "{:>8}", 2}},
    {"bias_share", as::real(4), bias_share},
    {"", as::real(1, "%"), [](auto& r) { return 100 * bias_share(r); }, {"bias %", "{:>8}"}},
    {"rmse_20m", as::iri(4), [](auto& r) { return r.score.rmse; }, {"RMSE", "{:>8}", 2}},
    {"runs_100m", as::integer, [](auto& r) { return r.score.runs; }},
    {"rmse_100m", as::iri(4), [](auto& r) { return r.score.rmse_100m; }, {"of five", "{:>8}", 2}},
    {"correlation", as::real(4), [](auto& r) { return r.score.correlation; }, {"corr.", "{:>8}", 2}},
    {"coverage_90", as::real(4), [](auto& r) { return r.score.coverage; }},
    {"", as::real(0, "%"), [](auto& r) { return 100 * r.score.coverage; }, {"in 90 %", "{:>8}"}},
};

Columns<Row> class_columns(UnitSystem units) {
    return {{"highway", as::text, [](auto& r) { return r.highway; }},
            {"score", as::raw,
             [units](auto& r) { return json_object(in_units(columns, units), r).text(); }}};
}

/// \param unit  of the limits
Columns<Band> band_columns(std::string_view unit, UnitSystem units) {
    return in_units<Band>(
        {{"from", as::real(0, unit), [](auto& r) { return r.from; }},
         {"to", as::real(0, unit), [](auto& r) { return r.to; }},
         {"score", as::raw,
          [units](auto& r) { return json_object(in_units(columns, units), Row{"", r.score}).text(); }}},
        units);
}
// clang-format on

/// Names of bands: "IRI 1 to 2", "over 85 km/h".
struct BandWords {
    std::string_view quantity; ///< before the limits
    std::string_view unit;     ///< after them
    double factor = 1;         ///< of the limits
};

std::vector<Row> rows_of(const std::vector<Band>& bands, const BandWords& words) {
    std::vector<Row> rows;
    for (const auto& [from, to, score] : bands) {
        const auto limit = [&](double value) {
            return words.factor == 1 ? fmt::format("{:g}", value)
                                     : fmt::format("{:.0f}", value * words.factor);
        };
        const auto limits = !to         ? fmt::format("over {}", limit(from))
                            : from == 0 ? fmt::format("below {}", limit(*to))
                                        : fmt::format("{} to {}", limit(from), limit(*to));
        rows.push_back({fmt::format("{}{}{}", words.quantity, limits, words.unit), score});
    }
    return rows;
}

std::vector<Row> rows_of(const TruthComparison& comparison, UnitSystem units) {
    const bool us = units == UnitSystem::us;
    const BandWords levels{"IRI ", "", us ? in_per_mi_of_mm_per_m : 1};
    const BandWords speeds{"", us ? " mph" : " km/h", us ? 1000 * mi_of_m : 1};
    std::vector<Row> rows{{"all", comparison.all}};
    rows.insert(rows.end(), comparison.classes.begin(), comparison.classes.end());
    for (const auto& bands :
         {rows_of(comparison.levels, levels), rows_of(comparison.speeds, speeds)}) {
        rows.insert(rows.end(), bands.begin(), bands.end());
    }
    return rows;
}

} // namespace

TruthComparison compared(const StoreReader& store, const std::filesystem::path& file) {
    const auto truth = read_truth(file);
    std::vector<SegmentRecord> states;
    store.visit({}, [&](const SegmentRecord& record) { states.push_back(record); });
    auto comparison = compare_with_truth(states, truth, store.mean_speeds_kmh());
    if (comparison.all.segments == 0) {
        throw InputError{fmt::format("{}: contains none of the {} measured segments, expected "
                                     "true values of this network",
                                     file.string(),
                                     states.size())};
    }
    return comparison;
}

std::string text_of(const TruthComparison& comparison, UnitSystem units) {
    const bool us = units == UnitSystem::us;
    return table_text(in_units(columns, units), rows_of(comparison, units)) +
           fmt::format("IRI (MRI) in {}; RMSE of single segments, and of five in a row (about {}); "
                       "share of true\n"
                       "values within the 90 % interval, %. Bands of the true IRI, and of the "
                       "passes' mean speed.\n",
                       us ? "in/mi" : "mm/m",
                       us ? "330 ft" : "100 m");
}

std::string csv_of(const TruthComparison& comparison, UnitSystem units) {
    return rows_text(in_units(columns, units), rows_of(comparison, units), "csv");
}

std::string json_of(const TruthComparison& comparison, UnitSystem units) {
    JsonObject object;
    object.add("all", JsonRaw{json_object(in_units(columns, units), {"", comparison.all}).text()})
        .add("classes", JsonRaw{json_rows(class_columns(units), comparison.classes)})
        .add("by_level", JsonRaw{json_rows(band_columns("mm/m", units), comparison.levels)})
        .add("by_speed", JsonRaw{json_rows(band_columns("km/h", units), comparison.speeds)});
    return object.text();
}

} // namespace macadam
