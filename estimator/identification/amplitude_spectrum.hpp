#pragma once

#include <span>
#include <vector>

namespace macadam {

/// Smoothed amplitude over frequency: the square root of the one-sided spectral density.
struct AmplitudeSpectrum {
    std::vector<double> hz;        ///< increasing, evenly spaced
    std::vector<double> amplitude; ///< unit of the signal / sqrt(Hz), same size
};

/// Frequency band in which amplitude spectra are compared.
struct Band {
    double from_hz;
    double to_hz;
    double smoothing_hz; ///< width of the moving average over frequency
};

/// Computes the magnitude of the signal's Fourier transform under a Hann window, averaged over a
/// band around each frequency. The magnitude is averaged, not its square: white noise of density
/// s^2 gives 0.89 s, since the mean of a Rayleigh variable is sqrt(pi) / 2 of its root mean square.
///
/// \param signal   n >= 2 samples.
/// \param step_s   sampling interval. The band ends below 1 / (2 step_s).
AmplitudeSpectrum amplitude_spectrum(std::span<const double> signal, double step_s, Band band);

} // namespace macadam
