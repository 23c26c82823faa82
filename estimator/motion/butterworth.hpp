#pragma once

#include <span>
#include <vector>

namespace macadam {

/// One second-order section: y = b0 x + b1 x[-1] + b2 x[-2] - a1 y[-1] - a2 y[-2].
struct Section {
    double b0, b1, b2, a1, a2;
};

/// Butterworth filters of even order as second-order sections, by the bilinear transform with the
/// corner prewarped: half power exactly at `corner_hz`. 0 < corner_hz < rate_hz / 2.
///
/// Source: A. V. Oppenheim, R. W. Schafer, "Discrete-Time Signal Processing", section 7.2.
std::vector<Section> butterworth_lowpass(int order, double corner_hz, double rate_hz);
std::vector<Section> butterworth_highpass(int order, double corner_hz, double rate_hz);

/// The signal filtered forward and then backward: no delay, the gain squared. Each end is continued
/// by its point reflection over `settle` samples (at most the signal's own length), and the
/// sections start in the steady state of the first value, so that a constant comes out as its
/// steady response.
///
/// Source: F. Gustafsson, "Determining the initial states in forward-backward filtering", IEEE
/// Transactions on Signal Processing 44 (1996), pp. 988-992, names the problem that this eases.
std::vector<double>
zero_phase(std::span<const Section> sections, std::span<const double> signal, std::size_t settle);

} // namespace macadam
