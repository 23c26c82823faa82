#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace macadam {

/// One value of the rectified suspension stroke per step of a profile, mm/m: its mean over any
/// part is the IRI of that part. The golden car runs through the whole without a restart.
///
/// ASTM E1926 at the profile's own step: mean slope over the 250 mm of the tyre's contact (the
/// nearest whole number of steps, at least one), exact state transition, start at the mean slope
/// over the first 11 m.
///
/// \param elevation_m  n evenly spaced elevations of one wheel track, any datum. n >= 2.
/// \param step_m       0 < step_m <= 0.3: a coarser profile has lost what IRI weighs most.
/// \param envelope     false: the profile is already smoothed over the tyre's contact.
/// \returns            n - k values, k = steps in 250 mm (1 without envelope): value i belongs to
///                     [i, i + 1) * step_m.
/// \throws InputError  if a precondition does not hold or an elevation is not finite.
///
/// Source: ASTM E1926; M. W. Sayers, "On the calculation of International Roughness Index from
/// longitudinal road profile", Transportation Research Record 1501 (1995), pp. 1-12.
std::vector<float>
rectified_stroke_mm_per_m(std::span<const double> elevation_m, double step_m, bool envelope = true);

/// Mean of the above: 0 for a smooth plane; about 1 for a new motorway, 10 for a broken track.
/// The first 11 m only set the car in motion, so a stretch much shorter than 50 m says little.
double iri_mm_per_m(std::span<const double> elevation_m, double step_m, bool envelope = true);

/// The same for a profile that comes point by point, in the memory of its first 11 m.
///
///     stroke.push(z); while (const auto value = stroke.next()) ...; stroke.finish(); while ...
class RectifiedStroke {
public:
    /// \throws InputError  if not 0 < step_m <= 0.3.
    explicit RectifiedStroke(double step_m, bool envelope = true);

    /// \throws InputError  if the elevation is not finite.
    void push(double elevation_m);

    /// No more points. \throws InputError  if there were fewer than 2.
    void finish();

    /// The next value in mm/m, in the order of the profile; nothing until more points are there.
    std::optional<double> next();

private:
    void start();

    double step_m_;
    std::size_t patch_;
    std::array<double, 16> transition_; ///< column by column
    std::array<double, 4> response_;
    std::array<double, 4> state_{};
    std::vector<double> elevation_m_; ///< from the first that is still needed on
    std::size_t first_ = 0;
    std::size_t pushed_ = 0;
    bool started_ = false;
};

/// Whole steps that the tyre's 250 mm are taken for, at least 1. A tie goes up, as in the standard,
/// whatever the rounding of the step.
std::size_t envelope_steps(double step_m);

/// What stands for the stroke between two points of an uneven profile.
enum class StrokeValue : std::uint8_t {
    integral, ///< its mean, with its zero crossings
    at_end,   ///< its value at the end, as the standard has it on even steps
};

/// The profile between two stations, on uneven stations: the golden car over the straight lines
/// between them, solved exactly, after a continuous 250 mm moving average.
///
/// \param station_m  rising, as many as elevation_m; steps of 0.3 m in the mean and 0.6 m each at
///                   most.
/// \param edges_m    m + 1 rising borders of segments within the stations.
/// \param value      at_end makes sense without an envelope: the program published for uneven
///                   stations (F. Sroubek, M. Sorel, J. Zak 2021) does so.
/// \returns          m means of the rectified stroke.
std::vector<double> exact_iri_mm_per_m(std::span<const double> station_m,
                                       std::span<const double> elevation_m,
                                       std::span<const double> edges_m,
                                       bool envelope = true,
                                       StrokeValue value = StrokeValue::integral);

/// The same for a profile that comes point by point, in the memory of its first 11 m and its edges.
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

    /// No more points.
    /// \throws InputError  if there were fewer than 2, if their mean step is over 0.3 m, or if the
    ///                     edges do not rise from the first station to the last at most.
    void finish();

    /// The mean over the next segment; nothing until more points are there.
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
