#include "render/report/html.hpp"
#include "render/report/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace macadam {
namespace {

constexpr const char* reading_text = R"(<section>
<h2>How to read this report</h2>
<p>The International Roughness Index (IRI, ASTM E1926) is the stroke that the suspension of a
reference car gathers at 80 km/h for each length of road: mm/m, which is the same as m/km; 1 mm/m is
63.36 in/mi. A new motorway has about 1, a worn town street 3 to 5, a broken road 10 mm/m. Patches,
joints, manhole covers, rails and speed humps count as roughness.</p>
<p>Every figure stands for one direction of a road: a street driven both ways counts twice. Means and
percentiles are weighted by length. An interval holds the true value with 90 % probability as far as
the method knows its errors; half of their variance is taken to be common to all readings, so that
the mean of many roads stays uncertain.</p>
)";

constexpr const char* smoother_text =
    "Of all roads that could have made the car shake so, the method (smoother) finds the most "
    "probable ones, with a model of the car that has two axles; the reference car of the IRI is "
    "driven over them, and how they differ gives the interval. ";

constexpr const char* kf_text =
    "A Kalman filter (kf) with a model of the car that has one axle estimates the road profile "
    "that made it shake; the reference car of the IRI is driven over that profile. ";

constexpr const char* limits_text = R"(<h2>Limits</h2>
<ul>
<li>These are estimates from the response of cars that are known only roughly. They tell rough roads
from smooth ones and show change; they do not replace an inertial profiler (ASTM E950), for example
for acceptance.</li>
<li>A value is of the tracks that the wheels took. Nothing is measured below 18 km/h, and little of
holes that drivers avoid.</li>
<li>Over 20 m, roughness scatters more than over 100 m or a kilometre: extremes of single segments
are partly chance, which is why the worst roads are listed as stretches.</li>
)";

constexpr const char* smoother_errors =
    "<li>The method (smoother) has errors that go one way and are not corrected: on simulated "
    "cars, where the truth is known, a town's map read high by 2 %, slip roads low by 3 %, and "
    "intervals held about eight truths in ten.</li>\n";

constexpr const char* kf_errors =
    "<li>The method (kf) has errors that go one way and are not corrected. At speed it reads low, "
    "because its filters take off short waves; that is counted in the interval. On simulated cars, "
    "where the truth is known, a town's map read high by about a tenth, slip roads by about a "
    "half, which is more than the interval allows.</li>\n";

bool uses(const Report& report, const std::string& method) {
    return std::ranges::any_of(report.vehicles, [&method](const ReportVehicle& vehicle) {
        return vehicle.method == method;
    });
}

} // namespace

std::string method_section(const Report& report) {
    const bool smoother = uses(report, "smoother");
    const bool kf = uses(report, "kf");
    return fmt::format("{}<h2>Method</h2>\n<p>Ordinary cars recorded acceleration, speed and "
                       "position. {}{}Positions are matched to the map. Each pass gives a value "
                       "for each segment, with a standard deviation; the passes of all cars are "
                       "fused to a mean in which one bad pass hardly counts.</p>\n{}{}{}</ul>\n"
                       "</section>\n",
                       reading_text,
                       smoother ? smoother_text : "",
                       kf ? kf_text : "",
                       limits_text,
                       smoother ? smoother_errors : "",
                       kf ? kf_errors : "");
}

std::string source_section(const Report& report) {
    return fmt::format("<footer>\n<h2>Source of the map</h2>\n<p>Roads: {}.{}</p>\n</footer>\n",
                       escaped(report.network_source),
                       report.attribution.empty() ? "" : " " + escaped(report.attribution) + ".");
}

} // namespace macadam
