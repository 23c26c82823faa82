#pragma once

#include <complex>

namespace macadam {

/// Lightly damped mode between the body and the sensor: a phone's holder, a bracket. The body moves
/// its base.
struct Resonance {
    double hz = 0;      ///< 0: none
    double damping = 0; ///< of critical
};

/// Returns the sensor's motion relative to the body's: (1 + 2 d s) / (1 + 2 d s + s^2).
inline std::complex<double> response(const Resonance& mount, double hz) {
    if (mount.hz <= 0) {
        return 1;
    }
    const std::complex<double> s{0, hz / mount.hz};
    return (1.0 + 2 * mount.damping * s) / (1.0 + 2 * mount.damping * s + s * s);
}

} // namespace macadam
