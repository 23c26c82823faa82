#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace macadam::testing {

struct IntervalCount {
    std::size_t inside = 0;            ///< runs whose truth is inside the 95 % interval
    std::size_t inside_given_mass = 0; ///< the same of the ratio to the mass
    double sd_sum = 0;
    double sd_given_mass_sum = 0;
};

/// Relative errors of the mean HRI of one road each.
struct IriErrors {
    std::vector<double> each;

    double rms() const;
    std::size_t within(double limit) const;
};

struct RunsReport {
    std::size_t runs;
    std::map<std::string, IntervalCount> parameters;
    IriErrors found, spectrum; ///< by the cars of the fits
    IriErrors file, truth;     ///< by the file's car, and by the true one: the smoother's own error
    IriErrors found_to_truth;  ///< of the identified car relative to the true one
};

/// Identifies cars by the likelihood fit and by the paper's, and lets the smoother read another
/// road with each.
///
/// A run has a car drawn from the uncertainty of its file, with friction, one-sided dampers,
/// out-of-round tyres and a weight that tilts; 1.2 km of measured road (0.1 m, noise 0.1 mm), on
/// which it wanders by a decimetre; an odometer 0.3 % and some decimetres off; and the noise of
/// usual sensors at 50 Hz.
RunsReport report_of_runs(std::size_t count);

void print(const RunsReport& report);

} // namespace macadam::testing
