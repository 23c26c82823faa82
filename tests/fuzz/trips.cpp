#include "input_file.hpp"
#include "mapping/network/build_network.hpp"
#include "rules.hpp"
#include "targets.hpp"

#include "app/pipeline/pipeline.hpp"
#include "estimator/motion/trip_motion.hpp"
#include "mapping/inference/network_inference.hpp"
#include "storage/trips/detection/detected_mapping.hpp"
#include "storage/trips/log/trip_writer.hpp"
#include "storage/trips/mappings/column_mapping.hpp"
#include "storage/trips/mappings/column_mapping_file.hpp"
#include "storage/trips/trip_follower.hpp"
#include "storage/trips/trip_reader.hpp"
#include "support/roads/walked_trips.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace macadam::fuzz {
namespace {

void expect_rising(const std::vector<double>& t_s) {
    expect(std::ranges::adjacent_find(t_s, std::greater_equal{}) == t_s.end(), "times rise");
}

void expect_whole(const TriaxialSamples& samples) {
    const auto count = samples.t_s.size();
    expect(samples.x.size() == count && samples.y.size() == count && samples.z.size() == count,
           "every time has its readings");
    expect_rising(samples.t_s);
}

void expect_accounted(const TripLog& trip, const RowAudit& use) {
    const auto rows = account(trip, use);
    expect(rows.read == trip.rows.size(), "every row is counted");
    expect(rows.read == rows.used + rows.rejected, "every row is either used or rejected");
}

void expect_sound(const TripLog& trip) {
    expect_whole(trip.acc);
    expect_whole(trip.gyro);
    expect(trip.speed.t_s.size() == trip.speed.speed_mps.size(), "every time has its speed");
    expect_rising(trip.speed.t_s);
    expect(std::ranges::adjacent_find(trip.fixes, std::greater_equal{}, &GnssFix::t_s) ==
               trip.fixes.end(),
           "fixes rise");
    expect_accounted(trip,
                     {.acc = std::vector<std::uint8_t>(trip.acc.t_s.size()),
                      .gyro = std::vector<std::uint8_t>(trip.gyro.t_s.size()),
                      .speed = std::vector<std::uint8_t>(trip.speed.t_s.size()),
                      .fixes = std::vector<std::uint8_t>(trip.fixes.size())});
}

/// Accepted if there is a trip, and each of them is.
Answer read_all(const testing::WalkedTrips& search, const TripNeeds& needs) {
    auto answer = search.trips.empty() ? Answer::refused : Answer::accepted;
    for (const auto& source : search.trips) {
        answer = both(answer, may_refuse([&] { expect_sound(read_trip(source, needs)); }));
    }
    return answer;
}

/// The search, too, may refuse.
template <typename Search>
Answer read_all_of(Search search, const TripNeeds& needs = needs_of_import()) {
    auto answer = Answer::refused;
    may_refuse([&] { answer = read_all(search(), needs); });
    return answer;
}

/// A walk that stops after a few files gives as many trips as it counts.
void expect_counted(const std::filesystem::path& path) {
    const TripWalkConfig config{.tracks = true, .max_files = 3};
    TripWalk walk{path, config};
    expect(walk.files() == std::vector{path}, "a walk over a file reads that file");
    std::size_t trips = 0;
    while (walk.next()) {
        ++trips;
    }
    expect(walk.given() == trips && walk.count() == trips, "a walk counts its trips");
    expect(first_trip(path, config).count == trips, "every walk finds the same trips");
}

/// How trips of three tables lie in an archive: two of each trip, and one for all in a folder.
std::shared_ptr<const TripMapping> three_tables() {
    const auto table = [](std::string file, std::vector<ChannelMapping> channels) {
        TableMapping mapping;
        mapping.file = std::move(file);
        mapping.time.columns = {{.pattern = "t_s"}};
        mapping.channels = std::move(channels);
        return mapping;
    };
    const auto channel = [](TripColumn meant, std::string column) {
        return ChannelMapping{
            .channel = meant, .column = {.pattern = std::move(column)}, .invalid = {}};
    };
    TripMapping mapping;
    mapping.where = "mapping.toml";
    mapping.tables = {
        table("*_acc.csv", {channel(TripColumn::acc_z, "acc_z")}),
        table("*_gnss.csv", {channel(TripColumn::lat, "lat"), channel(TripColumn::lon, "lon")}),
        table("speed.csv", {channel(TripColumn::speed, "speed")})};
    return std::make_shared<const TripMapping>(std::move(mapping));
}

/// A table is of one of the loggers that are known.
Answer read_by_built_in_mappings(const std::filesystem::path& table) {
    auto answer = Answer::refused;
    for (const auto name : built_in_mapping_names()) {
        const auto mapping = std::make_shared<const TripMapping>(read_mapping(std::string{name}));
        answer = either(answer, read_all_of([&] { return testing::find_trips(table, mapping); }));
    }
    return answer;
}

/// A log has times to the microsecond; of two samples of a sensor in one, the later is lost. A fix
/// whose place is printed as 0, 0 is none.
bool can_be_told_apart(const TripLog& trip) {
    constexpr double min_s = 2e-6;
    const auto is_at_zero = [](const GnssFix& fix) {
        constexpr double printed_deg = 1e-8;
        return std::abs(fix.at.lat_deg) < printed_deg && std::abs(fix.at.lon_deg) < printed_deg;
    };
    if (std::ranges::any_of(trip.fixes, is_at_zero)) {
        return false;
    }
    const auto too_close = [](double a, double b) { return !(b - a >= min_s); };
    const auto are_apart = [&](const std::vector<double>& t_s) {
        return std::ranges::adjacent_find(t_s, too_close) == t_s.end();
    };
    return are_apart(trip.acc.t_s) && are_apart(trip.gyro.t_s) && are_apart(trip.speed.t_s) &&
           std::ranges::adjacent_find(trip.fixes, too_close, &GnssFix::t_s) == trip.fixes.end();
}

/// Our own writing is never refused.
TripLog read_written(const TripSource& source) {
    try {
        return read_trip(source, {.acc = true, .gyro = true, .speed = true, .fixes = true});
    } catch (const InputError& refusal) {
        throw std::logic_error{refusal.what()};
    }
}

/// What `import` may be asked for: the filter, of whole trips, of those of others, of which the
/// ends are hidden, and from lateral vibration alone; and the smoother, which takes a hundred times
/// as long.
std::vector<PipelineConfig> configs_of_import(bool with_smoother) {
    std::vector<PipelineConfig> configs(with_smoother ? 4 : 3);
    auto& of_others = configs[1];
    of_others.trim.min_m = 30;
    of_others.trim.random_m = 20;
    of_others.trim.hides_places = true;
    of_others.trim.draw = [](const std::string&, std::size_t) { return 0.5; };
    configs[2].estimator.channels = Channels::lateral;
    if (with_smoother) {
        configs[3].estimator.method = Method::smoother;
    }
    return configs;
}

void expect_sound(const TripResult& result) {
    expect(result.rows.read == result.rows.used + result.rows.rejected,
           "every row is either used or rejected");
    expect(result.matched_m >= 0 && result.distance_m >= 0, "a way has a length");
    for (const auto& pass : result.passes) {
        expect(pass.iri_um >= 0 && pass.sd_um >= 0, "an IRI is no less than 0");
    }
}

/// The input is a mapping, and below a line "=== NAME" the bytes of a file for it.
Answer read_by_own_mapping(std::string_view input, const std::string& name) {
    const auto mark = "=== " + name + "\n";
    const auto at = input.find(mark);
    auto answer = Answer::refused;
    if (at != std::string_view::npos) {
        may_refuse([&] {
            const auto mapping = std::make_shared<const TripMapping>(
                parse_mapping(input.substr(0, at), "mapping.toml"));
            const auto file = input_file(name, input.substr(at + mark.size()));
            answer = read_all(testing::find_trips(file, mapping), needs_of_match());
        });
    }
    return answer;
}

Answer read_as(const std::string& name, std::string_view input) {
    const TripSource source{.file = input_file(name, input), .member = {}};
    return may_refuse([&] {
        const auto trip = read_trip(source, needs_of_import());
        expect_sound(trip);
        expect(trip.sha256 == OpenTrip{source}.sha256(), "a trip has the hash of its content");
    });
}

} // namespace

