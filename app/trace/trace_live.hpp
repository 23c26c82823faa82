#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "app/pipeline/pipeline.hpp"

#include <filesystem>

namespace macadam {

/// Runs `trace --live`: prints the rows of a trip while its log is being written, each as soon as
/// it is known.
///
/// \param trip         "-": standard input
/// \throws InputError  also for errors of the trip reader, as they occur.
void trace_live(const std::filesystem::path& trip,
                const PipelineConfig& config,
                double length_m,
                bool json,
                const Arguments& arguments,
                const Console& console);

} // namespace macadam
