#include "render/scene/nice_step.hpp"

#include <cmath>

namespace macadam {

double nice_step(double most, int parts) {
    const double least = most / parts;
    const double power = std::pow(10.0, std::floor(std::log10(least)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= least) {
            return factor * power;
        }
    }
    return 10 * power;
}

} // namespace macadam
