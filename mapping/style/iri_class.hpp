#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace macadam {

inline constexpr double in_per_mi_of_mm_per_m = 63.36; ///< 1 mm/m = 63.36 in/mi, exactly

/// A roughness class: IRI up to and including `to_mm_per_m`, or below it if `open` is set.
struct IriClass {
    std::string_view name;
    double to_mm_per_m; ///< infinity for the last class
    bool open;          ///< whether the bound itself belongs to the next class
};

struct ClassTable {
    std::string_view name;
    std::string_view title;
    std::span<const IriClass> classes; ///< from smooth to rough
};

/// Returns the shipped tables: `fhwa` (the default: 23 CFR 490.313, good < 95 <= fair <= 170 < poor
/// in/mi) and `five` (1.5, 2.5, 3.5, 5.0 mm/m).
std::span<const ClassTable> class_tables();

/// Finds a shipped table by name; nullptr if there is none.
const ClassTable* class_table(std::string_view name);

/// Returns the index of the class of an IRI.
std::size_t class_index(const ClassTable& table, double iri_mm_per_m);

} // namespace macadam
