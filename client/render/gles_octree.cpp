#include "client/render/gles_octree.hpp"

#include "client/render/gles_programs.hpp"
#include "client/render/gles_targets.hpp"

#include <vector>

namespace stipple::gles {

void OctreeTexture::load(const FramePlan& plan) {
    DrawnOctree tree = drawnOctree(plan);
    bool same = texture_ && tree.words == tree_.words;
    tree_ = std::move(tree);
    int rows = static_cast<int>((tree_.words.size() + octreeTextureWidth - 1) / octreeTextureWidth);
    if (rows > rows_) {
        makeTexture(texture_, GL_R32UI, octreeTextureWidth, rows);
        rows_ = rows;
    }
    glActiveTexture(GL_TEXTURE0 + octreeUnit);
    glBindTexture(GL_TEXTURE_2D, texture_.id());
    if (same)
        return;
    std::vector<std::uint32_t> words = tree_.words;
    words.resize(static_cast<std::size_t>(rows) * octreeTextureWidth);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, octreeTextureWidth, rows, GL_RED_INTEGER, GL_UNSIGNED_INT,
                    words.data());
}

void OctreeTexture::clear() {
    texture_ = Texture();
    tree_ = {};
    rows_ = 0;
}

} // namespace stipple::gles
