#pragma once

#include <span>
#include <vector>

namespace macadam {

/// Amplitude over frequency, smoothed: the root of the one-sided spectral density.
struct AmplitudeSpectrum {
    std::vector<double> hz;        ///< rising, even
    std::vector<double> amplitude; ///< unit of the signal / sqrt(Hz), as many
};

/// Where amplitude spectra are compared.
struct Band {
    double from_hz;
    double to_hz;
    double smoothing_hz; ///< width of the moving average over frequency
};

/// The magnitude of the signal's Fourier transform under a Hann window, averaged over a band of
/// frequencies around each: of the magnitude, not of its square. White noise of density s^2 comes
/// out as 0.89 s, since the mean of a Rayleigh variable is sqrt(pi) / 2 of its root mean square.
///
/// \param signal   n >= 2 samples.
/// \param step_s   from one to the next. The band ends below 1 / (2 step_s).
AmplitudeSpectrum amplitude_spectrum(std::span<const double> signal, double step_s, Band band);

} // namespace macadam
