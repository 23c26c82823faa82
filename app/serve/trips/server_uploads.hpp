#pragma once

#include "app/serve/trips/upload_place.hpp"

#include <memory>
#include <string>

namespace macadam {

/// Place of tokens and uploads of a database on a server: tokens in its table, logs in its object
/// store and its queue, where `macadam worker` finds them. Null if the role may not read tokens, as
/// readers may not.
///
/// \param is_open  also without a token, for staff
/// \throws InputError  if the server cannot be reached.
std::unique_ptr<UploadPlace> uploads_on_server(const std::string& address, bool is_open);

} // namespace macadam
