#include "render/report/html.hpp"
#include "render/report/sections.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

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
<li>The method has errors of its own that go one way, and they are not corrected. At speed it reads low,
because its filters take off short waves; that is counted in the interval. Smooth roads and slip roads
read high: where the truth is known, on simulated cars, a whole map by about a tenth, slip roads by about
a half, which is more than the interval allows.</li>
</ul>
</section>
)";

} // namespace

std::string method_section() {
    return method_text;
}

std::string source_section(const Report& report) {
    return fmt::format("<footer>\n<h2>Source of the map</h2>\n<p>Roads: {}.{}</p>\n</footer>\n",
                       escaped(report.network_source),
                       report.attribution.empty() ? "" : " " + escaped(report.attribution) + ".");
}

} // namespace macadam
