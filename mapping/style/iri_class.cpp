#include "mapping/style/iri_class.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

namespace macadam {
namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

// 23 CFR 490.313 (b) (1): good below 95, fair 95 to 170, poor above 170 inches per mile.
constexpr std::array fhwa{IriClass{"good", 95 / in_per_mi_of_mm_per_m, true},
                          IriClass{"fair", 170 / in_per_mi_of_mm_per_m, false},
                          IriClass{"poor", no_limit, false}};

// Round values in common use by road administrations; no standard.
constexpr std::array five{IriClass{"very good", 1.5, false},
                          IriClass{"good", 2.5, false},
                          IriClass{"fair", 3.5, false},
                          IriClass{"poor", 5.0, false},
                          IriClass{"very poor", no_limit, false}};

constexpr std::array tables{ClassTable{"fhwa", "FHWA, 23 CFR 490.313", fhwa},
                            ClassTable{"five", "Five classes", five}};

bool is_within(const IriClass& roughness, double iri_mm_per_m) {
    return roughness.open ? iri_mm_per_m < roughness.to_mm_per_m
                          : iri_mm_per_m <= roughness.to_mm_per_m;
}

} // namespace

std::span<const ClassTable> class_tables() {
    return tables;
}

const ClassTable* class_table(std::string_view name) {
    const auto found = std::find_if(
        tables.begin(), tables.end(), [&](const ClassTable& table) { return table.name == name; });
    return found == tables.end() ? nullptr : &*found;
}

std::size_t class_index(const ClassTable& table, double iri_mm_per_m) {
    assert(iri_mm_per_m == iri_mm_per_m);
    const auto found =
        std::find_if(table.classes.begin(), table.classes.end(), [&](const IriClass& roughness) {
            return is_within(roughness, iri_mm_per_m);
        });
    return static_cast<std::size_t>(found - table.classes.begin());
}

} // namespace macadam
