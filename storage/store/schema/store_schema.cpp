#include "storage/store/schema/store_schema.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/exact_number.hpp"
#include "storage/geopackage/geopackage.hpp"
#include "storage/geopackage/qgis_style.hpp"
#include "storage/store/schema/network_rows.hpp"
#include "storage/store/schema/new_store.hpp"
#include "storage/store/schema/schema_check.hpp"
#include "storage/store/schema/schema_sql.hpp"
#include "storage/store/schema/store_marker.hpp"
#include "storage/store/schema/store_versions.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

namespace macadam {
namespace {

// ---------------------------------------------------------------------------------------- meta

constexpr double min_segment_m = 0.1; // far below and above the limits of 'macadam init'
constexpr double max_segment_m = 100'000;

constexpr std::string_view max_trips_key = "max_trips_per_car_month"; // of table fusion_setting

void put(Database& database, std::string_view key, std::string_view value) {
    database.prepare("INSERT INTO meta VALUES (?, ?)").run(key, value);
}

void replace(Database& database, std::string_view key, std::string_view value) {
    database
        .prepare("INSERT INTO meta VALUES (?, ?)"
                 " ON CONFLICT (key) DO UPDATE SET value = excluded.value")
        .run(key, value);
}

std::string meta(Database& database, std::string_view key) {
    auto statement = database.prepare("SELECT value FROM meta WHERE key = ?");
    return statement.bind(key).step() ? statement.text(0) : std::string{};
}

double real_meta(Database& database, std::string_view key) {
    const auto text = meta(database, key);
    double value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

void write_meta(Database& database,
                const RoadNetwork& roads,
                const StoreSettings& settings,
                const std::string& network_hash,
                const WrittenSegments& written) {
    put(database, "format", store_format);
    put(database, "version", fmt::format("{}", store_version));
    put(database, "segment_length_m", fmt::format("{}", roads.segment_length_m));
    put(database, "class_table", settings.class_table);
    put(database, "network_source", settings.network_source);
    put(database, "attribution", settings.attribution);
    put(database, "network_sha256", network_hash);
    put(database, "segments", fmt::format("{}", written.segments));
    put(database, "network_m", fmt::format("{}", written.length_m));
    put(database, "generation", "1");
    put(database, "privacy", name_of(settings.privacy));
    if (settings.kept_logs.days > 0) {
        put(database, "kept_logs_days", fmt::format("{}", settings.kept_logs.days));
        put(database, "kept_logs_key", settings.kept_logs.public_key);
    }
    if (settings.max_trips_per_car_month > 0) {
        database.prepare("INSERT INTO fusion_setting VALUES (?, ?)")
            .run(max_trips_key, settings.max_trips_per_car_month);
    }
}

} // namespace

void make_store_tables(Database& database, PrivacyProfile privacy) {
    make_geopackage(database);
    database.run(store_tables());
    database.run(roughness_layer(privacy));
    add_style_table(database);
    index_store_tables(database);
}

void replace_roughness_layer(Database& database, PrivacyProfile privacy) {
    database.run("DROP VIEW roughness");
    database.run(roughness_layer(privacy));
}

PrivacyProfile claimed_privacy(Database& database) {
    return privacy_profile_named(meta(database, "privacy")).value_or(PrivacyProfile::own);
}

void write_store(Database& database,
                 const RoadNetwork& roads,
                 const StoreSettings& settings,
                 const std::string& key_id,
                 const Progress& progress) {
    fill_new_store(database, settings.class_table, settings.privacy, [&] {
        const auto network_hash = write_ways(database, roads);
        const auto written = write_segments(database, roads, progress);
        write_meta(database, roads, settings, network_hash, written);
        put_key_id(database, key_id);
        return extent_of(roads);
    });
}

int expect_store(Database& database, const Schema& found) {
    const auto refuse = [&](std::string_view what, std::string_view is) {
        throw InputError{fmt::format(
            "{}: {}, expected one made by 'macadam init'{}", database.file().string(), what, is)};
    };
    if (const auto id = database.number("PRAGMA application_id"); id != geopackage_application_id) {
        refuse("is not a Macadam database",
               id == 0 ? "; it is an SQLite database without an application id"
                       : fmt::format("; it is an SQLite database of another application "
                                     "({:#010x})",
                                     static_cast<std::uint32_t>(id)));
    }
    const auto table = found.find({"table", "meta"});
    const bool is_ours =
        table != found.end() && table->second == own_schema().at({"table", "meta"});
    if (!is_ours || meta(database, "format") != store_format) {
        refuse("is a GeoPackage, but not a Macadam database", "");
    }
    const auto text = meta(database, "version");
    const auto version = exact_number<int>(text);
    if (!version || *version < oldest_store_version || *version > store_version) {
        throw InputError{fmt::format("{}: is a database of version {}, expected version {}: {}",
                                     database.file().string(),
                                     in_quotes(text),
                                     store_version,
                                     version && *version > store_version
                                         ? "it was made by a newer version of Macadam"
                                         : "create it again with 'macadam init' and import its "
                                           "trips again")};
    }
    return *version;
}

void check_store(Database& database) {
    const auto found = read_schema(database);
    const int version = expect_store(database, found);
    const auto privacy = claimed_privacy(database);
    if (version < store_version) {
        expect_no_foreign_object(database, found, schema_of_version(version, privacy));
        throw InputError{fmt::format("{0}: is a database of version {1}, expected version {2}: "
                                     "run 'macadam upgrade {0}', which keeps all content",
                                     database.file().string(),
                                     version,
                                     store_version)};
    }
    expect_no_foreign_object(database, found, own_schema(privacy));
    expect_whole_schema(database, found, own_schema(privacy));
}

StoreSettings read_settings(Database& database) {
    StoreSettings settings{.segment_length_m = real_meta(database, "segment_length_m"),
                           .class_table = meta(database, "class_table"),
                           .network_source = meta(database, "network_source"),
                           .attribution = meta(database, "attribution")};
    const auto refuse = [&](std::string_view key, std::string_view expected) {
        throw InputError{fmt::format("{}: {} is {}, expected {}; the database was modified by "
                                     "another program",
                                     database.file().string(),
                                     key,
                                     in_quotes(meta(database, key)),
                                     expected)};
    };
    if (class_table(settings.class_table) == nullptr) {
        refuse("class_table", "fhwa or five");
    }
    const auto privacy = privacy_profile_named(meta(database, "privacy"));
    if (!privacy) {
        refuse("privacy", "own or crowd");
    }
    settings.privacy = *privacy;
    if (!(settings.segment_length_m >= min_segment_m &&
          settings.segment_length_m <= max_segment_m)) {
        refuse("segment_length_m", "a length of segments");
    }
    if (const auto text = meta(database, "kept_logs_days"); !text.empty()) {
        const auto days = exact_number<std::int64_t>(text);
        if (!days || *days < 1 || *days > max_kept_logs_days) {
            refuse("kept_logs_days", fmt::format("1 to {}", max_kept_logs_days));
        }
        settings.kept_logs.days = *days;
        settings.kept_logs.public_key = meta(database, "kept_logs_key");
    }
    settings.max_trips_per_car_month = read_max_trips_per_car_month(database);
    return settings;
}

std::int64_t read_max_trips_per_car_month(Database& database) {
    auto select = database.prepare("SELECT value FROM fusion_setting WHERE key = ?");
    return select.bind(max_trips_key).step() ? std::max<std::int64_t>(0, select.integer(0)) : 0;
}

bool are_rows_in_order(Database& database) {
    auto select = database.prepare(select_rows_in_order);
    return are_rows_in_order(select);
}

bool are_rows_in_order(Statement& select) {
    return !select.step() || select.text(0) != "0";
}

void update_network_meta(Database& database, const NetworkMeta& network) {
    replace(database, "network_source", network.source);
    replace(database, "attribution", network.attribution);
    replace(database, "network_sha256", network.hash);
    replace(database, "segments", fmt::format("{}", network.segments));
    replace(database, "network_m", fmt::format("{}", network.length_m));
    replace(database, "rows_in_order", "0");
}

std::string read_key_id(Database& database) {
    return meta(database, "key_id");
}

void put_key_id(Database& database, const std::string& key_id) {
    replace(database, "key_id", key_id);
}

std::vector<std::int64_t> read_last_of_keys(Database& database) {
    const auto text = meta(database, "last_of_keys");
    const char* const past = text.data() + text.size();
    std::vector<std::int64_t> rows;
    for (const char* at = text.data(); at != past;) {
        std::int64_t row = 0;
        const auto [end, error] = std::from_chars(at, past, row);
        if (error != std::errc{} || (!rows.empty() && row < rows.back())) {
            throw InputError{fmt::format("{}: last_of_keys is {}, expected rows of cars; the "
                                         "database was modified by another program",
                                         database.file().string(),
                                         in_quotes(text))};
        }
        rows.push_back(row);
        at = end == past ? past : end + 1;
    }
    return rows;
}

void add_last_of_key(Database& database) {
    const auto row = database.number("SELECT coalesce(max(id), 0) FROM vehicle");
    const auto rows = meta(database, "last_of_keys");
    replace(database, "last_of_keys", fmt::format("{}{}{}", rows, rows.empty() ? "" : " ", row));
}

std::string read_network_hash(Database& database) {
    return meta(database, "network_sha256");
}

int read_generation(Database& database) {
    return std::max(1, static_cast<int>(real_meta(database, "generation")));
}

int begin_generation(Database& database) {
    const int generation = read_generation(database) + 1;
    database.prepare("UPDATE meta SET value = ? WHERE key = 'generation'")
        .run(std::to_string(generation));
    return generation;
}

} // namespace macadam
