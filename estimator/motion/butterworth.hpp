#pragma once

#include <span>
#include <vector>

namespace macadam {

/// Second-order section: y = b0 x + b1 x[-1] + b2 x[-2] - a1 y[-1] - a2 y[-2].
struct Section {
    double b0, b1, b2, a1, a2;
};

/// Designs Butterworth filters of even order as second-order sections, by the bilinear transform
/// with prewarping: half power exactly at `corner_hz`. 0 < corner_hz < rate_hz / 2.
///
/// Source: A. V. Oppenheim, R. W. Schafer, "Discrete-Time Signal Processing", section 7.2.
std::vector<Section> butterworth_lowpass(int order, double corner_hz, double rate_hz);
std::vector<Section> butterworth_highpass(int order, double corner_hz, double rate_hz);

/// Filters a signal forward and then backward: zero delay, squared gain. Each end is extended by
/// its point reflection over `settle` samples (at most the signal's own length), and the sections
/// start in the steady state of the first value, so that a constant gives its steady response.
///
/// Source: F. Gustafsson, "Determining the initial states in forward-backward filtering", IEEE
/// Transactions on Signal Processing 44 (1996), pp. 988-992, names the problem that this eases.
std::vector<double>
zero_phase(std::span<const Section> sections, std::span<const double> signal, std::size_t settle);

} // namespace macadam
