// Every node of a cloud, decoded, from which frame plans are made by hand: what would be drawn with a skip,
// and what without it. Colours are the points' own; what a style hides is decided point by point, by the
// reference's arithmetic. Ends the program, saying why, where something fails.
#pragma once

#include "client/core/attribute_needs.hpp"
#include "client/core/camera.hpp"
#include "client/core/hierarchy.hpp"
#include "client/core/selection.hpp"
#include "shared/format/cloud_file.hpp"

#include <memory>
#include <string>
#include <vector>

namespace stipple {

// So many points of a node.
struct NodePart {
    std::uint32_t node = 0; // index into the hierarchy
    std::uint32_t points = 0;
};

class WholeCloud {
  public:
    WholeCloud(const std::string& path, int width, int height);

    const Hierarchy& hierarchy() const { return hierarchy_; }
    const CloudMetadata& metadata() const { return hierarchy_.metadata(); }
    ViewTransform viewOf(const Camera& camera) const;

    // Decides anew what filters, hidden classes and clip boxes hide; reads every point's attributes.
    void hideBy(const Style& style);
    bool hidesAllOf(std::uint32_t node) const;

    // What the client selects where everything is here, without a budget.
    std::vector<NodePart> selected(const Camera& camera, double minNodePixels, double detailPixels = 0,
                                   const Clips* clips = nullptr) const;
    FramePlan planOf(const std::vector<NodePart>& parts, const Camera& camera, const Style& style) const;
    // What is fetched for them: strata, and the further blocks that the style needs.
    double bytesOf(const std::vector<NodePart>& parts, const Style& style) const;

  private:
    void readHierarchy();
    std::shared_ptr<const ResidentNode> nodeOf(const NodeEntry& entry, const PointBatch& points) const;

    int width_, height_;
    std::unique_ptr<ByteSource> source_;
    std::unique_ptr<CloudReader> reader_;
    Hierarchy hierarchy_;
    std::vector<std::shared_ptr<const ResidentNode>> nodes_;
    std::vector<std::shared_ptr<const NodePaint>> paints_; // null: shows all its points
};

} // namespace stipple
