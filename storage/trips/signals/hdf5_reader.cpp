#include "storage/trips/signals/hdf5_reader.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/byte_stream.hpp"
#include "storage/trips/signals/hdf5_datasets.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace macadam {
namespace {

/// Bytes that the numbers of all datasets together may take, as for compressed files
/// (docs/reference/trip-logs.md).
std::size_t most_bytes(std::size_t file_bytes) {
    return std::min<std::size_t>(
        max_decompressed_bytes,
        std::max<std::size_t>(free_decompressed_bytes, max_expansion * file_bytes));
}

void add_rows(const std::map<std::string, Hdf5Dataset>& datasets,
              const std::string& times,
              const TableMapping& mapping,
              const std::string& name,
              SignalRows& rows) {
    const auto& time = datasets.at(times);
    std::vector<std::pair<std::uint16_t, const Hdf5Dataset*>> channels;
    for (std::size_t i = 0; i < mapping.channels.size(); ++i) {
        const auto& channel = mapping.channels[i];
        if (channel.times != times) {
            continue;
        }
        const auto& dataset = datasets.at(channel.column.pattern);
        if (dataset.rows != time.rows || channel.column.number > dataset.columns) {
            throw InputError{fmt::format("{}: dataset '{}' has {} rows of {} numbers, expected {} "
                                         "rows, as its times '{}' have, and {} or more numbers",
                                         name,
                                         channel.column.pattern,
                                         dataset.rows,
                                         dataset.columns,
                                         time.rows,
                                         times,
                                         channel.column.number)};
        }
        channels.emplace_back(static_cast<std::uint16_t>(i), &dataset);
    }
    std::vector<SignalRows::Value> values;
    for (std::size_t row = 0; row < time.rows; ++row) {
        const double t_s = time.values[row * time.columns] * mapping.time.unit_s;
        if (!std::isfinite(t_s)) {
            rows.add(RowReason::no_time);
            continue;
        }
        values.clear();
        for (const auto& [channel, dataset] : channels) {
            const auto column = mapping.channels[channel].column.number - 1;
            values.push_back({channel, dataset->values[row * dataset->columns + column]});
        }
        rows.add(t_s, values);
    }
}

} // namespace

SignalRows read_hdf5(std::string_view bytes, const TableMapping& mapping, const std::string& name) {
    std::map<std::string, Hdf5Dataset> datasets;
    std::map<std::string, std::size_t> times;
    for (const auto& channel : mapping.channels) {
        datasets[channel.column.pattern];
        datasets[channel.times];
        ++times[channel.times];
    }
    std::vector<std::string> wanted;
    for (const auto& [path, dataset] : datasets) {
        wanted.push_back(path);
    }
    try {
        auto read = read_hdf5_datasets(bytes, wanted, most_bytes(bytes.size()));
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            datasets[wanted[i]] = std::move(read[i]);
        }
    } catch (const InputError& error) {
        throw InputError{name + ": " + error.what()};
    }
    SignalRows rows{mapping};
    for (const auto& [path, count] : times) {
        add_rows(datasets, path, mapping, name, rows);
    }
    if (mapping.time.since_1970) {
        rows.set_dated();
    }
    rows.finish();
    return rows;
}

} // namespace macadam
