#include "storage/trips/log/trip_rows.hpp"

#include "estimator/common/error.hpp"
#include "storage/text/text.hpp"
#include "storage/trips/log/trip_meta.hpp"
#include "storage/trips/source/phone_export_files.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace macadam {
namespace {

constexpr std::string_view first_line = "# macadam-trip 1";
constexpr std::string_view end_mark = "# end rows:";

/// Rejects a single file of an export; the user probably means the whole export.
void expect_no_export(const TripSource& source) {
    if (source.member.empty() && marks_export(source.file.filename().string())) {
        throw InputError{
            fmt::format("{}: is one file of a phone export, expected its folder", source.name())};
    }
}

void expect_first_line(TextLines& lines, const TripSource& source) {
    const auto name = source.name();
    const auto line = lines.next();
    if (!line) {
        throw InputError{fmt::format("{}: is empty, expected a trip log ('{}')", name, first_line)};
    }
    if (*line != first_line) {
        expect_no_export(source);
        throw InputError{
            fmt::format("{}: {}, expected '{}': not a Macadam log; for other CSV files see "
                        "'macadam inspect'",
                        lines.where(),
                        in_quotes(*line),
                        first_line)};
    }
}

struct Head {
    TripMeta meta;
    TripHeader header;
    std::string header_line;
    std::string where; ///< position of the header row
};

/// Reads everything up to the header row.
Head read_head(TextLines& lines) {
    std::vector<MetaLine> meta;
    while (const auto line = lines.next()) {
        if (trimmed(*line).empty()) {
            continue;
        }
        if (!line->starts_with('#')) {
            const auto where = lines.where();
            return {parse_meta(meta), parse_trip_header(*line, where), std::string{*line}, where};
        }
        if (const auto colon = line->find(':'); colon != std::string_view::npos) {
            meta.push_back({lines.where(),
                            std::string{trimmed(line->substr(1, colon - 1))},
                            std::string{trimmed(line->substr(colon + 1))}});
        }
    }
    throw InputError{fmt::format("{}: the file ends here, expected a header row", lines.where())};
}

void expect_columns(const Head& head, const TripNeeds& needs) {
    const auto& names = head.header.names;
    const auto missing = missing_columns(needs, [&](const std::string& column) {
        return std::ranges::find(names, column) != names.end();
    });
    if (!missing.empty()) {
        throw InputError{fmt::format("{}: the header has {}, expected also {}",
                                     head.where,
                                     in_quotes(head.header_line, 200),
                                     missing)};
    }
}

} // namespace

TripRows::TripRows(std::unique_ptr<ByteStream> bytes,
                   const TripSource& source,
                   const TripNeeds& needs)
    : lines_{std::move(bytes), source.name()} {
    expect_first_line(lines_, source);
    auto head = read_head(lines_);
    expect_columns(head, needs);
    meta_ = std::move(head.meta);
    header_ = std::move(head.header);
}

std::optional<TripRow> TripRows::next() {
    while (!closed_) {
        const auto line = lines_.next();
        if (!line) {
            return std::nullopt;
        }
        line_ = *line;
        if (line_.starts_with('#')) {
            if (line_.starts_with(end_mark)) {
                expect_end();
            }
        } else if (!trimmed(line_).empty()) {
            ++count_;
            return parse_trip_row(line_, header_);
        }
    }
    return std::nullopt;
}

void TripRows::expect_end() {
    if (trimmed(line_.substr(end_mark.size())) != std::to_string(count_)) {
        throw InputError{fmt::format("{}: {}, expected '{} {}', the number of rows present",
                                     where(),
                                     in_quotes(line_),
                                     end_mark,
                                     count_)};
    }
    while (const auto more = lines_.next()) {
        if (!trimmed(*more).empty()) {
            throw InputError{fmt::format("{}: {}, expected the end of the file after '{}'",
                                         where(),
                                         in_quotes(*more),
                                         end_mark)};
        }
    }
    closed_ = true;
}

void refuse_unclosed(const TripRows& rows) {
    throw InputError{fmt::format("{}: the file ends here after {} rows, expected '{} N' at its end",
                                 rows.where(),
                                 rows.count(),
                                 end_mark)};
}

} // namespace macadam
