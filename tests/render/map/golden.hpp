#pragma once

#include "render/scene/scene.hpp"

#include <functional>
#include <string>

namespace macadam::testing {

// Pictures that were looked at and found good, kept in tests/data/golden. They are held byte for
// byte: with one Mesa, and where they have text one FreeType, one HarfBuzz and their fonts,
// pictures are the same on every machine.

inline constexpr const char* golden_mesa = "Mesa 22.3.6"; // Debian 12's, which drew them

/// What Mesa says of its version.
std::string mesa();

/// The picture of that name.
Image golden(const std::string& name);

/// Leaves what was drawn in the folder of MACADAM_LEAVE_PICTURES, if that is set, so that it can be
/// looked at, and kept if it is better.
void leave(const std::string& name, const Image& image);

/// Expects the same picture from OSMesa and from EGL, or, where Mesa has no OSMesa (from
/// version 25.1 on), that a request for it is refused by its name.
void expect_same_by_both_libraries(const std::string& name, const std::function<Image()>& draw);

/// In levels of 255; 256 of pictures of different sizes.
int max_difference(const Image& a, const Image& b);
double mean_difference(const Image& a, const Image& b);

} // namespace macadam::testing
