#include "render/report/html.hpp"
#include "render/report/numbers.hpp"
#include "render/report/parts.hpp"
#include "render/report/sections.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace macadam {
namespace {

constexpr std::size_t most_vehicles = 30; // a page of them; the rest stands in one row

std::vector<std::string> row_of(const ReportVehicle& vehicle, const std::string& name) {
    return {name,
            escaped(vehicle.model),
            escaped(vehicle.method),
            count_text(vehicle.trips),
            count_text(vehicle.undated_trips),
            fmt::format("{:.1f}", vehicle.km),
            percent_text(vehicle.matched_km, vehicle.km),
            percent_text(static_cast<double>(vehicle.rows_used),
                         static_cast<double>(vehicle.rows_read)),
            count_text(vehicle.passes)};
}

HtmlTable vehicle_table(const std::vector<ReportVehicle>& vehicles) {
    HtmlTable table{"Cars (pseudonyms) and the quality of their data",
                    {{"Car"},
                     {"Model used"},
                     {"Method"},
                     {"Trips", true},
                     {"Undated", true},
                     {"km", true},
                     {"On the map", true},
                     {"Rows used", true},
                     {"Passes", true}},
                    {}};
    const auto shown = std::min(vehicles.size(), most_vehicles);
    for (std::size_t i = 0; i < shown; ++i) {
        table.rows.push_back(row_of(vehicles[i], escaped(vehicles[i].name)));
    }
    if (shown < vehicles.size()) {
        const auto first = vehicles.begin() + static_cast<std::ptrdiff_t>(shown);
        table.rows.push_back(row_of(total_of({first, vehicles.end()}),
                                    fmt::format("{} more rows", vehicles.size() - shown)));
    }
    if (vehicles.size() > 1) {
        table.rows.push_back(row_of(total_of(vehicles), "All"));
    }
    return table;
}

constexpr const char* method_text = R"(<section>
<h2>How to read this report</h2>
<p>The International Roughness Index (IRI, ASTM E1926) is the stroke that the suspension of a
reference car gathers at 80 km/h for each length of road: mm/m, which is the same as m/km; 1 mm/m is
63.36 in/mi. A new motorway has about 1, a worn town street 3 to 5, a broken road 10 mm/m. Patches,
joints, manhole covers, rails and speed humps count as roughness.</p>
<p>Every figure stands for one direction of a road: a street driven both ways counts twice. Means and
percentiles are weighted by length. An interval holds the true value with 90 % probability as far as
the method knows its errors; half of their variance is taken to be common to all readings, so that
the mean of many roads stays uncertain.</p>
<h2>Method</h2>
<p>Ordinary cars recorded acceleration, speed and position. A Kalman filter with a model of the car
estimates the road profile that made it shake; the reference car of the IRI is driven over that
profile. Positions are matched to the map. Each pass gives a value for each segment, with a standard
deviation; the passes of all cars are fused to a mean in which one bad pass hardly counts.</p>
<h2>Limits</h2>
<ul>
<li>These are estimates from the response of cars that are known only roughly. They tell rough roads
from smooth ones and show change; they do not replace an inertial profiler (ASTM E950), for example
for acceptance.</li>
<li>A value is of the tracks that the wheels took. Nothing is measured below 18 km/h, and little of
holes that drivers avoid.</li>
<li>Over 20 m, roughness scatters more than over 100 m or a kilometre: extremes of single segments
are partly chance, which is why the worst roads are listed as stretches.</li>
<li>Fast roads read low where the sensors do not see short waves; this is counted in the interval and
not corrected.</li>
</ul>
</section>
)";

} // namespace

std::string data_section(const Report& report) {
    auto html = std::string{"<section>\n<h2>Cars and data</h2>\n"};
    if (report.vehicles.empty()) {
        return html + "<p>No trip was imported yet.</p>\n</section>\n";
    }
    return html + html_of(vehicle_table(report.vehicles)) +
           "<p class=\"small quiet\">Cars stand under pseudonyms. On the map: the share of the "
           "distance that was matched to a road. Rows used: the share of the sensors' rows that "
           "entered an estimate.</p>\n</section>\n";
}

std::string method_section() {
    return method_text;
}

std::string source_section(const Report& report) {
    return fmt::format("<footer>\n<h2>Source of the map</h2>\n<p>Roads: {}.{}</p>\n</footer>\n",
                       escaped(report.network_source),
                       report.attribution.empty() ? "" : " " + escaped(report.attribution) + ".");
}

} // namespace macadam
