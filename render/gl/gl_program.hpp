#pragma once

#include "render/gl/gl_context.hpp"

namespace macadam {

/// Links a program of one vertex and one fragment shader; it lives as long as the context.
///
/// \throws InputError  if OpenGL rejects a shader, with its message.
unsigned
linked_program(const GlContext& context, const char* vertex_shader, const char* fragment_shader);

} // namespace macadam
