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
    return {ErrorCode::unsupported,
            log.empty() ? say(what, ": the driver gives no reason") : say(what, ": ", log), "OpenGL ES 3.0",
            say("update the graphics driver")};
}

// Has it compiled, and attaches it; the program keeps the shader alive from there.
void attachShader(GLuint program, GLenum kind, const std::string& defines, const char* text) {
    GLuint shader = glCreateShader(kind);
    std::string head = "#version 300 es\n" + defines;
    std::array<const GLchar*, 2> texts{head.c_str(), text};
    glShaderSource(shader, static_cast<GLsizei>(texts.size()), texts.data(), nullptr);
    glCompileShader(shader);
    glAttachShader(program, shader);
    glDeleteShader(shader);
}

Status shaderStatus(GLuint shader) {
    GLint compiled = GL_FALSE, kind = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (compiled)
        return {};
    glGetShaderiv(shader, GL_SHADER_TYPE, &kind);
    return shaderError(kind == GL_VERTEX_SHADER ? "a vertex shader does not compile"
                                                : "a fragment shader does not compile",
                       logOf(shader, glGetShaderiv, glGetShaderInfoLog));
}

} // namespace

Program startProgram(const std::string& defines, const char* vertexText, const char* fragmentText,
                     const char* captured) {
    Program program;
    GLuint id = program.make();
    attachShader(id, GL_VERTEX_SHADER, defines, vertexText);
    attachShader(id, GL_FRAGMENT_SHADER, defines, fragmentText);
    if (captured != nullptr)
        glTransformFeedbackVaryings(id, 1, &captured, GL_INTERLEAVED_ATTRIBS);
    glLinkProgram(id);
    return program;
}

Status checkProgram(const Program& program) {
    GLint linked = GL_FALSE;
    glGetProgramiv(program.id(), GL_LINK_STATUS, &linked);
    if (linked)
        return {};
    std::array<GLuint, 2> shaders{};
    GLsizei count = 0;
    glGetAttachedShaders(program.id(), static_cast<GLsizei>(shaders.size()), &count, shaders.data());
    for (GLsizei i = 0; i < count; ++i)
        STIPPLE_CHECK(shaderStatus(shaders[static_cast<std::size_t>(i)]));
    return shaderError("a shader program does not link",
                       logOf(program.id(), glGetProgramiv, glGetProgramInfoLog));
}

Result<Program> makeProgram(const std::string& defines, const char* vertexText, const char* fragmentText,
                            const char* captured) {
    Program program = startProgram(defines, vertexText, fragmentText, captured);
    STIPPLE_CHECK(checkProgram(program));
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
        return Error{ErrorCode::limitExceeded, say("graphics memory ran out while ", doing), "OpenGL ES 3.0",
                     say("lower the point budget")};
    char code[16];
    std::snprintf(code, sizeof code, "0x%04X", first);
    return Error{ErrorCode::ioFailed, say("OpenGL error ", code, " while ", doing), "OpenGL ES 3.0", ""};
}

} // namespace stipple::gles
