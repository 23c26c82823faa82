#include "storage/trip_reader.hpp"

#include "estimator/common/error.hpp"
#include "storage/byte_stream.hpp"
#include "storage/foreign/foreign_trip.hpp"
#include "storage/foreign/phone_export.hpp"
#include "storage/rawlog_reader.hpp"
#include "storage/text.hpp"
#include "storage/text_lines.hpp"
#include "storage/trip_meta.hpp"
#include "storage/trip_row.hpp"
#include "storage/trip_streams.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <system_error>
#include <utility>

namespace macadam {

namespace {

constexpr std::string_view first_line = "# macadam-trip 1";
constexpr std::string_view end_mark = "# end rows:";

/// \throws InputError  what is wrong with an archive that was found in a folder and could not be
///                     searched, rather than that it is no log.
std::unique_ptr<ByteStream> open(const TripSource& source) {
    if (source.member.empty()) {
        if (source.file.extension() == ".zip") {
            members_of(source.file);
        }
        return decompressed(file_bytes(source.file), source.name());
    }
    return decompressed(bounded(member_bytes(source.file, source.member), source.name()),
                        source.name());
}

/// Whoever names one file of an export means the export.
void expect_no_export(const TripSource& source) {
    if (source.member.empty() && marks_export(source.file.filename().string())) {
        throw InputError{
            fmt::format("{}: is one file of a phone's export, expected the folder in which it lies",
                        source.name())};
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
            fmt::format("{}: {}, expected '{}'", lines.where(), in_quotes(*line), first_line)};
    }
}

struct Head {
    TripMeta meta;
    TripHeader header;
    std::string header_line;
    std::string where; ///< the header row is
};

/// Everything up to the header row.
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

std::string joined(const std::vector<std::string>& words, std::string_view between) {
    std::string text;
    for (const auto& word : words) {
        text += (text.empty() ? "" : std::string{between}) + word;
    }
    return text;
}

void expect_columns(const Head& head, const TripNeeds& needs) {
    const auto& names = head.header.names;
    std::vector<std::string> missing;
    for (const auto& group : needs.columns) {
        if (std::find_first_of(group.begin(), group.end(), names.begin(), names.end()) ==
            group.end()) {
            missing.push_back(joined(group, " or "));
        }
    }
    if (!missing.empty()) {
        throw InputError{fmt::format("{}: the header has {}, expected also {}",
                                     head.where,
                                     in_quotes(head.header_line, 200),
                                     joined(missing, " and "))};
    }
}

void expect_end(TextLines& lines, std::string_view line, std::size_t rows) {
    if (trimmed(line.substr(end_mark.size())) != std::to_string(rows)) {
        throw InputError{fmt::format("{}: {}, expected '{} {}', as many as there are",
                                     lines.where(),
                                     in_quotes(line),
                                     end_mark,
                                     rows)};
    }
    while (const auto more = lines.next()) {
        if (!trimmed(*more).empty()) {
            throw InputError{fmt::format(
                "{}: {}, expected nothing after '{}'", lines.where(), in_quotes(*more), end_mark)};
        }
    }
}

std::size_t bytes_on_disk(const TripSource& source) {
    std::error_code unknown_size;
    const auto size = std::filesystem::file_size(source.file, unknown_size);
    return unknown_size ? 0 : static_cast<std::size_t>(size);
}

/// Tells now and then how far the file was read, and stops when that is wished.
class Pace {
public:
    Pace(const TripSource& source, const Progress& progress)
        : name_{source.name()}, progress_{progress}, whole_{bytes_on_disk(source)} {}

    void step(const TextLines& lines) {
        constexpr std::size_t rows_between = 1 << 16;
        if (++rows_ % rows_between != 0) {
            return;
        }
        progress_(static_cast<std::size_t>(lines.consumed()), whole_);
        if (progress_.stop.stop_requested()) {
            throw InputError{fmt::format("{}: the reading was stopped", name_)};
        }
    }

private:
    std::string name_;
    const Progress& progress_;
    std::size_t whole_;
    std::size_t rows_ = 0;
};

TripLog read_rows(TextLines& lines, const TripHeader& header, const TripNeeds& needs, Pace pace) {
    TripStreams streams{needs, header};
    while (const auto line = lines.next()) {
        pace.step(lines);
        if (line->starts_with('#')) {
            if (line->starts_with(end_mark)) {
                expect_end(lines, *line, streams.rows());
                return streams.take();
            }
        } else if (!trimmed(*line).empty()) {
            streams.add(parse_trip_row(*line, header));
        }
    }
    throw InputError{fmt::format("{}: the file ends here after {} rows, expected '{} N' at its end",
                                 lines.where(),
                                 streams.rows(),
                                 end_mark)};
}

} // namespace

TripNeeds needs_of_match() {
    return {.speed = true, .fixes = true, .columns = {{"t_s"}, {"lat_deg"}, {"lon_deg"}}};
}

TripNeeds needs_of_trace() {
    return {.acc = true,
            .gyro = true,
            .speed = true,
            .fixes = true,
            .columns = {{"t_s"},
                        {"acc_z_mps2", "acc_y_mps2"},
                        {"speed_mps",
                         "gnss_speed_mps",
                         "wheel_fl_mps",
                         "wheel_fr_mps",
                         "wheel_rl_mps",
                         "wheel_rr_mps"}}};
}

TripNeeds needs_of_import() {
    auto needs = needs_of_trace();
    needs.columns.push_back({"lat_deg"});
    needs.columns.push_back({"lon_deg"});
    return needs;
}

std::string TripSource::name() const {
    return member.empty() ? file.string() : file.string() + "/" + member;
}

std::string content_sha256(const TripSource& source) {
    if (is_foreign(source)) {
        return foreign_sha256(source);
    }
    constexpr std::size_t block = 1 << 20;
    const auto bytes = open(source);
    std::vector<char> buffer(block);
    Sha256 sha256;
    while (const auto count = bytes->read(buffer)) {
        sha256.add({buffer.data(), count});
    }
    return sha256.hex();
}

TripLog read_trip(const TripSource& source, const TripNeeds& needs, const Progress& progress) {
    if (is_foreign(source)) {
        return read_foreign_trip(source, needs, progress);
    }
    if (source.name().ends_with(rawlog_suffix)) {
        return read_rawlog({open(source), source.name(), bytes_on_disk(source)}, needs, progress);
    }
    TextLines lines{open(source), source.name()};
    expect_first_line(lines, source);
    const auto head = read_head(lines);
    expect_columns(head, needs);
    auto trip = read_rows(lines, head.header, needs, {source, progress});
    trip.meta = head.meta;
    trip.sha256 = lines.sha256();
    return trip;
}

} // namespace macadam
