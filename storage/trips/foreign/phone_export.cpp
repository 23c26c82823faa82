#include "storage/trips/foreign/phone_export.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/gravity.hpp"
#include "storage/tables/csv_cells.hpp"
#include "storage/tables/text_lines.hpp"
#include "storage/text/text.hpp"
#include "storage/trips/foreign/text_decoding.hpp"
#include "storage/trips/foreign/trip_files.hpp"
#include "storage/trips/source/phone_export_files.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace macadam {

namespace {

/// First file with one of the names; "" if there is none.
template <std::size_t count>
std::string found(const TripSource& source, const std::string_view (&names)[count]) {
    for (const auto name : names) {
        for (const auto& file : source.files) {
            if (fits(file, name)) {
                return file;
            }
        }
    }
    return "";
}

std::string found(const TripSource& source, std::string_view name) {
    const std::string_view names[] = {name};
    return found(source, names);
}

TextLines lines_of(const TripSource& source, const std::string& file) {
    const auto name = name_of_file(source, file);
    return {decoded(bytes_of_file(source, file), TextEncoding::utf8, name), name};
}

/// Header of a table, and the format of its cells.
struct Layout {
    std::string file;
    std::vector<std::string> names;
    char separator = ',';
    char decimal = '.';
};

/// Detects the layout. Exports use comma, semicolon or tab; with the last two, the comma may be the
/// decimal separator.
Layout layout_of(const TripSource& source, const std::string& file) {
    auto lines = lines_of(source, file);
    Layout layout{.file = file, .names = {}};
    const auto header = lines.next();
    if (!header) {
        throw InputError{
            fmt::format("{}: is empty, expected a header row", name_of_file(source, file))};
    }
    for (const char separator : {',', ';', '\t'}) {
        auto names = cells_of_line(*header, separator);
        if (names.size() > layout.names.size()) {
            layout.names = std::move(names);
            layout.separator = separator;
        }
    }
    const auto row = lines.next();
    if (layout.separator != ',' && row && row->find(',') != std::string_view::npos) {
        layout.decimal = ',';
    }
    return layout;
}

bool has(const Layout& layout, std::string_view pattern) {
    return std::any_of(layout.names.begin(), layout.names.end(), [&](const std::string& name) {
        return fits(name, pattern);
    });
}

TableMapping table_of(const Layout& layout) {
    TableMapping table;
    table.file = layout.file;
    table.separator = layout.separator;
    table.decimal = layout.decimal;
    return table;
}

/// Channel with the possible names of its column.
struct Known {
    TripColumn channel;
    std::vector<std::string> patterns;
};

/// Adds the channels that occur in the header to a table.
TableMapping
with_channels(TableMapping table, const Layout& layout, const std::vector<Known>& all) {
    for (const auto& [channel, patterns] : all) {
        const auto pattern = std::find_if(
            patterns.begin(), patterns.end(), [&](const auto& p) { return has(layout, p); });
        if (pattern != patterns.end()) {
            table.channels.push_back(
                {.channel = channel, .column = {.pattern = *pattern}, .invalid = {}});
        }
    }
    return table;
}

std::vector<Known> three_axes(TripColumn x) {
    std::vector<Known> axes;
    for (const std::string letter : {"x", "y", "z"}) {
        const auto channel = static_cast<TripColumn>(static_cast<std::size_t>(x) + axes.size());
        axes.push_back({channel, {letter, letter + " (*", "* " + letter + " (*"}});
    }
    return axes;
}

const std::vector<Known>& location_columns() {
    static const std::vector<Known> columns{
        {TripColumn::lat, {"latitude*"}},
        {TripColumn::lon, {"longitude*"}},
        {TripColumn::gnss_speed, {"velocity*", "speed", "speed (*"}},
        {TripColumn::course, {"direction*", "bearing", "bearing (*"}},
        {TripColumn::hacc, {"horizontalAccuracy", "horizontal accuracy*", "accuracy (*"}}};
    return columns;
}

TripMapping phone_mapping(const TripSource& source) {
    TripMapping mapping{
        .where = source.name(), .tables = {}, .meta = {}, .clock = {}, .clock_zero_utc_s = {}};
    mapping.meta.frame = Frame::sensor;
    mapping.meta.frame_stated = true;
    mapping.meta.mount_auto = true;
    return mapping;
}

// phyphox

TableMapping phyphox_table(const Layout& layout, const std::vector<Known>& channels) {
    auto table = with_channels(table_of(layout), layout, channels);
    table.time.columns = {{.pattern = "time*"}};
    return table;
}

/// Reads meta/time.csv: one row for each start and pause, with the times of the experiment and the
/// phone.
TripMapping with_phyphox_clock(TripMapping mapping, const TripSource& source) {
    const auto file = found(source, time_file);
    if (file.empty()) {
        return mapping;
    }
    const auto layout = layout_of(source, file);
    auto lines = lines_of(source, file);
    lines.next();
    while (const auto line = lines.next()) {
        auto cells = cells_of_line(*line, layout.separator);
        if (cells.size() < 3 || !fits(cells[0], "start")) {
            continue;
        }
        for (auto& cell : cells) {
            std::replace(cell.begin(), cell.end(), layout.decimal, '.');
        }
        const auto clock_s = parse_number(cells[1]);
        const auto utc_s = parse_number(cells[2]);
        if (!clock_s || !utc_s) {
            throw InputError{fmt::format(
                "{}: {}, expected two times in seconds", lines.where(), in_quotes(*line, 80))};
        }
        if (!mapping.clock_zero_utc_s) {
            mapping.clock_zero_utc_s = *utc_s - *clock_s;
        }
        mapping.clock.push_back({*clock_s, *utc_s - *clock_s - *mapping.clock_zero_utc_s});
    }
    return mapping;
}

TripMapping phyphox_mapping(const TripSource& source) {
    auto mapping = phone_mapping(source);
    auto acc = found(source, acc_files);
    if (acc.empty()) {
        acc = found(source, linear_files);
        mapping.meta.gravity_included = acc.empty();
    }
    if (!acc.empty()) {
        mapping.tables.push_back(
            phyphox_table(layout_of(source, acc), three_axes(TripColumn::acc_x)));
    }
    if (const auto gyro = found(source, gyro_files); !gyro.empty()) {
        mapping.tables.push_back(
            phyphox_table(layout_of(source, gyro), three_axes(TripColumn::gyro_x)));
    }
    if (const auto location = found(source, location_files); !location.empty()) {
        mapping.tables.push_back(phyphox_table(layout_of(source, location), location_columns()));
    }
    return with_phyphox_clock(std::move(mapping), source);
}

// Sensor Logger

/// Properties of the phone in Metadata.csv.
struct Phone {
    bool is_ios = false;
    bool is_standardised = false;
};

Phone phone_of(const TripSource& source) {
    const auto file = found(source, metadata_file);
    if (file.empty()) {
        return {};
    }
    auto lines = lines_of(source, file);
    const auto names = cells_of_line(lines.next().value_or(""), ',');
    const auto values = cells_of_line(lines.next().value_or(""), ',');
    Phone phone;
    for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i) {
        phone.is_ios = phone.is_ios || (fits(names[i], "platform") && fits(values[i], "ios"));
        phone.is_standardised =
            phone.is_standardised || (fits(names[i], "standardisation") && fits(values[i], "true"));
    }
    return phone;
}

