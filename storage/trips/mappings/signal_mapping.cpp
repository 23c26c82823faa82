#include "storage/trips/mappings/signal_mapping.hpp"

#include "storage/tables/toml.hpp"
#include "storage/text/text.hpp"
#include "storage/trips/mappings/column_units.hpp"
#include "storage/trips/mappings/dbc.hpp"
#include "storage/trips/mappings/mapping_keys.hpp"

#include <fmt/format.h>

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {

namespace {

// Allowed keys by table.
constexpr std::array<std::string_view, 6> signal_table_keys{
    "files", "time", "can", "mdf", "hdf5", "channels"}; // and axes
constexpr std::array<std::string_view, 6> signal_keys{
    "signal", "unit", "scale", "offset", "sign", "invalid"};
constexpr std::array<std::string_view, 8> dataset_keys{
    "signal", "column", "times", "unit", "scale", "offset", "sign", "invalid"};
constexpr std::array<std::string_view, 4> dataset_time_keys{"format", "scale", "epoch", "shift_s"};
constexpr std::array<std::string_view, 1> hdf5_keys{"times"};
constexpr std::array<std::string_view, 2> signal_time_keys{"utc_offset_h", "shift_s"};
constexpr std::array<std::string_view, 2> can_keys{"dbc", "bus"};

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

/// Bus of a log of frames, and its DBC file.
void take_bus(const TomlTable& table, const std::filesystem::path& folder, TableMapping& mapping) {
    table.expect_only(can_keys);
    if (!table.has("dbc")) {
        table.miss("dbc");
    }
    const auto file = folder / table.text("dbc");
    mapping.dbc_name = file.string();
    mapping.dbc = std::make_shared<const Dbc>(read_dbc(file));
    mapping.bus = table.maybe_text("bus").value_or("");
}

/// Unit and epoch of the times of datasets.
TimeMapping dataset_time_of(const TomlTable& table) {
    static constexpr std::pair<std::string_view, double> formats[] = {
        {"s", 1}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}};
    table.expect_only(dataset_time_keys);
    TimeMapping time;
    time.unit_s = (table.has("format") ? one_of(table, "format", formats) : 1) *
                  table.maybe_number("scale", positive_number).value_or(1);
    time.since_1970 = table.has("epoch") && one_of(table, "epoch", epoch_words);
    time.shift_s = table.maybe_number("shift_s").value_or(0);
    return time;
}

} // namespace

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
        take_bus(*can, folder, mapping);
    } else if (hdf5) {
        hdf5->expect_only(hdf5_keys);
        times = hdf5->maybe_text("times").value_or("");
    } else if (const auto mdf = table.table("mdf"); mdf->has("dbc") || mdf->has("bus")) {
        take_bus(*mdf, folder, mapping);
    } else {
        mdf->expect_only(can_keys);
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

} // namespace macadam
