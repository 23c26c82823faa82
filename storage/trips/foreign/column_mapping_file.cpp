#include "storage/trips/foreign/column_mapping_file.hpp"

#include "estimator/common/gravity.hpp"
#include "storage/tables/toml.hpp"
#include "storage/text/text.hpp"
#include "storage/trips/foreign/built_in_mappings.hpp"
#include "storage/trips/foreign/dbc.hpp"
#include "storage/trips/foreign/unit_names.hpp"
#include "storage/trips/log/trip_meta.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <span>

namespace macadam {

namespace {

constexpr double deg_in_rad = 0.017453292519943295; // pi / 180
constexpr double hour_s = 3600;

// Allowed keys by table.
constexpr std::array<std::string_view, 9> meta_keys{"vehicle_id",
                                                    "frame",
                                                    "gravity",
                                                    "mount",
                                                    "mount_rpy_deg",
                                                    "gnss_latency_s",
                                                    "speed_latency_s",
                                                    "speed_scale",
                                                    "gnss_antenna_pos_m"};
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
constexpr std::array<std::string_view, 6> signal_table_keys{
    "files", "time", "can", "mdf", "hdf5", "channels"}; // and axes
constexpr std::array<std::string_view, 8> time_keys{
    "column", "columns", "format", "scale", "epoch", "utc_offset_h", "fraction_s", "shift_s"};
constexpr std::array<std::string_view, 7> channel_keys{
    "column", "unit", "scale", "offset", "sign", "invalid", "hemisphere"};
constexpr std::array<std::string_view, 6> signal_keys{
    "signal", "unit", "scale", "offset", "sign", "invalid"};
constexpr std::array<std::string_view, 8> dataset_keys{
    "signal", "column", "times", "unit", "scale", "offset", "sign", "invalid"};
constexpr std::array<std::string_view, 4> dataset_time_keys{"format", "scale", "epoch", "shift_s"};
constexpr std::array<std::string_view, 1> hdf5_keys{"times"};
constexpr std::array<std::string_view, 2> signal_time_keys{"utc_offset_h", "shift_s"};
constexpr std::array<std::string_view, 2> can_keys{"dbc", "bus"};
constexpr std::array<std::string_view, 0> no_keys{};

constexpr std::string_view degrees_minutes =
    "ddmm.mmmm"; // unit of latitudes and longitudes in NMEA 0183

constexpr std::int64_t max_columns = 10000;
constexpr std::int64_t max_skipped = 1000000;

struct Unit {
    std::string_view name;
    TripColumn first; ///< of the channels to which the unit applies
    TripColumn last;
    double factor;
};

// clang-format off
constexpr Unit units[] = {
    {"m/s2", TripColumn::acc_x, TripColumn::acc_z, 1},
    {"m/s^2", TripColumn::acc_x, TripColumn::acc_z, 1},
    {"g", TripColumn::acc_x, TripColumn::acc_z, standard_gravity_mps2},
    {"mg", TripColumn::acc_x, TripColumn::acc_z, standard_gravity_mps2 / 1000},
    {"ft/s2", TripColumn::acc_x, TripColumn::acc_z, 0.3048},
    {"rad/s", TripColumn::gyro_x, TripColumn::gyro_z, 1},
    {"deg/s", TripColumn::gyro_x, TripColumn::gyro_z, deg_in_rad},
    {"m/s", TripColumn::speed, TripColumn::wheel_rr, 1},
    {"km/h", TripColumn::speed, TripColumn::wheel_rr, 1 / 3.6},
    {"mph", TripColumn::speed, TripColumn::wheel_rr, 0.44704},
    {"m/s", TripColumn::gnss_speed, TripColumn::gnss_speed, 1},
    {"cm/s", TripColumn::gnss_speed, TripColumn::gnss_speed, 0.01},
    {"mm/s", TripColumn::gnss_speed, TripColumn::gnss_speed, 0.001},
    {"km/h", TripColumn::gnss_speed, TripColumn::gnss_speed, 1 / 3.6},
    {"mph", TripColumn::gnss_speed, TripColumn::gnss_speed, 0.44704},
    {"kn", TripColumn::gnss_speed, TripColumn::gnss_speed, 1852.0 / 3600},
    {"deg", TripColumn::lat, TripColumn::lon, 1},
    {degrees_minutes, TripColumn::lat, TripColumn::lon, 1},
    {"deg", TripColumn::course, TripColumn::course, 1},
    {"m", TripColumn::hacc, TripColumn::hacc, 1},
    {"ft", TripColumn::hacc, TripColumn::hacc, 0.3048},
};
// clang-format on

/// Value of a key that must be one of several words.
template <typename Value, std::size_t count>
Value one_of(const TomlTable& table,
             std::string_view key,
             const std::pair<std::string_view, Value> (&words)[count]) {
    const auto text = table.text(key);
    std::string expected;
    for (const auto& [word, value] : words) {
        if (word == text) {
            return value;
        }
        expected += fmt::format("{}{}", expected.empty() ? "" : ", ", word);
    }
    table.refuse(key, "one of " + expected);
}

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

double unit_of(const TomlTable& table, TripColumn channel) {
    if (!table.has("unit")) {
        return 1;
    }
    const auto name = table.text("unit");
    std::string expected;
    for (const auto& unit : units) {
        if (channel < unit.first || channel > unit.last) {
            continue;
        }
        if (unit.name == name) {
            return unit.factor;
        }
        expected += fmt::format("{}{}", expected.empty() ? "one of " : ", ", unit.name);
    }
    table.refuse("unit", expected.empty() ? "no unit for this channel" : expected);
}

double scale_of(const TomlTable& table, TripColumn channel) {
    const double sign = table.has("sign") && table.integer("sign", -1, 1) < 0 ? -1 : 1;
    return sign * unit_of(table, channel) * table.maybe_number("scale").value_or(1);
}

/// Column of a channel, by the name of its key.
TripColumn
known_channel(const TomlTable& channels, const std::string& name, std::string_view expected_key) {
    const auto channel = channel_named(name);
    if (!channel || *channel == TripColumn::t_s) {
        channels.refuse_unknown(name, "a column of docs/reference/trip-logs.md");
    }
    if (channels.is_text(name)) {
        channels.refuse(name, fmt::format("{{{} = \"{}\"}}", expected_key, channels.text(name)));
    }
    return *channel;
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

/// Column of a dataset, and the dataset with its times.
void take_dataset(const TomlTable& table, const std::string& times, ChannelMapping& mapped) {
    mapped.column.number =
        table.has("column") ? static_cast<std::size_t>(table.integer("column", 1, max_columns)) : 1;
    mapped.times = table.maybe_text("times").value_or(times);
    if (mapped.times.empty()) {
        table.miss("times");
    }
}

/// Signal of a channel, in a log that is no table. A DBC file states the unit, unless the mapping
/// does.
ChannelMapping
signal_of(const TomlTable& channels, const std::string& name, const TableMapping& mapping) {
    const auto channel = known_channel(channels, name, "signal");
    const auto table = channels.table(name);
    if (mapping.format == LogFormat::hdf5) {
        table->expect_only(dataset_keys);
    } else {
        table->expect_only(signal_keys);
    }
    if (!table->has("signal")) {
        table->miss("signal");
    }
    ChannelMapping mapped{.channel = channel,
                          .column = {.pattern = table->text("signal")},
                          .scale = scale_of(*table, channel),
                          .offset = table->maybe_number("offset").value_or(0),
                          .invalid = table->has("invalid") ? table->numbers("invalid")
                                                           : std::vector<double>{},
                          .degrees_minutes = table->maybe_text("unit") == degrees_minutes,
                          .unit_stated = table->has("unit")};
    if (mapped.degrees_minutes) {
        table->refuse("unit", "deg");
    }
    if (mapping.dbc == nullptr) {
        return mapped;
    }
    std::string expected;
    const auto found = find_signal(*mapping.dbc, mapped.column.pattern, expected);
    if (!found) {
        table->refuse("signal", expected);
    }
    mapped.in_dbc = *found;
    const auto& unit = mapping.dbc->messages[found->message].signals[found->signal].unit;
    if (!mapped.unit_stated && !unit.empty()) {
        const auto factor = unit_factor(channel, unit);
        if (!factor) {
            table->refuse("signal",
                          fmt::format("a key 'unit' beside it: the DBC file says {}, which is no "
                                      "unit of {}",
                                      in_quotes(unit),
                                      name));
        }
        mapped.scale *= *factor;
    }
    return mapped;
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
    static constexpr std::pair<std::string_view, bool> epochs[] = {{"boot", false}, {"unix", true}};

    table.expect_only(time_keys);
    if (!table.has("format")) {
        table.miss("format");
    }
    const auto [format, unit_s] = one_of(table, "format", formats);
    TimeMapping time{.columns = {},
                     .format = format,
                     .unit_s = unit_s * time_scale_of(table, format),
                     .since_1970 = table.has("epoch") && one_of(table, "epoch", epochs),
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

std::array<int, 3> axes_of(const TomlTable& table) {
    constexpr std::string_view expected = "x, y and z in some order, each perhaps with a minus";
    const auto words = table.texts("axes");
    std::array<int, 3> axes{};
    std::array<int, 3> uses{};
    if (words.size() != axes.size()) {
        table.refuse("axes", expected);
    }
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const bool turned = words[i].starts_with('-');
        const auto letter = std::string_view{words[i]}.substr(turned ? 1 : 0);
        const auto axis = std::string_view{"xyz"}.find(letter);
        if (letter.size() != 1 || axis == std::string_view::npos || uses[axis]++ > 0) {
            table.refuse("axes", expected);
        }
        axes[i] = (turned ? -1 : 1) * static_cast<int>(axis + 1);
    }
    return axes;
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

/// Unit and epoch of the times of datasets.
TimeMapping dataset_time_of(const TomlTable& table) {
    static constexpr std::pair<std::string_view, double> formats[] = {
        {"s", 1}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}};
    static constexpr std::pair<std::string_view, bool> epochs[] = {{"boot", false}, {"unix", true}};
    table.expect_only(dataset_time_keys);
    TimeMapping time;
    time.unit_s = (table.has("format") ? one_of(table, "format", formats) : 1) *
                  table.maybe_number("scale", positive_number).value_or(1);
    time.since_1970 = table.has("epoch") && one_of(table, "epoch", epochs);
    time.shift_s = table.maybe_number("shift_s").value_or(0);
    return time;
}

/// CAN log or measurement file: its signals have names, and the format knows their times.
TableMapping signal_table_of(const TomlTable& table, const std::filesystem::path& folder) {
    auto known = std::vector<std::string_view>{signal_table_keys.begin(), signal_table_keys.end()};
    known.insert(known.end(), meta_keys.begin(), meta_keys.end());
    known.insert(known.end(), {"axes", "file"});
    table.expect_only(known);
    const auto can = table.table("can");
    const auto channels = table.table("channels");
    if (!channels) {
        table.miss("channels");
    }
    const auto hdf5 = table.table("hdf5");
    TableMapping mapping;
    mapping.format = can ? LogFormat::can : hdf5 ? LogFormat::hdf5 : LogFormat::mdf;
    mapping.file = table.maybe_text("files").value_or(can ? "*.log" : hdf5 ? "*.h5" : "*.mf4");
    std::string times;
    mapping.axes = table.has("axes") ? axes_of(table) : mapping.axes;
    if (can) {
        can->expect_only(can_keys);
        if (!can->has("dbc")) {
            can->miss("dbc");
        }
        const auto file = folder / can->text("dbc");
        mapping.dbc_name = file.string();
        mapping.dbc = std::make_shared<const Dbc>(read_dbc(file));
        mapping.bus = can->maybe_text("bus").value_or("");
    } else if (hdf5) {
        hdf5->expect_only(hdf5_keys);
        times = hdf5->maybe_text("times").value_or("");
    } else {
        table.table("mdf")->expect_only(no_keys);
    }
    if (const auto time = table.table("time"); time && hdf5) {
        mapping.time = dataset_time_of(*time);
    } else if (time) {
        time->expect_only(signal_time_keys);
        mapping.time.utc_offset_s = time->maybe_number("utc_offset_h");
        if (mapping.time.utc_offset_s) {
            *mapping.time.utc_offset_s *= hour_s;
        }
        mapping.time.shift_s = time->maybe_number("shift_s").value_or(0);
    }
    for (const auto& name : channels->keys()) {
        mapping.channels.push_back(signal_of(*channels, name, mapping));
        if (hdf5) {
            take_dataset(*channels->table(name), times, mapping.channels.back());
        }
    }
    return mapping;
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

std::optional<double> unit_factor(TripColumn channel, std::string_view unit) {
    const auto is_of_channel = [&](const Unit& known) {
        return channel >= known.first && channel <= known.last;
    };
    if (std::ranges::none_of(units, is_of_channel)) {
        return 1; // a code or a count
    }
    for (const auto kind : {UnitKind::acceleration,
                            UnitKind::angular_rate,
                            UnitKind::speed,
                            UnitKind::angle,
                            UnitKind::length}) {
        const auto word = unit_named(kind, unit);
        const auto* const found = std::ranges::find_if(
            units, [&](const Unit& known) { return word == known.name && is_of_channel(known); });
        if (word && found != std::end(units)) {
            return found->factor;
        }
    }
    return std::nullopt;
}

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
