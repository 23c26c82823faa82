#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "app/pipeline/pipeline.hpp"

#include <filesystem>

namespace macadam {

/// `trace --live`: the rows of a trip while its log is being written, each as soon as it is known.
///
/// \param trip  "-": standard input.
///
/// \throws InputError  for what the reader of trips refuses, too, as it comes.
void trace_live(const std::filesystem::path& trip,
                const PipelineConfig& config,
                double length_m,
                bool json,
                const Arguments& arguments,
                const Console& console);

} // namespace macadam