Answer trip_log(std::string_view input) {
    for (const auto& needs : {needs_of_match(), needs_of_match_with_heading(), needs_of_trace()}) {
        may_refuse([&] {
            expect_sound(read_trip({.file = input_file("a.trip.csv", input), .member = {}}, needs));
        });
    }
    return read_as("a.trip.csv", input);
}

Answer trip_compressed(std::string_view input) {
    return read_as("a.trip.csv.gz", input); // what it is, the reader sees in its first bytes
}

Answer trip_archive(std::string_view input) {
    const bool is_zip = input.starts_with("PK");
    const auto file = input_file(is_zip ? "a.zip" : "a.tar.gz", input);
    expect_counted(file);
    const auto of_logs = read_all_of([&] { return testing::find_trips(file); });
    const auto of_phones = read_all_of([&] { return testing::find_trips(file.parent_path()); });
    const auto of_tables = read_all_of([&] { return testing::find_trips(file, three_tables()); });
    may_refuse([&] {
        expect(testing::find_trips(file.parent_path(), three_tables()).other_files == 1,
               "an archive under a folder holds no tables");
    });
    const auto of_tracks =
        read_all_of([&] { return testing::find_tracks(file); }, needs_of_match());
    return either(either(of_logs, of_phones), either(of_tables, of_tracks));
}

