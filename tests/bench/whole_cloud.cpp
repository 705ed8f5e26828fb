#include "tests/bench/whole_cloud.hpp"

#include "client/core/frame_planner.hpp"
#include "client/reference/marks.hpp"
#include "shared/io/file_source.hpp"
#include "tests/bench/settled_viewer.hpp"

#include <algorithm>

namespace stipple {
namespace {

reference::Points pointsOf(const CloudMetadata& metadata, const PointBatch& batch) {
    reference::Points points;
    points.grid = &metadata.grid;
    points.batch = &batch;
    points.attributes = metadata.schema.attributes;
    points.colourIs8Bit = metadata.colourIs8Bit;
    return points;
}

} // namespace

WholeCloud::WholeCloud(const std::string& path, int width, int height)
    : width_(width), height_(height), source_(need(openFileSource(path))),
      reader_(need(CloudReader::open(*source_))) {
    readHierarchy();
    for (std::size_t i = 0; i < hierarchy_.size(); ++i) {
        const NodeEntry& entry = hierarchy_.node(i).entry;
        nodes_.push_back(entry.pointCount == 0 ? nullptr : nodeOf(entry, need(reader_->readNode(entry))));
    }
    paints_.resize(nodes_.size());
}

void WholeCloud::readHierarchy() {
    std::vector<NodeEntry> entries;
    need(reader_->visitNodes([&](const NodeEntry& entry) {
        entries.push_back(entry);
        entries.back().childChunk = {};
        return Status();
    }));
    // A hierarchy wants parents first.
    std::stable_sort(entries.begin(), entries.end(),
                     [](const NodeEntry& a, const NodeEntry& b) { return a.key.level < b.key.level; });
    hierarchy_ =
        need(Hierarchy::create(std::make_shared<CloudMetadata>(reader_->metadata()), std::move(entries)));
}

std::shared_ptr<const ResidentNode> WholeCloud::nodeOf(const NodeEntry& entry,
                                                       const PointBatch& points) const {
    Vec3i corner = metadata().rootCube.nodeMin(entry.key);
    NodePicture picture;
    for (const Vec3i& p : points.positions)
        picture.positions.push_back({static_cast<std::uint32_t>(p.x - corner.x),
                                     static_cast<std::uint32_t>(p.y - corner.y),
                                     static_cast<std::uint32_t>(p.z - corner.z)});
    ResidentNode node = packNode(entry.key, metadata().rootCube.nodeBits(entry.key.level), entry.pointCount,
                                 picture, PictureColour::none, metadata().colourIs8Bit);
    for (const reference::Colour& colour : coloursOf(Style(), pointsOf(metadata(), points)))
        node.colourWords.push_back(static_cast<std::uint32_t>(colour[0]) |
                                   static_cast<std::uint32_t>(colour[1]) << 8 |
                                   static_cast<std::uint32_t>(colour[2]) << 16 | 0xFF000000u);
    return std::make_shared<const ResidentNode>(std::move(node));
}

ViewTransform WholeCloud::viewOf(const Camera& camera) const {
    return viewTransform(camera, width_, height_, metadata().worldBounds());
}

void WholeCloud::hideBy(const Style& style) {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        paints_[i] = nullptr;
        if (!nodes_[i])
            continue;
        PointBatch batch = need(reader_->readNode(hierarchy_.node(i).entry));
        std::vector<bool> shown = shownOf(style, pointsOf(metadata(), batch));
        auto hidden = static_cast<std::uint32_t>(std::count(shown.begin(), shown.end(), false));
        if (hidden == 0)
            continue;
        std::vector<std::uint32_t> words = nodes_[i]->colourWords;
        for (std::size_t p = 0; p < words.size(); ++p)
            words[p] &= shown[p] ? ~0u : 0x00FFFFFFu;
        auto paint = std::make_shared<NodePaint>();
        paint->id = nextResidentNodeId();
        paint->hidden = hidden;
        paint->words = std::make_shared<const std::vector<std::uint32_t>>(std::move(words));
        paints_[i] = std::move(paint);
    }
}

bool WholeCloud::hidesAllOf(std::uint32_t node) const {
    return paints_[node] && paints_[node]->hidden == nodes_[node]->pointCount;
}

std::vector<NodePart> WholeCloud::selected(const Camera& camera, double minNodePixels, double detailPixels,
                                           const Clips* clips) const {
    std::vector<NodeResidency> residency(hierarchy_.size());
    std::vector<SelectionCloud> clouds{{&hierarchy_, residency, 12}};
    SelectionInput input;
    input.view = viewOf(camera);
    input.height = height_;
    input.clouds = clouds;
    input.pointBudget = input.byteBudget = noBudget;
    input.clips = clips;
    input.minNodePixels = minNodePixels;
    input.detailPixels = detailPixels;
    std::vector<NodePart> parts;
    for (const SelectedNode& node : select(input).nodes)
        parts.push_back({node.node, node.points});
    return parts;
}

FramePlan WholeCloud::planOf(const std::vector<NodePart>& parts, const Camera& camera,
                             const Style& style) const {
    FramePlan plan;
    plan.width = width_;
    plan.height = height_;
    plan.view = viewOf(camera);
    plan.style = style;
    if (style.detail.mode == DetailMode::continuous)
        plan.detailPixels = style.detail.spacingPixels;
    for (const NodePart& part : parts) {
        if (!nodes_[part.node])
            continue;
        plan.nodes.push_back(planNode(nodes_[part.node], part.points, metadata(), plan.view.eye));
        plan.nodes.back().density = hierarchy_.densityOf(part.node);
        plan.nodes.back().paint = paints_[part.node];
    }
    return plan;
}

double WholeCloud::bytesOf(const std::vector<NodePart>& parts, const Style& style) const {
    AttributeNeeds needs = needsOf(style, metadata());
    double bytes = 0;
    for (const NodePart& part : parts) {
        const NodeEntry& entry = hierarchy_.node(part.node).entry;
        bytes += static_cast<double>(entry.strataRange(strataFor(entry.pointCount, part.points)).size);
        for (int block : needs.blocks)
            bytes += entry.attributeBytes[static_cast<std::size_t>(block)];
    }
    return bytes;
}

} // namespace stipple
