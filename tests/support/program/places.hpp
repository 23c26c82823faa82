#pragma once

#include <string>

namespace macadam::testing {

// Where the tests find things. One file alone is compiled with these places, so that a compiler
// cache knows all others in any folder.

/// Folder of the sources, which has tests/data and sample_data.
const std::string& source_folder();

/// The built program.
const std::string& program_file();

} // namespace macadam::testing
