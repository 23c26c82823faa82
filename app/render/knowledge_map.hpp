#pragma once

#include "app/cli/arguments.hpp"
#include "app/render/map_scene.hpp"

#include <cstdint>
#include <optional>

namespace macadam {

/// Quantity by which a map colours how well its roads are known.
enum class Knowledge : std::uint8_t { passes, age, confidence };

inline constexpr Option colour_by_option = one_of(
    "roughness|passes|age|confidence",
    in_group("appearance",
             {"--colour-by",
              "NAME",
              "roughness; passes; age of the newest; or confidence (width of the 90 % interval).",
              "roughness"}));

/// Parses --colour-by; `std::nullopt`: roughness.
/// \throws UsageError  for options that are about roughness alone.
std::optional<Knowledge> parse_colour_by(const Arguments& arguments);

/// Returns the classes of a map, from what is known best. They have no borders of IRI.
const ClassTable& classes_of(Knowledge knowledge);

/// Returns the class of a state; `std::nullopt`: not known, as the age of undated passes.
///
/// \param newest_ms  time of the newest pass in the database
std::optional<std::size_t>
class_in(Knowledge knowledge, const SegmentState& state, std::optional<std::int64_t> newest_ms);

/// Plans a map of passes, their age or the confidence and loads its roads, as load_map does.
///
/// \throws InputError  as load_map.
MapPlan load_knowledge_map(const StoreReader& store, MapRequest request, Knowledge knowledge);

} // namespace macadam
