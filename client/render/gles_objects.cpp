#include "client/render/gles_objects.hpp"

#include "shared/base/text.hpp"

#include <array>

namespace stipple::gles {
namespace {

std::string logOf(GLuint id, void (*length)(GLuint, GLenum, GLint*),
                  void (*read)(GLuint, GLsizei, GLsizei*, GLchar*)) {
    GLint size = 0;
    length(id, GL_INFO_LOG_LENGTH, &size);
    std::string log(static_cast<std::size_t>(size > 0 ? size : 0), '\0');
    if (!log.empty())
        read(id, size, nullptr, log.data());
    while (!log.empty() && (log.back() == '\0' || log.back() == '\n'))
        log.pop_back();
    return log;
}

Error shaderError(const char* what, const std::string& log) {
    return {ErrorCode::unsupported, cat(what, ": ", log.empty() ? "the driver gives no reason" : log),
            "OpenGL ES 3.0", "update the graphics driver"};
}

// Compiles and attaches; the program keeps the shader alive from there.
Status attachShader(GLuint program, GLenum kind, const std::string& defines, const char* text) {
    GLuint shader = glCreateShader(kind);
    std::string head = "#version 300 es\n" + defines;
    std::array<const GLchar*, 2> texts{head.c_str(), text};
    glShaderSource(shader, static_cast<GLsizei>(texts.size()), texts.data(), nullptr);
    glCompileShader(shader);
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    Status status;
    if (compiled)
        glAttachShader(program, shader);
    else
        status = shaderError(kind == GL_VERTEX_SHADER ? "a vertex shader does not compile"
                                                      : "a fragment shader does not compile",
                             logOf(shader, glGetShaderiv, glGetShaderInfoLog));
    glDeleteShader(shader);
    return status;
}

} // namespace

Result<Program> makeProgram(const std::string& defines, const char* vertexText, const char* fragmentText,
                            const char* captured) {
    Program program;
    GLuint id = program.make();
    STIPPLE_CHECK(attachShader(id, GL_VERTEX_SHADER, defines, vertexText));
    STIPPLE_CHECK(attachShader(id, GL_FRAGMENT_SHADER, defines, fragmentText));
    if (captured != nullptr)
        glTransformFeedbackVaryings(id, 1, &captured, GL_INTERLEAVED_ATTRIBS);
    glLinkProgram(id);
    GLint linked = GL_FALSE;
    glGetProgramiv(id, GL_LINK_STATUS, &linked);
    if (!linked)
        return shaderError("a shader program does not link", logOf(id, glGetProgramiv, glGetProgramInfoLog));
    return program;
}

Status checkGl(const char* doing) {
    GLenum first = glGetError();
    if (first == GL_NO_ERROR)
        return {};
    // Some drivers keep one error a queue; a lost context reports for ever, hence the bound.
    for (int i = 0; i < 16 && glGetError() != GL_NO_ERROR; ++i) {
    }
    if (first == GL_OUT_OF_MEMORY)
        return Error{ErrorCode::limitExceeded, cat("graphics memory ran out while ", doing), "OpenGL ES 3.0",
                     "lower the point budget"};
    char code[16];
    std::snprintf(code, sizeof code, "0x%04X", first);
    return Error{ErrorCode::ioFailed, cat("OpenGL error ", code, " while ", doing), "OpenGL ES 3.0", ""};
}

} // namespace stipple::gles
