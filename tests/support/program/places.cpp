#include "support/program/places.hpp"

namespace macadam::testing {

const std::string& source_folder() {
    static const std::string folder{MACADAM_SOURCE_DIR};
    return folder;
}

const std::string& program_file() {
    static const std::string file{MACADAM_PROGRAM};
    return file;
}

} // namespace macadam::testing
