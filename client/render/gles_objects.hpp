// OpenGL objects that free themselves, and programs from shader texts. All need their context current, from
// construction to destruction.
#pragma once

#include "shared/base/result.hpp"

#include <GLES3/gl3.h>

#include <string>
#include <utility>

namespace stipple::gles {

struct BufferKind {
    static void create(GLuint* id) { glGenBuffers(1, id); }
    static void destroy(GLuint id) { glDeleteBuffers(1, &id); }
};
struct TextureKind {
    static void create(GLuint* id) { glGenTextures(1, id); }
    static void destroy(GLuint id) { glDeleteTextures(1, &id); }
};
struct VertexArrayKind {
    static void create(GLuint* id) { glGenVertexArrays(1, id); }
    static void destroy(GLuint id) { glDeleteVertexArrays(1, &id); }
};
struct FramebufferKind {
    static void create(GLuint* id) { glGenFramebuffers(1, id); }
    static void destroy(GLuint id) { glDeleteFramebuffers(1, &id); }
};
struct ProgramKind {
    static void create(GLuint* id) { *id = glCreateProgram(); }
    static void destroy(GLuint id) { glDeleteProgram(id); }
};

// Empty until make(); movable.
template <class Kind>
class Object {
  public:
    Object() = default;
    Object(Object&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
    Object& operator=(Object&& other) noexcept {
        std::swap(id_, other.id_);
        return *this;
    }
    ~Object() {
        if (id_)
            Kind::destroy(id_);
    }
    GLuint make() {
        if (!id_)
            Kind::create(&id_);
        return id_;
    }
    GLuint id() const { return id_; }
    explicit operator bool() const { return id_ != 0; }

  private:
    GLuint id_ = 0;
};

using Buffer = Object<BufferKind>;
using Texture = Object<TextureKind>;
using VertexArray = Object<VertexArrayKind>;
using Framebuffer = Object<FramebufferKind>;
using Program = Object<ProgramKind>;

// Has it compiled and linked, and waits for neither: drivers, and browsers' processes, do that beside.
// `defines`
// ("#define CIRCLE\n…") goes between the "#version 300 es" line and the texts. `captured`: an output of the
// vertex shader for transform feedback; nullptr: none.
Program startProgram(const std::string& defines, const char* vertexText, const char* fragmentText,
                     const char* captured = nullptr);
// Waits for it. Error: unsupported, with the driver's log.
Status checkProgram(const Program& program);
// Both.
Result<Program> makeProgram(const std::string& defines, const char* vertexText, const char* fragmentText,
                            const char* captured = nullptr);

// The first pending GL error as an error (limitExceeded if out of memory), or success; clears all of them.
// `doing`: "uploading node 3-1-2-0".
Status checkGl(const char* doing);

} // namespace stipple::gles
