#include "storage/trips/detection/detected_mapping.hpp"

#include "estimator/common/utf8.hpp"
#include "storage/tables/csv_cells.hpp"
#include "storage/trips/mappings/built_in_mappings.hpp"
#include "storage/trips/mappings/column_mapping_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

namespace macadam {
namespace {

/// Replaces what a TOML file may not hold, or what would steer a terminal, letter by letter.
std::string printable_letters(std::string_view text, char instead) {
    std::string safe;
    while (!text.empty()) {
        const auto length = utf8_length(text);
        const auto letter = text.substr(0, std::max<std::size_t>(1, length));
        const auto code = utf8_letter(letter);
        const bool is_printable =
            length == 1 ? code >= ' ' && code <= '~' : length > 1 && code >= 0xA0;
        if (is_printable) {
            safe += letter;
        } else {
            safe += instead;
        }
        text.remove_prefix(letter.size());
    }
    return safe;
}

/// Text that a TOML remark may hold.
std::string remark(std::string_view text) {
    return printable_letters(text, '?');
}

std::string toml_text(std::string_view text) {
    std::string quoted = "\"";
    for (const char letter : text) {
        if (letter == '"' || letter == '\\') {
            quoted += '\\';
        }
        quoted += letter;
    }
    return quoted + '"';
}

/// Pattern for the name of a column, with '*' for letters that cannot be shown; "" if it is no name
/// of this column alone.
std::string pattern_of(const DetectedLog& log, std::size_t column) {
    const auto& names = log.dialect.names;
    constexpr std::size_t max_length = 200; // comparing long names with several '*' takes long
    constexpr std::ptrdiff_t max_stars = 2;
    const bool are_short = std::ranges::all_of(
        names, [](const std::string& name) { return name.size() <= max_length; });
    if (!log.dialect.has_header || column > names.size() || !are_short) {
        return "";
    }
    const auto pattern = printable_letters(names[column - 1], '*');
    if (std::ranges::count(pattern, '*') > max_stars) {
        return "";
    }
    const auto first =
        std::ranges::find_if(names, [&](const auto& name) { return fits(name, pattern); });
    const bool is_own = first - names.begin() + 1 == static_cast<std::ptrdiff_t>(column);
    const bool says_something = pattern.find_first_not_of("* ") != std::string::npos;
    return is_own && says_something ? pattern : "";
}

std::string column_text(const DetectedLog& log, std::size_t column) {
    const auto pattern = pattern_of(log, column);
    return pattern.empty() ? fmt::format("{}", column) : toml_text(pattern);
}

std::string separator_word(char separator) {
    return separator == '\t' ? "tab" : separator == ' ' ? "blank" : std::string{separator};
}

std::string layout_toml(const DetectedLog& log, const std::string& files) {
    const auto& dialect = log.dialect;
    auto toml = files == "*.csv" ? "" : fmt::format("files = {}\n", toml_text(files));
    if (dialect.separator != ',') {
        toml += fmt::format("separator = {}\n", toml_text(separator_word(dialect.separator)));
    }
    if (dialect.decimal != '.') {
        toml += "decimal = \",\"\n";
    }
    if (log.encoding != TextEncoding::utf8) {
        toml += fmt::format("encoding = \"{}\"\n",
                            log.encoding == TextEncoding::latin1 ? "latin-1" : "utf-16le");
    }
    if (!dialect.comment.empty()) {
        toml += fmt::format("comment = {}\n", toml_text(dialect.comment));
    }
    if (!dialect.has_header) {
        toml += "header = false\n";
        toml += dialect.first_row > 0 ? fmt::format("skip_lines = {}\n", dialect.first_row) : "";
    } else if (dialect.header_line > 0) {
        toml += dialect.header_begins.empty()
                    ? fmt::format("skip_lines = {}\n", dialect.header_line)
                    : fmt::format("header_begins = {}\n", toml_text(dialect.header_begins));
    }
    if (dialect.has_header && dialect.rows_under_header > 0) {
        toml += fmt::format("rows_under_header = {}\n", dialect.rows_under_header);
    }
    std::vector<std::string> empty;
    std::ranges::transform(log.empty, std::back_inserter(empty), toml_text);
    return toml + (empty.empty() ? "" : fmt::format("empty = [{}]\n", fmt::join(empty, ", ")));
}

std::string mounting_toml(const DetectedLog& log) {
    if (log.gravity.empty()) {
        return "";
    }
    if (!log.has_gravity) {
        return "gravity = \"removed\"\n";
    }
    const bool has_all = log.channel("acc_x_mps2") != nullptr &&
                         log.channel("acc_y_mps2") != nullptr &&
                         log.channel("acc_z_mps2") != nullptr;
    return log.of_device && has_all
               ? "frame = \"sensor\"\nmount = \"auto\"   # found from gravity and braking\n"
               : "";
}

std::string confidence_word(Confidence confidence) {
    return confidence == Confidence::sure ? "sure" : "likely, check";
}

std::string time_toml(const DetectedLog& log, Confidence least, std::string_view table = "time") {
    if (!log.time || !is_at_least(log.time->confidence, least)) {
        return fmt::format("\n[{}]\n", table) +
               "# column = \"?\"   # not found: a column that increases from row to row\n"
               "# format = \"s\"\n";
    }
    const auto& time = *log.time;
    auto toml = fmt::format(
        "\n[{}]   # {}: {}\n", table, confidence_word(time.confidence), remark(time.reason));
    if (time.columns.size() == 1) {
        toml += fmt::format("column = {}\n", column_text(log, time.columns.front()));
    } else {
        const bool named = std::ranges::none_of(
            time.columns, [&](std::size_t column) { return pattern_of(log, column).empty(); });
        std::vector<std::string> columns;
        for (const auto column : time.columns) {
            columns.push_back(named ? column_text(log, column) : fmt::format("{}", column));
        }
        toml += fmt::format("columns = [{}]\n", fmt::join(columns, ", "));
    }
    toml += fmt::format("format = {}\n", toml_text(time.format));
    toml += time.scale == 1 ? "" : fmt::format("scale = {}\n", time.scale);
    toml += time.since_1970 ? "epoch = \"unix\"\n" : "";
    const bool is_local = !time.has_date && time.format.size() > 8;
    return toml + (is_local ? "# utc_offset_h = 1   # local time minus UTC, for a date\n" : "");
}

std::string channel_toml(const DetectedLog& log, const DetectedChannel& channel) {
    auto toml =
        fmt::format("{} = {{column = {}", channel.channel, column_text(log, channel.column));
    toml += channel.unit.empty() ? "" : fmt::format(", unit = {}", toml_text(channel.unit));
    toml += channel.scale == 1 ? "" : fmt::format(", scale = {}", channel.scale);
    toml += channel.sign == 1 ? "" : ", sign = -1";
    toml += channel.minus_one_is_none ? ", invalid = [-1]" : "";
    if (channel.hemisphere) {
        toml += fmt::format(", hemisphere = {}", column_text(log, *channel.hemisphere));
    }
    return toml + fmt::format("}}   # {}: {}\n",
                              confidence_word(channel.confidence),
                              remark(channel.reason));
}

struct WantedColumn {
    std::string_view channel;
    std::string_view instead; ///< serves as well; "": none
    std::string_view line;
};

constexpr WantedColumn wanted[] = {
    {"acc_z_mps2",
     "",
     "acc_z_mps2 = {column = \"?\", unit = \"m/s2\"}   # not found: vertical acceleration"},
    {"gnss_speed_mps",
     "speed_mps",
     "gnss_speed_mps = {column = \"?\", unit = \"km/h\"}   # not found: speed of the receiver, or "
     "of the "
     "wheels as speed_mps"},
    {"lat_deg", "", "lat_deg = {column = \"?\"}   # not found: latitude"},
    {"lon_deg", "", "lon_deg = {column = \"?\"}   # not found: longitude"},
};

std::string found_channels_toml(const DetectedLog& log, Confidence least) {
    std::string toml;
    for (const auto& channel : log.channels) {
        const bool is_usable = log.has(channel.channel, least);
        toml += is_usable ? channel_toml(log, channel) : "";
        if (!is_usable && least == Confidence::likely) { // without a unit
            toml += fmt::format("# {} = {{column = {}, unit = \"?\"}}   # {}\n",
                                channel.channel,
                                column_text(log, channel.column),
                                remark(channel.reason));
        }
    }
    return toml;
}

std::string channels_toml(const DetectedLog& log, Confidence least) {
    auto toml = "\n[channels]\n" + found_channels_toml(log, least);
    for (const auto& [channel, instead, line] : wanted) {
        if (log.channel(channel) == nullptr &&
            (instead.empty() || log.channel(instead) == nullptr)) {
            toml += fmt::format("# {}\n", line);
        }
    }
    return toml;
}

/// Names of the columns that were not taken, for the reader of the mapping.
std::string other_columns(const DetectedLog& log) {
    constexpr std::size_t max_shown = 60;
    std::vector<std::string> others;
    for (std::size_t i = 0; i < log.names.size(); ++i) {
        const bool is_channel = std::ranges::any_of(log.channels, [&](const auto& c) {
            return c.column == i + 1 || c.hemisphere == i + 1;
        });
        const bool is_time =
            log.time && std::ranges::find(log.time->columns, i + 1) != log.time->columns.end();
        if (!is_channel && !is_time && !log.names[i].empty()) {
            others.push_back(remark(std::string_view{log.names[i]}.substr(0, max_shown)));
        }
    }
    const auto more = others.size() > max_shown ? others.size() - max_shown : 0;
    others.resize(others.size() - more);
    return others.empty() ? ""
                          : fmt::format("\n# not used: {}{}\n",
                                        fmt::join(others, "; "),
                                        more > 0 ? fmt::format("; and {} more", more) : "");
}

} // namespace

std::string mapping_toml(const DetectedLog& log, Confidence least, const std::string& files) {
    if (!log.built_in.empty()) {
        const auto built_in =
            std::ranges::find(built_in_mappings(), log.built_in, &BuiltInMapping::name);
        return std::string{built_in->toml};
    }
    return layout_toml(log, files) + mounting_toml(log) + time_toml(log, least) +
           channels_toml(log, least) + other_columns(log);
}

std::string mapping_toml(const NamedLog& first, const NamedLog& second) {
    constexpr auto likely = Confidence::likely;
    return layout_toml(first.log, first.files) + mounting_toml(first.log) +
           time_toml(first.log, likely) + "\n[channels]\n" +
           found_channels_toml(first.log, likely) + other_columns(first.log) + "\n[[file]]\n" +
           layout_toml(second.log, second.files) + time_toml(second.log, likely, "file.time") +
           "\n[file.channels]\n" + found_channels_toml(second.log, likely) +
           other_columns(second.log);
}

std::shared_ptr<const TripMapping> sure_mapping(const DetectedLog& log, bool has_positions) {
    const auto serves = [&](const TripNeeds& needs) {
        return missing_measurements(log, needs, Confidence::sure).empty();
    };
    const bool serves_beside_positions =
        has_positions && serves(needs_beside_positions(needs_of_trace()));
    if (!serves(needs_of_match()) && !serves(needs_of_trace()) && !serves_beside_positions) {
        return nullptr;
    }
    auto mapping = parse_mapping(mapping_toml(log, Confidence::sure, "*"), "detected mapping");
    mapping.meta.other[detected_key] = words_of(log);
    return std::make_shared<const TripMapping>(std::move(mapping));
}

std::shared_ptr<const TripMapping> mapping_of_found(const std::optional<DetectedLog>& log,
                                                    bool has_positions) {
    const bool is_result = log && std::ranges::find(log->names, "iri") != log->names.end();
    return log && !is_result ? sure_mapping(*log, has_positions) : nullptr;
}

} // namespace macadam
