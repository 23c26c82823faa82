#pragma once

#include "app/cli/commands.hpp"

namespace macadam {

extern const Command serve_command; // app/serve/command_serve.cpp

} // namespace macadam