Answer trip_live(std::string_view input) {
    const auto file = input_file("a.trip.csv", input);
    return may_refuse([&] {
        TripFollower feed{file, needs_of_trace()};
        std::size_t rows = 0;
        while (const auto row = feed.next()) {
            expect(row->rows.size() == 1, "a row comes alone");
            expect(!feed.row_text().empty(), "a row can be quoted");
            ++rows;
        }
        expect(rows == feed.count(), "every row is counted");
    });
}

Answer rawlog(std::string_view input) {
    return read_as("a.rawlog", input);
}

Answer gpx(std::string_view input) {
    const TripSource source{.file = input_file("a.gpx", input), .member = {}};
    return may_refuse([&] {
        const auto trip = read_trip(source, needs_of_match());
        expect_sound(trip);
        expect(trip.sha256 == OpenTrip{source}.sha256(), "a trip has the hash of its content");
        for (const auto& way : trace_network(std::span{&trip, 1}, TraceConfig{})) {
            expect(way.line.size() == way.node_ids.size() && way.line.size() >= 2,
                   "every point of a way has its node");
        }
    });
}

Answer nmea(std::string_view input) {
    const TripSource source{.file = input_file("a.nmea", input), .member = {}};
    return may_refuse([&] {
        const auto trip = read_trip(source, needs_of_match());
        expect_sound(trip);
        expect(trip.sha256 == OpenTrip{source}.sha256(), "a trip has the hash of its content");
    });
}

Answer joined_trip(std::string_view input) {
    static constexpr std::array<std::string_view, 4> names{
        "a.trip.csv", "b.csv", "a.nmea", "a.gpx"};
    const auto folder = input_folder(names, input);
    return both(read_all_of([&] { return testing::find_trips(folder); }, needs_of_trace()),
                read_all_of([&] { return testing::find_trips(folder / "a.trip.csv"); }));
}

/// Reads a folder with a mapping and the logs that it is for.
Answer read_mapped_folder(std::span<const std::string_view> names, std::string_view input) {
    const auto folder = input_folder(names, input);
    auto answer = Answer::refused;
    may_refuse([&] {
        const auto mapping =
            std::make_shared<const TripMapping>(read_mapping(folder / "mapping.toml"));
        answer = read_all(testing::find_trips(folder, mapping), needs_of_match());
    });
    return answer;
}

Answer can_log(std::string_view input) {
    static constexpr std::array<std::string_view, 4> names{
        "mapping.toml", "car.dbc", "a.log", "a.asc"};
    return read_mapped_folder(names, input);
}

