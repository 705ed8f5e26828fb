#include "tests/support/reference_picture.hpp"

#include <cmath>
#include <cstdlib>
#include <memory>
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
        for (const Attribute& attribute : attributesOf(node))
            points.attributes.push_back(attribute);
        batch.resize({points.attributes}, node.points.size());
        for (std::size_t i = 0; i < node.points.size(); ++i) {
            const TestPoint& p = node.points[i];
            batch.positions[i] = {p.x, p.y, p.z};
            int column = 0;
            if (node.hasColour)
                for (std::uint8_t level : {p.r, p.g, p.b})
                    batch.setValue<std::uint16_t>(column++, i, level);
            if (node.hasIntensity) {
                batch.setValue<float>(column++, i, p.intensity);
                batch.setValue<std::uint8_t>(column++, i, p.classification);
                batch.setValue<double>(column++, i, p.gpsTime);
            }
            for (int axis = 0; node.hasNormals && axis < 3; ++axis)
                batch.setValue<float>(column++, i, p.normal[axis]);
        }
        points.grid = &grid;
        points.batch = &batch;
        points.colourIs8Bit = true;
        points.level = node.key.level > 0 ? node.key.level : 8; // as testPlan has it
        points.nodePoints = static_cast<double>(node.points.size());
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
    canvas.draw(marks, reference::drawnShape(style));
    if (style.splats.enabled)
        canvas.blend(marks, style);
    canvas.doubt(marks, style, slack);
    return {canvas.finish(style), canvas.doubtful(style), canvas.distanceSlack()};
}

ReferencePoints referencePoints(const reference::View& view, const Style& style,
                                std::span<const reference::Points> clouds) {
    std::vector<reference::Mark> marks;
    for (const reference::Points& cloud : clouds)
        appendMarks(view, style, cloud, marks);
    for (reference::Mark& mark : marks) {
        auto name = static_cast<std::uint32_t>(mark.order) + 1;
        mark.colour = {static_cast<float>(name & 255), static_cast<float>(name >> 8 & 255),
                       static_cast<float>(name >> 16)};
    }
    Style plain = style;
    plain.edl.enabled = false;
    plain.splats.enabled = false;
    plain.background = {0, 0, 0};
    reference::Canvas canvas(view.width, view.height);
    canvas.draw(marks, reference::drawnShape(plain));
    canvas.doubt(marks, plain, {});
    DepthImage picture = canvas.finish(plain);
    ReferencePoints points{view.width, view.height, {}, picture.distances, canvas.doubtful(plain)};
    for (std::size_t at = 0; at < points.distances.size(); ++at) {
        const std::uint8_t* c = picture.image.rgba.data() + 4 * at;
        points.order.push_back(c[0] | std::uint32_t{c[1]} << 8 | std::uint32_t{c[2]} << 16);
    }
    return points;
}

ReferencePoints referencePoints(const std::vector<TestNode>& nodes, const TestView& view,
                                const Style& style) {
    std::vector<std::unique_ptr<NodeCloud>> clouds;
    std::vector<reference::Points> points;
    std::uint64_t order = 0;
    for (const TestNode& node : nodes) {
        clouds.push_back(std::make_unique<NodeCloud>(node));
        clouds.back()->points.firstOrder = order;
        order += node.points.size();
        points.push_back(clouds.back()->points);
    }
    return referencePoints(viewOf(view), style, points);
}

ExpectedPick expectedPick(const ReferencePoints& points, const PickRequest& request) {
    struct Best {
        double away = HUGE_VAL, distance = HUGE_VAL;
        std::uint32_t order = 0;
    } best;
    double firstDoubt = HUGE_VAL;
    bool isTie = false;
    for (int row = 0; row < points.height; ++row)
        for (int column = 0; column < points.width; ++column) {
            double away = std::hypot(column + 0.5 - request.x, row + 0.5 - request.y);
            bool own = std::floor(request.x) == column && std::floor(request.y) == row;
            auto at = static_cast<std::size_t>(row) * static_cast<std::size_t>(points.width) +
                      static_cast<std::size_t>(column);
            if (away > request.radius && !own)
                continue;
            if (points.unsure[at])
                firstDoubt = std::min(firstDoubt, away);
            if (points.order[at] == 0 || away > best.away)
                continue;
            double distance = double{points.distances[at]};
            if (away == best.away) { // the nearer in depth
                isTie = isTie || std::abs(distance - best.distance) <= 1e-5 * distance;
                if (distance >= best.distance)
                    continue;
            } else {
                isTie = false;
            }
            best = {away, distance, points.order[at]};
        }
    return {best.order, !isTie && firstDoubt > best.away};
}

std::uint32_t orderOf(const std::optional<PickHit>& hit, const FramePlan& plan) {
    if (!hit)
        return 0;
    std::uint32_t first = 0;
    for (const DrawNode& node : plan.nodes) {
        if (node.node == hit->node)
            return first + hit->point + 1;
        first += node.pointCount;
    }
    return UINT32_MAX;
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
        double allowed = double{tolerance} * double{expected} + reference.distanceSlack[at];
        bool differs = std::abs(double{distances[at]} - double{expected}) > allowed;
        wrong += differs && !reference.unsure[at] ? 1 : 0;
    }
    return wrong;
}

} // namespace stipple::test
