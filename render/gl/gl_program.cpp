#include "render/gl/gl_program.hpp"

#include "estimator/common/error.hpp"

#include <GL/gl.h>
#include <GL/glext.h>
#include <fmt/core.h>

#include <string>
#include <utility>

namespace macadam {

unsigned
linked_program(const GlContext& context, const char* vertex_shader, const char* fragment_shader) {
    const auto create_shader = context.entry<PFNGLCREATESHADERPROC>("glCreateShader");
    const auto shader_source = context.entry<PFNGLSHADERSOURCEPROC>("glShaderSource");
    const auto compile_shader = context.entry<PFNGLCOMPILESHADERPROC>("glCompileShader");
    const auto attach_shader = context.entry<PFNGLATTACHSHADERPROC>("glAttachShader");
    const auto delete_shader = context.entry<PFNGLDELETESHADERPROC>("glDeleteShader");

    const GLuint made = context.entry<PFNGLCREATEPROGRAMPROC>("glCreateProgram")();
    for (const auto& [kind, source] : {std::pair{GL_VERTEX_SHADER, vertex_shader},
                                       std::pair{GL_FRAGMENT_SHADER, fragment_shader}}) {
        const GLuint shader = create_shader(GLenum(kind));
        shader_source(shader, 1, &source, nullptr);
        compile_shader(shader);
        attach_shader(made, shader);
        delete_shader(shader); // kept alive by the program
    }
    context.entry<PFNGLLINKPROGRAMPROC>("glLinkProgram")(made);
    GLint linked = GL_FALSE;
    context.entry<PFNGLGETPROGRAMIVPROC>("glGetProgramiv")(made, GL_LINK_STATUS, &linked);
    if (linked != GL_TRUE) {
        std::string log(1000, '\0');
        GLsizei length = 0;
        context.entry<PFNGLGETPROGRAMINFOLOGPROC>("glGetProgramInfoLog")(
            made, GLsizei(log.size()), &length, log.data());
        throw InputError{fmt::format("OpenGL refuses a shader: {}", log.substr(0, length))};
    }
    return made;
}

} // namespace macadam
