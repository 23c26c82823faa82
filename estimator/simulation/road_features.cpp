#include "estimator/simulation/road_features.hpp"

#include "estimator/simulation/random.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace macadam {

namespace {

constexpr double patch_edge_m = 0.1;
constexpr double clear_of_ends_m = 1; // lanes join there

/// Adds height_m(at, lateral) to the surface between two stations; `at` counts from from_m.
void add(RoadSurface& surface,
         double from_m,
         double length_m,
         const std::function<double(double, double)>& height_m) {
    const auto last = static_cast<double>(surface.elevation_m.front().size() - 1);
    const double first_at = std::clamp(std::ceil(from_m / surface.step_m), 0.0, last);
    const double last_at = std::clamp(std::floor((from_m + length_m) / surface.step_m), -1.0, last);
    for (std::size_t line = 0; line < surface.elevation_m.size(); ++line) {
        const auto lateral_m = static_cast<double>(surface.line_lateral_m[line]);
        for (double at = first_at; at <= last_at; ++at) {
            surface.elevation_m[line][static_cast<std::size_t>(at)] +=
                static_cast<float>(height_m(at * surface.step_m - from_m, lateral_m));
        }
    }
}

/// Height that varies linearly from track to track, standard deviation 1 at the wheel paths.
struct Lean {
    double middle;
    double per_m;

    double at(double lateral_m) const { return middle + per_m * lateral_m; }
};

Lean draw_lean(Random& random) {
    const double middle = std::sqrt(0.75) * random.normal();
    return {middle, 0.5 * random.normal() / wheel_path_m};
}

void add_slabs(RoadSurface& surface, const RoadRecipe& recipe, Random& random) {
    const double spacing_m = recipe.joint_spacing_m;
    const double size_m = recipe.joint_step_mm / 1000;
    // Only whole slabs are placed: they begin with their step and end level, so the lane's ends
    // stay at 0.
    for (double from_m = random.uniform() * spacing_m; from_m + spacing_m < surface.length_m();
         from_m += spacing_m) {
        const Lean fault = draw_lean(random);
        const Lean curl = draw_lean(random);
        add(surface, from_m, spacing_m, [&](double at_m, double lateral_m) {
            const double t = at_m / spacing_m;
            return size_m *
                   (fault.at(lateral_m) * faulted_slab(t) + curl.at(lateral_m) * curled_slab(t));
        });
    }
}

/// Returns the number of events at a constant rate over this length: the integer part and a draw
/// for the fraction.
int draw_count(double per_km, double length_m, Random& random) {
    return static_cast<int>(std::floor(per_km * length_m / 1000 + random.uniform()));
}

void add_patches(RoadSurface& surface, const RoadRecipe& recipe, Random& random) {
    const double room_m = surface.length_m() - 2 * clear_of_ends_m;
    const int count = draw_count(recipe.patches_per_km, surface.length_m(), random);
    for (int i = 0; i < count; ++i) {
        const double length_m = random.uniform(min_patch_m, max_patch_m);
        const double at_room = random.uniform();
        const double height_m = patch_height_m * random.normal();
        const bool both = random.uniform() < patch_in_both_tracks;
        const double side = random.uniform() < 0.5 ? -1 : 1;
        if (length_m > room_m) {
            continue;
        }
        add(surface,
            clear_of_ends_m + at_room * (room_m - length_m),
            length_m,
            [&](double at_m, double lateral_m) {
                return both || side * lateral_m > 0 ? height_m * patch(at_m, length_m) : 0;
            });
    }
}

void add_pothole(RoadSurface& surface, const Pothole& hole) {
    add(surface, hole.from_m, hole.length_m, [&](double at_m, double lateral_m) {
        return -hole.depth_m * pothole(at_m, hole.length_m) * hole.part_at(lateral_m);
    });
}

} // namespace

double faulted_slab(double t) {
    return 1 - t;
}

double curled_slab(double t) {
    return 4 * t * (1 - t);
}

double patch(double at_m, double length_m) {
    return std::clamp(std::min(at_m, length_m - at_m) / patch_edge_m, 0.0, 1.0);
}

double pothole(double at_m, double length_m) {
    if (at_m <= 0 || at_m >= length_m) {
        return 0;
    }
    return 0.5 - 0.5 * std::cos(2 * std::numbers::pi * at_m / length_m);
}

double Pothole::part_at(double line_lateral_m) const {
    const double across_m = line_lateral_m - lateral_m + pothole_half_width_m;
    return pothole(across_m, 2 * pothole_half_width_m);
}

std::vector<Pothole> potholes_on(double length_m, const RoadRecipe& recipe, std::uint64_t seed) {
    Random random{seed_of({seed, 3})};
    const double room_m = length_m - 2 * clear_of_ends_m;
    const int count = draw_count(recipe.potholes_per_km, length_m, random);
    std::vector<Pothole> holes;
    for (int i = 0; i < count; ++i) {
        const double hole_m = random.uniform(min_pothole_m, max_pothole_m);
        const double at_room = random.uniform();
        const double depth_m = random.uniform(min_pothole_depth_m, max_pothole_depth_m);
        const double path_m = random.uniform() < 0.5 ? -wheel_path_m : wheel_path_m;
        const double off_path_m = random.uniform(-pothole_off_path_m, pothole_off_path_m);
        if (hole_m <= room_m) {
            holes.push_back({clear_of_ends_m + at_room * (room_m - hole_m),
                             hole_m,
                             depth_m,
                             path_m + off_path_m});
        }
    }
    return holes;
}

RoadSurface with_features(RoadSurface surface, const RoadRecipe& recipe, std::uint64_t seed) {
    if (recipe.joint_spacing_m > 0) {
        Random random{seed_of({seed, 1})};
        add_slabs(surface, recipe, random);
    }
    Random patches{seed_of({seed, 2})};
    add_patches(surface, recipe, patches);
    for (const auto& hole : potholes_on(surface.length_m(), recipe, seed)) {
        add_pothole(surface, hole);
    }
    return surface;
}

} // namespace macadam
