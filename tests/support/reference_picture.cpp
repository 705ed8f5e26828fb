#include "tests/support/reference_picture.hpp"

#include <cmath>
#include <cstdlib>
#include <numbers>

namespace stipple::test {
namespace {

// A node's points as a cloud of its own, whose grid starts at the node's corner.
struct NodeCloud {
    explicit NodeCloud(const TestNode& node) : grid{node.scale, node.corner} {
        auto add = [&](std::string_view name, AttributeType type) {
            points.attributes.push_back({std::string(name), type});
        };
        if (node.hasColour)
            for (std::string_view name :
                 {attribute_names::red, attribute_names::green, attribute_names::blue})
                add(name, AttributeType::u16);
        if (node.hasIntensity)
            add(attribute_names::intensity, AttributeType::f32);
        batch.resize({points.attributes}, node.points.size());
        for (std::size_t i = 0; i < node.points.size(); ++i) {
            const TestPoint& p = node.points[i];
            batch.positions[i] = {p.x, p.y, p.z};
            int column = 0;
            if (node.hasColour)
                for (std::uint8_t level : {p.r, p.g, p.b})
                    batch.setValue<std::uint16_t>(column++, i, level);
            if (node.hasIntensity)
                batch.setValue<float>(column, i, p.intensity);
        }
        points.grid = &grid;
        points.batch = &batch;
        points.colourIs8Bit = true;
    }
    NodeCloud(const NodeCloud&) = delete;

    Grid grid;
    PointBatch batch;
    reference::Points points;
};

reference::View viewOf(const TestView& view) {
    Camera camera;
    camera.projection = view.projection;
    camera.position = view.position;
    camera.target = view.target;
    camera.up = view.up;
    camera.fovYDegrees = std::atan(view.tanHalfFovY) * 360 / std::numbers::pi;
    camera.orthoHeight = 2 * view.halfHeight;
    reference::View result = reference::viewOf(camera, view.width, view.height, {});
    result.eye = {view.position.x, view.position.y, view.position.z}; // as testPlan has it
    result.near = view.near;
    result.far = view.far;
    return result;
}

} // namespace

ReferencePicture referencePicture(const std::vector<TestNode>& nodes, const TestView& view,
                                  const Style& style, int samples, const reference::Slack& slack) {
    std::vector<reference::Mark> marks;
    std::uint64_t order = 0;
    for (const TestNode& node : nodes) {
        NodeCloud cloud(node);
        cloud.points.firstOrder = order;
        if (style.sizeMode == PointSizeMode::adaptive)
            for (const TestPoint& point : node.points)
                cloud.points.spacings.push_back(finestSpacing(nodes, node, point));
        order += node.points.size();
        appendMarks(viewOf(view), style, cloud.points, marks);
    }
    reference::Canvas canvas(view.width, view.height, samples);
    canvas.draw(marks, style.shape);
    if (style.splats.enabled)
        canvas.blend(marks, style);
    canvas.doubt(marks, style, slack);
    return {canvas.finish(style), canvas.doubtful(style)};
}

std::size_t wrongPixels(const Image& image, const ReferencePicture& reference, int toleranceLevels) {
    std::size_t wrong = 0;
    for (std::size_t at = 0; at < reference.unsure.size(); ++at) {
        bool differs = false;
        for (std::size_t c = 0; c < 3; ++c)
            differs = differs || std::abs(int(image.rgba[4 * at + c]) -
                                          int(reference.picture.image.rgba[4 * at + c])) > toleranceLevels;
        wrong += differs && !reference.unsure[at] ? 1 : 0;
    }
    return wrong;
}

std::size_t wrongDistances(const std::vector<float>& distances, const ReferencePicture& reference) {
    constexpr float tolerance = 4e-6f; // reference::Slack
    std::size_t wrong = distances.size() == reference.unsure.size() ? 0 : SIZE_MAX;
    for (std::size_t at = 0; at < reference.unsure.size() && wrong < SIZE_MAX; ++at) {
        float expected = reference.picture.distances[at];
        bool differs = std::abs(distances[at] - expected) > tolerance * expected;
        wrong += differs && !reference.unsure[at] ? 1 : 0;
    }
    return wrong;
}

} // namespace stipple::test
