#pragma once

#include "app/cli/commands.hpp"

namespace macadam {

extern const Command cells_command;  // app/jobs/command_cells.cpp
extern const Command copy_command;   // app/store/command_copy.cpp
extern const Command serve_command;  // app/serve/command_serve.cpp
extern const Command status_command; // app/jobs/command_status.cpp
extern const Command submit_command; // app/jobs/command_submit.cpp
extern const Command token_command;  // app/uploads/command_token.cpp
extern const Command worker_command; // app/uploads/command_worker.cpp

} // namespace macadam
