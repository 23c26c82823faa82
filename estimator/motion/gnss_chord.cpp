#include "estimator/motion/gnss_chord.hpp"

#include "estimator/common/angle.hpp"
#include "estimator/common/geo.hpp"

namespace macadam {

std::vector<GnssChord>
gnss_chords(const TripLog& trip, double min_length_m, double max_duration_s) {
    std::vector<GnssChord> chords;
    const GnssFix* from = nullptr;
    for (const auto& fix : trip.fixes) {
        if (from == nullptr || fix.t_s - from->t_s > max_duration_s) {
            from = &fix;
            continue;
        }
        const double length_m = distance_m(from->at, fix.at);
        if (length_m >= min_length_m) {
            chords.push_back(
                {from->t_s, fix.t_s, length_m, -course_deg(from->at, fix.at) * rad_per_deg});
            from = &fix;
        }
    }
    return chords;
}

} // namespace macadam
