#include "app/cli/row_output.hpp"
#include "app/cli/server_commands.hpp"
#include "app/cli/text_table.hpp"
#include "app/jobs/job_options.hpp"

#include "estimator/common/exact_number.hpp"
#include "storage/postgres/server_address.hpp"
#include "storage/store/server/cells/cell_moves.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace macadam {
namespace {

const Columns<MapCell> cell_columns{
    {"cell", as::integer, [](auto& c) { return std::int64_t{c.number}; }, {"cell", "{:>5}"}},
    {"segments", as::integer, [](auto& c) { return c.segments; }, {"segments", " {:>9}"}},
    {"server",
     as::text,
     [](auto& c) { return known_if(!c.connection.empty(), c.connection); },
     {"server", "  {}"}},
};

std::vector<std::int32_t> cells_to_move(const Arguments& arguments) {
    std::vector<std::int32_t> cells;
    for (const auto& word : arguments.values("--move")) {
        const auto cell = exact_number<std::int32_t>(word);
        if (!cell) {
            throw UsageError{fmt::format("--move has {}, expected numbers of cells, as 'macadam "
                                         "cells STORE' lists them",
                                         in_quotes(word))};
        }
        cells.push_back(*cell);
    }
    if (cells.empty() == arguments.is_given("--to")) {
        throw UsageError{cells.empty() ? "--to is without --move, expected both: which cells go "
                                         "there"
                                       : "--move is without --to, expected both: where the cells "
                                         "go"};
    }
    return cells;
}

/// Address in --to.
std::string target_of(const Arguments& arguments) {
    const auto address = arguments.value("--to").value_or("");
    if (!is_server_address(address)) {
        throw UsageError{fmt::format("--to is {}, expected postgresql://USER@HOST/DATABASE",
                                     in_quotes(address))};
    }
    try {
        expect_address_without_secrets(address);
    } catch (const InputError& error) {
        throw UsageError{error.what()};
    }
    return address;
}

void run_cells(const Arguments& arguments, const Console& console) {
    const auto address = server_of(arguments);
    const auto cells = cells_to_move(arguments);
    const auto to = cells.empty() ? std::string{} : target_of(arguments);
    auto server = opened_server(address);
    const auto progress = console.progress("moving cells");
    for (std::size_t i = 0; i < cells.size() && !progress.stop.stop_requested(); ++i) {
        progress(i, cells.size());
        const auto rows = move_cell(server, cells[i], to);
        console.say(fmt::format("cell {}: {} moved to {}",
                                cells[i],
                                counted(static_cast<std::size_t>(rows), "row"),
                                to));
    }
    const auto all = cells_of(server);
    if (arguments.flag("--json")) {
        print(json_rows(cell_columns, all));
    } else {
        print_words(table_text(cell_columns, all));
    }
}

constexpr std::array operands{server_operand};
constexpr std::array options{
    Option{.name = "--move",
           .value = "CELL",
           .help = "Move these cells to the server of --to.",
           .many = true},
    Option{"--to", "ADDRESS", "An empty database on another server; that of STORE: back to it."},
    Option{"--json", "", "Print the list as JSON."}};

} // namespace

const Command cells_command{
    .name = "cells",
    .summary = "Spread a database over several PostgreSQL servers",
    .about =
        "Lists the cells of a database (map tiles of zoom 8) and the servers that hold their "
        "drives and fused values.\n"
        "Cells move while the database is in use: only importers that write to a cell wait for "
        "its move, which compares\n"
        "both sides. Addresses of programs and the digest stay. A superuser of the server adds "
        "another one\n"
        "(docs/cluster.md).",
    .example = "  macadam cells postgresql://me@db.example.org/roads\n"
               "  macadam cells postgresql://postgres@db.example.org/roads --move 34521 "
               "--to postgresql://me@east.example.org/roads",
    .operands = operands,
    .options = options,
    .run = run_cells};

} // namespace macadam
