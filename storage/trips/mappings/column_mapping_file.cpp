#include "storage/trips/mappings/column_mapping_file.hpp"

#include "storage/tables/toml.hpp"
#include "storage/text/text.hpp"
#include "storage/trips/log/trip_meta.hpp"
#include "storage/trips/mappings/built_in_mappings.hpp"
#include "storage/trips/mappings/column_units.hpp"
#include "storage/trips/mappings/mapping_keys.hpp"
#include "storage/trips/mappings/signal_mapping.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>

namespace macadam {

namespace {

// Allowed keys by table.
constexpr std::array<std::string_view, 16> table_keys{"files",
                                                      "separator",
                                                      "decimal",
                                                      "encoding",
                                                      "skip_lines",
                                                      "comment",
                                                      "header",
                                                      "header_begins",
                                                      "rows_under_header",
                                                      "empty",
                                                      "axes",
                                                      "time",
                                                      "can",
                                                      "mdf",
                                                      "hdf5",
                                                      "channels"};
constexpr std::array<std::string_view, 8> time_keys{
    "column", "columns", "format", "scale", "epoch", "utc_offset_h", "fraction_s", "shift_s"};
constexpr std::array<std::string_view, 7> channel_keys{
    "column", "unit", "scale", "offset", "sign", "invalid", "hemisphere"};
constexpr std::int64_t max_skipped = 1000000;

ColumnName column_of(const TomlTable& table, std::string_view key = "column") {
    if (!table.has(key)) {
        table.miss(key);
    }
    if (table.is_text(key)) {
        return {.pattern = table.text(key)};
    }
    return {.pattern = "", .number = static_cast<std::size_t>(table.integer(key, 1, max_columns))};
}

/// Column with the hemispheres of a latitude or longitude; `std::nullopt` if none is stated.
std::optional<ColumnName> hemisphere_of(const TomlTable& table, TripColumn channel) {
    if (!table.has("hemisphere")) {
        return std::nullopt;
    }
    if (channel != TripColumn::lat && channel != TripColumn::lon) {
        table.refuse("hemisphere", "no such key except for lat_deg and lon_deg");
    }
    return column_of(table, "hemisphere");
}

ChannelMapping channel_of(const TomlTable& channels, const std::string& name) {
    const auto channel = known_channel(channels, name, "column");
    const auto table = channels.table(name);
    table->expect_only(channel_keys);
    return {.channel = channel,
            .column = column_of(*table),
            .scale = scale_of(*table, channel),
            .offset = table->maybe_number("offset").value_or(0),
            .invalid = table->has("invalid") ? table->numbers("invalid") : std::vector<double>{},
            .degrees_minutes = table->maybe_text("unit") == degrees_minutes,
            .hemisphere = hemisphere_of(*table, channel)};
}

struct TimeWord {
    TimeFormat format;
    double unit_s;
};

/// Factor of a count: 0.1 and the format "ms" are steps of 0.1 ms.
double time_scale_of(const TomlTable& table, TimeFormat format) {
    if (table.has("scale") && format != TimeFormat::number) {
        table.refuse("scale", "no such key except for the formats s, ms, us and ns");
    }
    return table.maybe_number("scale", positive_number).value_or(1);
}

TimeMapping time_of(const TomlTable& table) {
    static constexpr std::pair<std::string_view, TimeWord> formats[] = {
        {"s", {TimeFormat::number, 1}},
        {"ms", {TimeFormat::number, 1e-3}},
        {"us", {TimeFormat::number, 1e-6}},
        {"ns", {TimeFormat::number, 1e-9}},
        {"hh:mm:ss", {TimeFormat::clock, 1}},
        {"hhmmss", {TimeFormat::compact_clock, 1}},
        {"dd/mm/yyyy hh:mm:ss", {TimeFormat::day_month_year, 1}},
        {"mm/dd/yyyy hh:mm:ss", {TimeFormat::month_day_year, 1}},
        {"yyyy-mm-dd hh:mm:ss", {TimeFormat::year_month_day, 1}},
        {"iso", {TimeFormat::year_month_day, 1}},
    };

    table.expect_only(time_keys);
    if (!table.has("format")) {
        table.miss("format");
    }
    const auto [format, unit_s] = one_of(table, "format", formats);
    TimeMapping time{.columns = {},
                     .format = format,
                     .unit_s = unit_s * time_scale_of(table, format),
                     .since_1970 = table.has("epoch") && one_of(table, "epoch", epoch_words),
                     .utc_offset_s = table.maybe_number("utc_offset_h"),
                     .fraction_s = table.maybe_number("fraction_s", positive_number),
                     .shift_s = table.maybe_number("shift_s").value_or(0)};
    if (time.utc_offset_s) {
        *time.utc_offset_s *= hour_s;
    }
    if (table.is_number_array("columns")) {
        static constexpr TomlRange column_number{
            [](double x) { return x >= 1 && x <= max_columns && x == std::floor(x); },
            "column numbers from 1 to 10000"};
        for (const auto number : table.numbers("columns", column_number)) {
            time.columns.push_back({.pattern = "", .number = static_cast<std::size_t>(number)});
        }
    } else if (table.has("columns")) {
        for (auto& name : table.texts("columns")) {
            time.columns.push_back({.pattern = std::move(name)});
        }
    } else {
        time.columns.push_back(column_of(table));
    }
    return time;
}

TableMapping with_text_keys(TableMapping mapping, const TomlTable& table) {
    static constexpr std::pair<std::string_view, char> separators[] = {
        {",", ','}, {";", ';'}, {"tab", '\t'}, {"blank", ' '}, {"|", '|'}};
    static constexpr std::pair<std::string_view, char> decimals[] = {{".", '.'}, {",", ','}};
    static constexpr std::pair<std::string_view, TextEncoding> encodings[] = {
        {"utf-8", TextEncoding::utf8},
        {"utf-16le", TextEncoding::utf16le},
        {"latin-1", TextEncoding::latin1}};

    if (table.has("separator")) {
        mapping.separator = one_of(table, "separator", separators);
    }
    if (table.has("decimal")) {
        mapping.decimal = one_of(table, "decimal", decimals);
    }
    if (table.has("encoding")) {
        mapping.encoding = one_of(table, "encoding", encodings);
    }
    if (mapping.separator == ',' && mapping.decimal == ',') {
        table.refuse("decimal", "a character other than the separator");
    }
    return mapping;
}

std::size_t count_of(const TomlTable& table, std::string_view key) {
    return table.has(key) ? static_cast<std::size_t>(table.integer(key, 0, max_skipped)) : 0;
}

TableMapping table_of(const TomlTable& table, const std::filesystem::path& folder) {
    if (table.has("can") || table.has("mdf") || table.has("hdf5")) {
        return signal_table_of(table, folder);
    }
    const auto time = table.table("time");
    const auto channels = table.table("channels");
    if (!time || !channels) {
        table.miss(time ? "channels" : "time");
    }
    TableMapping mapping;
    mapping.file = table.maybe_text("files").value_or("*.csv");
    mapping = with_text_keys(std::move(mapping), table);
    mapping.skip_lines = count_of(table, "skip_lines");
    mapping.rows_under_header = count_of(table, "rows_under_header");
    mapping.comment = table.maybe_text("comment").value_or("");
    mapping.header_begins = table.maybe_text("header_begins").value_or("");
    mapping.has_header = table.maybe_flag("header").value_or(true);
    mapping.empty = table.has("empty") ? table.texts("empty") : std::vector<std::string>{};
    mapping.axes = table.has("axes") ? axes_of(table) : mapping.axes;
    mapping.time = time_of(*time);
    for (const auto& name : channels->keys()) {
        mapping.channels.push_back(channel_of(*channels, name));
        if (!mapping.has_header && mapping.channels.back().column.number == 0) {
            channels->table(name)->refuse("column", "a number, as there is no header");
        }
    }
    return mapping;
}

/// Value of a key in the form of our own log header.
std::string value_text(const TomlTable& table, std::string_view key) {
    if (table.is_text(key)) {
        return table.text_or_empty(key);
    }
    if (table.is_number(key)) {
        return fmt::format("{}", table.number(key));
    }
    return fmt::format("{}", fmt::join(table.numbers(key), " "));
}

TripMeta meta_of(const TomlTable& top) {
    std::vector<MetaLine> lines;
    for (const auto key : meta_keys) {
        if (top.has(key)) {
            lines.push_back({top.where(key), std::string{key}, value_text(top, key)});
        }
    }
    return parse_meta(lines);
}

TripMapping mapping_of(const TomlTable& top, const std::string& name) {
    std::vector<std::string_view> known{table_keys.begin(), table_keys.end()};
    known.insert(known.end(), meta_keys.begin(), meta_keys.end());
    known.push_back("file");
    top.expect_only(known);

    const auto folder = std::filesystem::path{name}.parent_path();
    TripMapping mapping{.where = name,
                        .tables = {table_of(top, folder)},
                        .meta = meta_of(top),
                        .clock = {},
                        .clock_zero_utc_s = {}};
    for (const auto& file : top.tables("file")) {
        file.expect_only(table_keys);
        if (!file.has("files")) {
            file.miss("files");
        }
        mapping.tables.push_back(table_of(file, folder));
    }
    return mapping;
}

} // namespace

TripMapping parse_mapping(std::string_view toml, const std::string& name) {
    return mapping_of(parse_toml(toml, name), name);
}

TripMapping read_mapping(const std::string& name_or_file) {
    for (const auto& [name, toml, begin] : built_in_mappings()) {
        if (name == name_or_file) {
            return parse_mapping(toml, name_or_file);
        }
    }
    return mapping_of(read_toml(name_or_file, "a mapping"), name_or_file);
}

std::vector<std::string_view> built_in_mapping_names() {
    std::vector<std::string_view> names;
    for (const auto& mapping : built_in_mappings()) {
        names.push_back(mapping.name);
    }
    return names;
}

} // namespace macadam
