#include "mapping/passes/chunk_trace.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace macadam {
namespace {

constexpr std::int32_t step_um = 20;
constexpr unsigned mantissa_bits = 5;
constexpr unsigned steps_in_octave = 1U << mantissa_bits;

/// Decodes to steps. Below two octaves every step has its code; above, each octave has 32.
constexpr unsigned steps_of(RoughnessCode code) {
    const unsigned octave = code >> mantissa_bits;
    const unsigned within = code % steps_in_octave;
    return octave == 0 ? within : (steps_in_octave + within) << (octave - 1);
}

constexpr RoughnessCode largest_code = no_roughness - 1;
constexpr unsigned max_steps = steps_of(largest_code);

/// Returns the code of the largest value not above `steps`.
RoughnessCode code_below(unsigned steps) {
    const auto width = static_cast<unsigned>(std::bit_width(steps));
    const unsigned octave = width > mantissa_bits ? width - mantissa_bits : 0;
    const unsigned within = octave == 0 ? steps : (steps >> (octave - 1)) - steps_in_octave;
    return static_cast<RoughnessCode>(octave * steps_in_octave + within);
}

constexpr std::array<std::int32_t, no_roughness> um_of_codes() {
    std::array<std::int32_t, no_roughness> um{};
    for (std::size_t code = 0; code < um.size(); ++code) {
        um[code] = static_cast<std::int32_t>(steps_of(static_cast<RoughnessCode>(code))) * step_um;
    }
    return um;
}

} // namespace

std::uint32_t segments_per_chunk(double segment_length_m) {
    return static_cast<std::uint32_t>(std::max(1.0, std::round(chunk_length_m / segment_length_m)));
}

ChunkKey chunk_of(const SegmentKey& segment, double segment_length_m) {
    return {segment.way_id, segment.forward, segment.index / segments_per_chunk(segment_length_m)};
}

double station_m(bool forward, double along_way_m) {
    return forward ? along_way_m : -along_way_m;
}

RoughnessCode code_of(double mm_per_m) {
    const double steps = mm_per_m * 1000 / step_um;
    if (!(steps < max_steps)) {
        return largest_code;
    }
    const auto below = code_below(static_cast<unsigned>(steps));
    const double middle = (steps_of(below) + steps_of(below + 1)) / 2.0;
    return static_cast<RoughnessCode>(below + (steps < middle ? 0 : 1));
}

std::optional<std::int32_t> um_of(RoughnessCode roughness) {
    static constexpr auto um = um_of_codes();
    return roughness == no_roughness ? std::nullopt : std::optional{um[roughness]};
}

RoughnessTrace with_cells(RoughnessTrace trace, std::span<const TraceCell> cells) {
    const auto is_known = [](const TraceCell& cell) { return cell.iri != no_roughness; };
    const auto first = std::ranges::find_if(cells, is_known);
    const auto last = std::find_if(cells.rbegin(), cells.rend(), is_known).base();
    trace.first_m += static_cast<std::int32_t>(first - cells.begin());
    bool tracks = false;
    for (auto cell = first; cell < last; ++cell) {
        trace.iri.push_back(cell->iri);
        trace.left.push_back(cell->left);
        tracks = tracks || cell->left != no_roughness;
    }
    if (!tracks) {
        trace.left.clear();
    }
    return trace;
}

} // namespace macadam
