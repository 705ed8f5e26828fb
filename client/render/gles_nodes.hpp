// The nodes on the GPU: a vertex array and buffers for each ResidentNode, keyed by its id; the colours as
// they are painted. Nodes that are not drawn are kept while there is room, least recently drawn first to go.
#pragma once

#include "client/render/gles_objects.hpp"
#include "client/render/raster_setup.hpp"

#include <cstdint>
#include <unordered_map>

namespace stipple::gles {

// Locations of points.vert.glsl.
enum PointAttribute : GLuint {
    positionLocation = 0,
    positionLowLocation = 1,
    colourLocation = 2,
    normalLocation = 3
};

class NodeBuffers {
  public:
    // Binds the node's vertex array, uploading what is missing. Colours are held for one paint of a node at a
    // time.
    void bind(const DrawNode& drawn);

    // Ends a frame: frees nodes that bind() has not seen in it until all take at most `limitBytes`. A frame
    // without nodes frees everything. Returns whether something was uploaded since the last call.
    bool endFrame(std::uint64_t limitBytes);

    std::uint64_t bytes() const { return bytes_; }

  private:
    struct Entry {
        VertexArray array;
        Buffer positions, lows, colours, normals;
        std::uint64_t colourId = 0; // DrawNode::colourId of what `colours` holds
        std::uint64_t colourBytes = 0;
        std::uint64_t normalsId = 0; // NodeNormals::id of what `normals` holds; 0: nothing
        std::uint64_t normalBytes = 0;
        std::uint64_t bytes = 0;
        std::uint64_t lastFrame = 0;
    };

    bool upload(Entry& entry, Buffer& buffer, const std::vector<std::uint32_t>& values);
    void bindColours(Entry& entry, const DrawNode& drawn);
    void bindNormals(Entry& entry, const DrawNode& drawn);

    std::unordered_map<std::uint64_t, Entry> entries_;
    std::uint64_t bytes_ = 0;
    std::uint64_t frame_ = 1;
    std::uint64_t boundInFrame_ = 0;
    bool uploaded_ = false;
};

} // namespace stipple::gles