Answer mdf(std::string_view input) {
    static constexpr std::array<std::string_view, 3> names{"mapping.toml", "car.dbc", "a.mf4"};
    return read_mapped_folder(names, input);
}

Answer hdf5(std::string_view input) {
    return read_by_own_mapping(input, "a.h5");
}

Answer trip_written(std::string_view input) {
    const TripSource source{.file = input_file("a.trip.csv", input), .member = {}};
    return may_refuse([&] {
        const auto folder = source.file.parent_path();
        const TripSource first{.file = folder / "first.trip.csv", .member = {}};
        const TripSource second{.file = folder / "second.trip.csv.gz", .member = {}};
        const auto trip = read_trip(source, needs_of_import());
        if (!can_be_told_apart(trip)) {
            return;
        }
        write_trip(trip, first.file);
        const auto again = read_written(first);
        expect_sound(again);
        write_trip(again, second.file);
        expect(OpenTrip{first}.sha256() == OpenTrip{second}.sha256(),
               "what was written once is written so again");
    });
}

Answer phone_export(std::string_view input) {
    static constexpr std::array<std::string_view, 12> names{"Accelerometer.csv",
                                                            "Acceleration.csv",
                                                            "Linear Acceleration.csv",
                                                            "TotalAcceleration.csv",
                                                            "AccelerometerUncalibrated.csv",
                                                            "Gravity.csv",
                                                            "Gyroscope.csv",
                                                            "Location.csv",
                                                            "Metadata.csv",
                                                            "meta/time.csv",
                                                            "inner/Accelerometer.csv",
                                                            "inner/Location.csv"};
    const auto folder = input_folder(names, input);
    return read_all_of([&] { return testing::find_trips(folder); });
}

Answer log_detection(std::string_view input) {
    const auto file = input_file("a.csv", input);
    auto answer = Answer::refused;
    may_refuse([&] {
        const auto log = detect_log(file);
        if (!log) {
            return;
        }
        answer = Answer::accepted;
        try { // what is written is read
            if (log->time) {
                parse_mapping(mapping_toml(*log, Confidence::likely, "*.csv"), "detected");
            }
        } catch (const InputError& refusal) {
            throw std::logic_error{refusal.what()};
        }
        const auto mapping = sure_mapping(*log);
        if (mapping) {
            const TripSource source{
                .file = file, .member = {}, .files = {"a.csv"}, .mapping = mapping};
            may_refuse([&] { expect_sound(read_trip(source, needs_of_match())); });
        }
    });
    return answer;
}

Answer mapped_trip(std::string_view input) {
    static constexpr std::array<std::string_view, 3> names{
        "mapping.toml", "a_acc.csv", "a_gnss.csv"};
    const auto folder = input_folder(names, input);
    if (!std::filesystem::exists(folder / "mapping.toml")) {
        return read_by_built_in_mappings(folder / "a_acc.csv");
    }
    std::shared_ptr<const TripMapping> mapping;
    const auto answer = may_refuse([&] {
        mapping = std::make_shared<const TripMapping>(read_mapping(folder / "mapping.toml"));
    });
    if (answer == Answer::refused) {
        return answer;
    }
    return both(read_all_of([&] { return testing::find_trips(folder / "a_acc.csv", mapping); }),
                read_all_of([&] { return testing::find_trips(folder, mapping); }));
}

Answer trip_trace(std::string_view input) {
    constexpr std::size_t short_log = 4096; // of some seconds
    const TripSource source{.file = input_file("a.trip.csv", input), .member = {}};
    return may_refuse([&] {
        const auto trip = read_trip(source, needs_of_import());
        const auto& car = *built_in_vehicle("generic");
        const auto trace = trace_of(trip, motion_of(trip), car, {});
        expect_accounted(trip, trace.use);
        const auto roads = build_network(trace_network(std::span{&trip, 1}, TraceConfig{}));
        for (const auto& config : configs_of_import(input.size() < short_log)) {
            may_refuse([&] { expect_sound(passes_of(trip, car, roads, config)); });
        }
    });
}

} // namespace macadam::fuzz
