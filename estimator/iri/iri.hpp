#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace macadam {

/// Returns the rectified suspension stroke per step of a profile, mm/m; its mean over any interval
/// is the IRI of that interval. The golden car runs through the whole profile without a restart.
///
/// ASTM E1926 at the profile's own step: mean slope over the 250 mm of the tyre's contact (the
/// nearest whole number of steps, at least one), exact state transition, start at the mean slope
/// over the first 11 m.
///
/// \param elevation_m  n evenly spaced elevations of one wheel track, any datum. n >= 2.
/// \param step_m       0 < step_m <= 0.3: a coarser profile lacks the wavelengths that dominate
///                     IRI.
/// \param envelope     false: the profile is already smoothed over the tyre's contact.
/// \returns            n - k values, k = steps in 250 mm (1 without envelope): value i belongs to
///                     [i, i + 1) * step_m.
/// \throws InputError  if a precondition does not hold or an elevation is not finite.
///
/// Source: ASTM E1926; M. W. Sayers, "On the calculation of International Roughness Index from
/// longitudinal road profile", Transportation Research Record 1501 (1995), pp. 1-12.
std::vector<float>
rectified_stroke_mm_per_m(std::span<const double> elevation_m, double step_m, bool envelope = true);

/// Returns the mean of rectified_stroke_mm_per_m: 0 for a smooth plane; about 1 for a new motorway,
/// 10 for a broken track. The first 11 m only set the car in motion, so the result means little for
/// a profile much shorter than 50 m.
double iri_mm_per_m(std::span<const double> elevation_m, double step_m, bool envelope = true);

/// Returns the signed suspension stroke whose absolute values are rectified_stroke_mm_per_m: the
/// profile as filtered by IRI, for the comparison of waveforms. Arguments and errors are the same.
std::vector<double> suspension_stroke_mm_per_m(std::span<const double> elevation_m,
                                               double step_m,
                                               bool envelope = true);

/// Incremental version of rectified_stroke_mm_per_m for a profile that arrives point by point; it
/// stores the first 11 m.
///
///     stroke.push(z); while (const auto value = stroke.next()) ...; stroke.finish(); while ...
class RectifiedStroke {
public:
    /// \throws InputError  if not 0 < step_m <= 0.3.
    explicit RectifiedStroke(double step_m, bool envelope = true);

    /// \throws InputError  if the elevation is not finite.
    void push(double elevation_m);

    /// Ends the profile. \throws InputError  if there were fewer than 2 points.
    void finish();

    /// Returns the next value in mm/m, in profile order; `std::nullopt` until more points arrive.
    std::optional<double> next();

    /// Returns the next value with its sign: positive while the suspension is being compressed.
    std::optional<double> next_signed();

private:
    void start();

    double step_m_;
    std::size_t patch_;
    std::array<double, 16> transition_; ///< column-major
    std::array<double, 4> response_;
    std::array<double, 4> state_{};
    std::vector<double> elevation_m_; ///< from the first point still needed
    std::size_t first_ = 0;
    std::size_t pushed_ = 0;
    bool started_ = false;
};

/// Returns the number of whole steps, at least 1, that approximates the tyre's 250 mm. A tie is
/// rounded up, as in the standard, regardless of the rounding of the step.
std::size_t envelope_steps(double step_m);

/// Representative value of the stroke between two points of an uneven profile.
enum class StrokeValue : std::uint8_t {
    integral, ///< its mean, with its zero crossings
    at_end,   ///< its value at the end, as in the standard for even steps
};

/// Computes IRI on uneven stations, with straight lines between them: the golden car is solved
/// exactly after a continuous 250 mm moving average.
///
/// \param station_m  increasing, same size as elevation_m; steps of at most 0.3 m on average and
///                   0.6 m each.
/// \param edges_m    m + 1 increasing edges of segments within the stations.
/// \param value      at_end makes sense without an envelope: the program published for uneven
///                   stations (F. Sroubek, M. Sorel, J. Zak 2021) does so.
/// \returns          m means of the rectified stroke.
std::vector<double> exact_iri_mm_per_m(std::span<const double> station_m,
                                       std::span<const double> elevation_m,
                                       std::span<const double> edges_m,
                                       bool envelope = true,
                                       StrokeValue value = StrokeValue::integral);

/// Incremental version of exact_iri_mm_per_m for a profile that arrives point by point; it stores
/// the first 11 m and the edges.
class ExactIri {
public:
    explicit ExactIri(std::vector<double> edges_m,
                      bool envelope = true,
                      StrokeValue value = StrokeValue::integral);
    ExactIri(ExactIri&&) noexcept;
    ExactIri& operator=(ExactIri&&) noexcept;
    ~ExactIri();

    /// \throws InputError  for a number that is not finite or a step that is not 0 < step <= 0.6 m.
    void push(double station_m, double elevation_m);

    /// Ends the profile.
    /// \throws InputError  if there were fewer than 2 points, if their mean step is over 0.3 m, or
    ///                     if the edges do not increase from the first station to at most the last.
    void finish();

    /// Returns the mean over the next segment; `std::nullopt` until more points arrive.
    std::optional<double> next();

private:
    class Drive;
    std::unique_ptr<Drive> drive_;
};

inline constexpr double golden_speed_mps = 80 / 3.6; ///< ASTM E1926
inline constexpr double contact_patch_m = 0.25;      ///< ASTM E1926: base of the moving average
inline constexpr double start_up_m = 11;             ///< ASTM E1926: 0.5 s at 80 km/h
inline constexpr double coarsest_step_m = 0.3;

} // namespace macadam
