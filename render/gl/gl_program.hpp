#pragma once

#include "render/gl/gl_context.hpp"

namespace macadam {

/// A program of one vertex and one fragment shader; it lives as long as the context.
///
/// \throws InputError  if OpenGL refuses a shader, with what it says of it.
unsigned
linked_program(const GlContext& context, const char* vertex_shader, const char* fragment_shader);

} // namespace macadam
