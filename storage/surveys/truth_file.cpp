#include "storage/surveys/truth_file.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/byte_stream.hpp"
#include "storage/files/decompress.hpp"
#include "storage/tables/text_lines.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>

namespace macadam {
namespace {

constexpr std::size_t column_count = 9;
using Cells = std::array<std::string_view, column_count>;

Cells cells_of(std::string_view line, const std::string& where) {
    Cells cells;
    std::size_t count = 1;
    for (;;) {
        const auto size = line.find(',');
        cells[count - 1] = trimmed(line.substr(0, size));
        if (size == std::string_view::npos) {
            break;
        }
        line.remove_prefix(size + 1);
        if (++count > column_count) {
            break;
        }
    }
    if (count != column_count) {
        throw InputError{fmt::format("{}: {} {} cells, expected {}",
                                     where,
                                     count > column_count ? "more than" : "only",
                                     count > column_count ? column_count : count,
                                     column_count)};
    }
    return cells;
}

double number(std::string_view cell, const std::string& where, const char* expected) {
    const auto value = parse_number(cell);
    if (!value || !std::isfinite(*value) || *value < 0) {
        throw InputError{fmt::format("{}: {}, expected {}", where, in_quotes(cell), expected)};
    }
    return *value;
}

double iri_or_nan(std::string_view cell, const std::string& where) {
    constexpr auto unknown = std::numeric_limits<double>::quiet_NaN();
    return cell.empty() ? unknown : number(cell, where, "an IRI in mm/m, or empty");
}

SegmentKey key_of(std::string_view cell, const std::string& where) {
    try {
        return parse_segment_key(cell);
    } catch (const InputError&) {
        throw InputError{fmt::format(
            "{}: {}, expected a segment such as '123456+0007'", where, in_quotes(cell))};
    }
}

SegmentTruth truth_of(const Cells& cells, const std::string& where) {
    const SegmentTruth truth{.key = key_of(cells[0], where),
                             .from_m = number(cells[3], where, "metres along the way"),
                             .to_m = number(cells[4], where, "metres along the way"),
                             .iri_left = iri_or_nan(cells[5], where),
                             .iri_right = iri_or_nan(cells[6], where),
                             .mri = number(cells[7], where, "an IRI in mm/m"),
                             .hri = iri_or_nan(cells[8], where)};
    if (truth.to_m <= truth.from_m) {
        throw InputError{fmt::format("{}: to_m is {}, expected more than from_m, {}",
                                     where,
                                     in_quotes(cells[4]),
                                     in_quotes(cells[3]))};
    }
    return truth;
}

} // namespace

std::string truth_rows(std::span<const SegmentTruth> truth) {
    std::string rows;
    for (const auto& segment : truth) {
        fmt::format_to(std::back_inserter(rows),
                       "{},{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f}\n",
                       name_of(segment.key),
                       segment.key.way_id,
                       segment.key.forward ? "forward" : "backward",
                       segment.from_m,
                       segment.to_m,
                       segment.iri_left,
                       segment.iri_right,
                       segment.mri,
                       segment.hri);
    }
    return rows;
}

std::string pothole_truth_rows(std::span<const PotholeTruth> truth) {
    std::string rows;
    for (const auto& hole : truth) {
        fmt::format_to(std::back_inserter(rows),
                       "{},{},{:.3f},{:.3f},{:.1f},{}\n",
                       hole.way_id,
                       hole.forward ? "forward" : "backward",
                       hole.at_m,
                       hole.length_m,
                       1000 * hole.depth_m,
                       hole.is_left ? "left" : "right");
    }
    return rows;
}

std::vector<SegmentTruth> read_truth(const std::filesystem::path& file) {
    TextLines lines{decompressed(file_bytes(file), file.string()), file.string()};
    const auto header = lines.next();
    if (!header || trimmed(*header) != truth_header) {
        throw InputError{fmt::format("{}: {}, expected the header '{}'",
                                     lines.where(),
                                     in_quotes(header.value_or("")),
                                     truth_header)};
    }
    std::vector<SegmentTruth> truth;
    while (const auto line = lines.next()) {
        if (!trimmed(*line).empty()) {
            truth.push_back(truth_of(cells_of(*line, lines.where()), lines.where()));
        }
    }
    std::ranges::sort(truth, {}, &SegmentTruth::key);
    const auto twice = std::ranges::adjacent_find(truth, {}, &SegmentTruth::key);
    if (twice != truth.end()) {
        throw InputError{fmt::format(
            "{}: segment '{}' occurs twice, expected once", file.string(), name_of(twice->key))};
    }
    return truth;
}

} // namespace macadam
