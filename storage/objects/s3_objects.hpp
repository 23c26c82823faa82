#pragma once

#include "storage/objects/object_store.hpp"
#include "storage/objects/s3_settings.hpp"

#include <memory>
#include <stop_token>

namespace macadam {

/// Opens a bucket as an object store: object `abcd...` is `PREFIX/ab/cd/abcd...`. Requests are
/// signed, and tried five times in some seconds if the service cannot be reached, is busy or fails.
/// Memory does not depend on the size of objects.
std::unique_ptr<ObjectStore> open_s3_objects(S3Settings settings, std::stop_token stop);

} // namespace macadam
