#include "client/render/gles_nodes.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace stipple::gles {

// Fills `buffer` with `values` unless it is filled already, and leaves it bound. False: nothing to do.
bool NodeBuffers::upload(Entry& entry, Buffer& buffer, const std::vector<std::uint32_t>& values) {
    if (buffer || values.empty())
        return false;
    std::uint64_t size = values.size() * sizeof values[0];
    glBindBuffer(GL_ARRAY_BUFFER, buffer.make());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(size), values.data(), GL_STATIC_DRAW);
    entry.bytes += size;
    bytes_ += size;
    uploaded_ = true;
    return true;
}

void NodeBuffers::bind(const DrawNode& drawn) {
    const ResidentNode& node = *drawn.node;
    Entry& entry = entries_[node.id];
    entry.lastFrame = frame_;
    ++boundInFrame_;
    glBindVertexArray(entry.array.make());
    if (upload(entry, entry.positions, node.positionWords)) {
        glEnableVertexAttribArray(positionLocation);
        glVertexAttribIPointer(positionLocation, 2, GL_UNSIGNED_INT, 0, nullptr);
    }
    if (upload(entry, entry.lows, node.positionLowWords)) {
        glEnableVertexAttribArray(positionLowLocation);
        glVertexAttribIPointer(positionLowLocation, 1, GL_UNSIGNED_INT, 0, nullptr);
    }
    if (entry.colourId != drawn.colourId())
        bindColours(entry, drawn);
    if (entry.normalsId != (drawn.normals ? drawn.normals->id : 0))
        bindNormals(entry, drawn);
}

void NodeBuffers::bindColours(Entry& entry, const DrawNode& drawn) {
    bytes_ -= entry.colourBytes;
    entry.bytes -= entry.colourBytes;
    entry.colours = Buffer();
    entry.colourId = drawn.colourId();
    const std::vector<std::uint32_t>& words = drawn.colourWords();
    entry.colourBytes = words.size() * sizeof words[0];
    if (upload(entry, entry.colours, words)) {
        glEnableVertexAttribArray(colourLocation);
        glVertexAttribPointer(colourLocation, 4, GL_UNSIGNED_BYTE, GL_TRUE, 0, nullptr);
    } else {
        glDisableVertexAttribArray(colourLocation); // plain
    }
}

// Those of a node that is no longer drawn as discs go.
void NodeBuffers::bindNormals(Entry& entry, const DrawNode& drawn) {
    bytes_ -= entry.normalBytes;
    entry.bytes -= entry.normalBytes;
    entry.normals = Buffer();
    entry.normalsId = drawn.normals ? drawn.normals->id : 0;
    entry.normalBytes = drawn.normals ? 4 * drawn.normals->words.size() : 0;
    if (drawn.normals && upload(entry, entry.normals, drawn.normals->words)) {
        glEnableVertexAttribArray(normalLocation);
        glVertexAttribIPointer(normalLocation, 1, GL_UNSIGNED_INT, 0, nullptr);
    } else {
        glDisableVertexAttribArray(normalLocation);
    }
}

bool NodeBuffers::endFrame(std::uint64_t limitBytes) {
    std::uint64_t limit = boundInFrame_ > 0 ? limitBytes : 0;
    std::vector<std::pair<std::uint64_t, std::uint64_t>> idle; // last frame, id
    if (bytes_ > limit)
        for (const auto& [id, entry] : entries_)
            if (entry.lastFrame != frame_)
                idle.emplace_back(entry.lastFrame, id);
    std::sort(idle.begin(), idle.end());
    for (std::size_t i = 0; i < idle.size() && bytes_ > limit; ++i) {
        auto entry = entries_.find(idle[i].second);
        bytes_ -= entry->second.bytes;
        entries_.erase(entry);
    }
    ++frame_;
    boundInFrame_ = 0;
    return std::exchange(uploaded_, false);
}

} // namespace stipple::gles
