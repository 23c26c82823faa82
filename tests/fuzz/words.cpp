#include "fuzz/rules.hpp"
#include "fuzz/targets.hpp"

#include "app/cli/commands.hpp"
#include "app/config/user_defaults.hpp"
#include "app/database/period_options.hpp"
#include "app/database/segment_options.hpp"
#include "app/pipeline/estimation_options.hpp"
#include "app/query/query_options.hpp"
#include "app/query/section_options.hpp"
#include "mapping/network/segment.hpp"
#include "storage/geopackage/geopackage.hpp"
#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/text/utc.hpp"
#include "support/roads/store_world.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <string>
#include <vector>

namespace macadam::fuzz {
namespace {

std::vector<std::string> lines_of(std::string_view text) {
    std::vector<std::string> lines;
    for (std::size_t begin = 0; begin <= text.size();) {
        const auto end = std::min(text.find('\n', begin), text.size());
        lines.emplace_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return lines;
}

/// Every value read in every way in which a command could ask for it.
void ask_for_everything(const Command& command, const Arguments& arguments) {
    for (const auto& option : command.options) {
        const auto name = option.name.substr(option.name.rfind(',') + 1);
        arguments.flag(name);
        arguments.values(name);
        may_refuse<UsageError>([&] { arguments.number(name); });
        may_refuse<UsageError>([&] { arguments.integer(name); });
        if (!option.choices.empty()) {
            const auto choice = arguments.choice(name);
            expect(std::ranges::find(arguments.choices(name), choice) !=
                       arguments.choices(name).end(),
                   "a choice is one of the table's");
        }
        may_refuse<UsageError>([&] {
            if (const auto degrees = arguments.numbers(name, 4)) {
                const auto box = box_of(*degrees);
                expect(!is_empty(box), "a box that is taken holds a place");
            }
        });
    }
    for (const auto& operand : command.operands) {
        expect(operand.optional || !arguments.operands(operand.name).empty(),
               "every operand that may not be left out has a word");
    }
}

/// As the command itself would, where that can be asked for alone.
void parse_as(const Command& command, const Arguments& arguments) {
    const auto takes = [&](std::string_view name) {
        return std::ranges::find(command.options, name, &Option::name) != command.options.end();
    };
    if (command.name == "query" && !arguments.value("--area")) { // which names a file to read
        parse_query(arguments);
    } else if (takes(sections_option.name)) {
        parse_sections(arguments, false);
    }
    if (takes(rate_option.name)) {
        pipeline_config_of(arguments);
    }
    if (takes(until_option.name)) {
        parse_period(arguments);
    }
    if (takes(since_option.name)) {
        parse_begin(arguments, since_option.name);
    }
    if (std::ranges::find(command.operands, store_operand.name, &Operand::name) !=
        command.operands.end()) {
        store_file(arguments);
    }
}

/// The functions that a database's triggers call say of a geometry what the program says.
void expect_same_in_sql(std::string_view geometry) {
    static Database database{"geometry", Database::Access::memory};
    static const bool has_functions = [] {
        add_geometry_functions(database);
        return true;
    }();
    expect(has_functions, "SQL has the functions");
    auto select = database.prepare("SELECT ST_IsEmpty(?1), ST_MinX(?1), ST_MinY(?1), ST_MaxX(?1),"
                                   " ST_MaxY(?1)");
    select.bind(Blob{geometry}).step();
    const auto box = box_of_geometry(geometry);
    expect(select.is_null(1) == !box && (select.integer(0) != 0) == !box,
           "what has no box is empty");
    const auto is_at = [&](int column, double deg) { // SQL has no number for what is none
        return std::isnan(deg) ? select.is_null(column) : select.real(column) == deg;
    };
    expect(!box || (is_at(1, box->west_deg) && is_at(2, box->south_deg) &&
                    is_at(3, box->east_deg) && is_at(4, box->north_deg)),
           "a geometry has one box");
}

/// The segments of an edge lie on it one after the other, and so does the one that is asked for.
void expect_in_place(const RoadNetwork& roads, EdgeId edge, const SegmentKey& key) {
    const auto segments = segments_of(roads, edge);
    const auto found = std::ranges::find(segments, key, &Segment::key);
    if (found == segments.end()) {
        return;
    }
    expect(found->from_m < found->to_m && found->line.size() >= 2, "a segment has a length");
    expect(found == segments.begin() || std::prev(found)->line.back() == found->line.front(),
           "a segment begins where the one before it ends");
    const auto whole = line_on(roads, edge, 0, length_m(roads, edge));
    expect(whole.front() == segments.front().line.front() &&
               whole.back() == segments.back().line.back(),
           "segments are all of their edge");
}

} // namespace

Answer geometry_blob(std::string_view input) {
    const auto line = line_of_geometry(input);
    expect_same_in_sql(input);
    const bool has_numbers = std::ranges::none_of(
        line, [](const auto& at) { return std::isnan(at.lat_deg) || std::isnan(at.lon_deg); });
    if (has_numbers) {
        expect(line_of_geometry(geometry_of(line)) == line,
               "a line is the same after one more trip");
        const auto box = box_of_geometry(geometry_of(line));
        expect(box.has_value(), "a geometry has a box");
        expect(std::ranges::all_of(line, [&](const auto& at) { return contains(*box, at); }),
               "a box holds its line");
    }
    return line.empty() ? Answer::refused : Answer::accepted;
}

Answer segment_key(std::string_view input) {
    return may_refuse([&] {
        const auto key = parse_segment_key(input);
        expect(parse_segment_key(name_of(key)) == key, "a key is the same after one more trip");
        static const auto roads = testing::small_country();
        for (const auto edge : drivable_edges(roads)) {
            expect_in_place(roads, edge, key);
        }
    });
}

Answer utc_time(std::string_view input) {
    const auto utc_s = parse_utc_s(input);
    if (utc_s) {
        constexpr double half_ms = 0.5e-3;
        const auto again = parse_utc_s(utc_text(std::llround(*utc_s * 1000)));
        expect(again && std::abs(*again - *utc_s) <= half_ms + 1e-6,
               "a time is the same to the ms");
    }
    return utc_s ? Answer::accepted : Answer::refused;
}

Answer command_line(std::string_view input) {
    auto words = lines_of(input);
    const auto* const command = command_named(words.front());
    if (command == nullptr) {
        return Answer::refused;
    }
    words.erase(words.begin());
    return may_refuse<UsageError>([&] {
        const Arguments arguments{command->options, command->operands, std::move(words)};
        ask_for_everything(*command, arguments);
        parse_as(*command, arguments);
    });
}

Answer config_toml(std::string_view input) {
    return may_refuse([&] {
        const auto config = parse_toml(input, "config.toml");
        for (const auto& command : commands()) {
            for (const auto& each : config_defaults(config, "/home", command)) {
                auto key = each.option.substr(2);
                std::ranges::replace(key, '-', '_');
                const auto preference = preferences().find(key);
                expect(preference != preferences().end(), "a default is of a preference");
                const auto& choices = preference->second.choices;
                expect(choices.empty() || choice_among(choices, each.value) == each.value,
                       "a default is one of the choices");
            }
        }
    });
}

} // namespace macadam::fuzz
