#pragma once

#include "mapping/iri_class.hpp"
#include "mapping/network_summary.hpp"

#include <cstdint>
#include <span>
#include <string>

namespace macadam {

// Figures of the report as inline SVG, in the page's own ink and the colours of the classes.

/// A little square of a class's colour. Says nothing to those who listen.
std::string swatch_svg(std::uint32_t rgb);

/// The classes of a road beside each other, as wide as they are long. Nothing covered: empty.
std::string share_bar_svg(const RoadSummary& roads,
                          const ClassTable& classes,
                          std::span<const std::uint32_t> colours);

/// Kilometres of road by roughness, with the mean.
std::string histogram_svg(const IriHistogram& histogram,
                          const RoadMean& mean,
                          const ClassTable& classes,
                          std::span<const std::uint32_t> colours);

} // namespace macadam