TableMapping logger_table(const Layout& layout, const std::vector<Known>& channels) {
    auto table = with_channels(table_of(layout), layout, channels);
    table.time = {.columns = {{.pattern = "time"}},
                  .unit_s = 1e-9,
                  .since_1970 = true,
                  .utc_offset_s = {},
                  .fraction_s = {}};
    return table;
}

TableMapping
logger_acc_table(const TripSource& source, const std::string& file, const Phone& phone) {
    auto table = logger_table(layout_of(source, file), three_axes(TripColumn::acc_x));
    if (phone.is_ios && !phone.is_standardised) {
        table.axes = {-1, -2, -3};
        for (auto& channel : table.channels) {
            channel.scale = is_named_in(file, raw_files) ? standard_gravity_mps2 : 1;
        }
    }
    return table;
}

TripMapping with_logger_acc(TripMapping mapping, const TripSource& source) {
    const auto phone = phone_of(source);
    const auto total = found(source, total_files);
    const auto acc = found(source, acc_files);
    const auto raw = found(source, raw_files);
    const auto gravity = found(source, gravity_files);
    if (!total.empty()) {
        mapping.tables.push_back(logger_acc_table(source, total, phone));
    } else if (!acc.empty() && !gravity.empty()) {
        mapping.tables.push_back(logger_acc_table(source, gravity, phone));
        mapping.tables.back().is_gravity = true;
        mapping.tables.push_back(logger_acc_table(source, acc, phone));
    } else if (!raw.empty()) {
        mapping.tables.push_back(logger_acc_table(source, raw, phone));
    } else if (!acc.empty()) {
        mapping.tables.push_back(logger_acc_table(source, acc, phone));
        mapping.meta.gravity_included = false;
    }
    return mapping;
}

TripMapping logger_mapping(const TripSource& source) {
    auto mapping = with_logger_acc(phone_mapping(source), source);
    if (const auto gyro = found(source, gyro_files); !gyro.empty()) {
        mapping.tables.push_back(
            logger_table(layout_of(source, gyro), three_axes(TripColumn::gyro_x)));
    }
    if (const auto location = found(source, location_files); !location.empty()) {
        mapping.tables.push_back(logger_table(layout_of(source, location), location_columns()));
    }
    return mapping;
}

} // namespace

void expect_files_of_export(const TripSource& source, const TripNeeds& needs) {
    const auto needed = [&](const std::string& column) {
        return std::ranges::any_of(needs.required, [&](const NeededMeasurement& one) {
            return std::ranges::find(one.columns, column) != one.columns.end();
        });
    };
    if ((needed("lat_deg") || needed("gnss_speed_mps")) && found(source, location_files).empty()) {
        throw InputError{fmt::format(
            "{}: contains no Location.csv, expected one with positions and speeds", source.name())};
    }
}

std::vector<std::string> used_files(const TripSource& source) {
    std::vector<std::string> files;
    for (const auto& table : mapping_of_export(source).tables) {
        files.push_back(table.file);
    }
    for (const auto name : {time_file, metadata_file}) {
        if (auto file = found(source, name); !file.empty()) {
            files.push_back(std::move(file));
        }
    }
    return files;
}

TripMapping mapping_of_export(const TripSource& source) {
    const auto marker = std::find_if(source.files.begin(),
                                     source.files.end(),
                                     [](const std::string& file) { return marks_export(file); });
    if (marker == source.files.end()) {
        throw InputError{
            fmt::format("{}: expected an export of phyphox or Sensor Logger", source.name())};
    }
    const auto layout = layout_of(source, *marker);
    if (has(layout, "seconds_elapsed")) {
        return logger_mapping(source);
    }
    if (has(layout, "time (*")) {
        return phyphox_mapping(source);
    }
    std::string header;
    for (const auto& name : layout.names) {
        header += (header.empty() ? "" : ",") + name;
    }
    throw InputError{
        fmt::format("{}:1: the header has {}, expected that of phyphox ('Time (s)') or "
                    "of Sensor Logger ('seconds_elapsed')",
                    name_of_file(source, *marker),
                    in_quotes(header, 200))};
}

} // namespace macadam
