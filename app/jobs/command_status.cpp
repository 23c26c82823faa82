#include "app/cli/row_output.hpp"
#include "app/cli/server_commands.hpp"
#include "app/jobs/job_options.hpp"
#include "app/jobs/status_output.hpp"

#include "storage/jobs/work_status.hpp"

#include <array>

namespace macadam {
namespace {

void run_status(const Arguments& arguments, const Console&) {
    const auto format = row_format_of(arguments);
    const auto row_file = row_file_of(arguments);
    auto server = opened_server(server_of(arguments));
    const auto status = work_status(server, max_shown_failures);
    RowOutput output{row_file};
    if (format == "json") {
        print(status_json(status) + "\n");
    } else if (format == "prometheus") {
        print(status_metrics(status));
    } else {
        print_words(status_text(status));
    }
    output.commit();
}

constexpr std::array operands{server_operand};
constexpr std::array options{
    one_of("table|json|prometheus",
           {"--format", "FORMAT", "table, json, or prometheus: counts for a monitor.", "table"}),
    row_output_option,
    json_option};

} // namespace

const Command status_command{
    .name = "status",
    .summary = "Tell what waits for the workers of a database, and what failed",
    .about = "Counts the submitted logs by state; tells for how long the oldest waits, how many "
             "were finished lately, which\n"
             "workers live, and the last logs that were refused, or parked after five attempts, "
             "with the reasons. To try\n"
             "these again, submit them again; parked ones by 'macadam submit STORE --again'.",
    .example = "  macadam status postgresql://me@db.example.org/roads\n"
               "  macadam status postgresql://me@db.example.org/roads --format prometheus "
               "-o /var/lib/node_exporter/macadam.prom",
    .operands = operands,
    .options = options,
    .run = run_status};

} // namespace macadam
