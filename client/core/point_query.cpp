#include "client/core/point_query.hpp"

#include "shared/base/text.hpp"
#include "shared/format/cloud_file.hpp"

#include <algorithm>
#include <numeric>

namespace stipple {
namespace {

template <class T>
StoredNumber numberAt(const std::uint8_t* at) {
    if constexpr (std::is_floating_point_v<T>)
        return static_cast<double>(loadLe<T>(at));
    else if constexpr (std::is_signed_v<T>)
        return static_cast<std::int64_t>(loadLe<T>(at));
    else
        return static_cast<std::uint64_t>(loadLe<T>(at));
}

StoredNumber numberAt(AttributeType type, const std::uint8_t* at) {
    switch (type) {
    case AttributeType::u8:
        return numberAt<std::uint8_t>(at);
    case AttributeType::i8:
        return numberAt<std::int8_t>(at);
    case AttributeType::u16:
        return numberAt<std::uint16_t>(at);
    case AttributeType::i16:
        return numberAt<std::int16_t>(at);
    case AttributeType::u32:
        return numberAt<std::uint32_t>(at);
    case AttributeType::i32:
        return numberAt<std::int32_t>(at);
    case AttributeType::u64:
        return numberAt<std::uint64_t>(at);
    case AttributeType::i64:
        return numberAt<std::int64_t>(at);
    case AttributeType::f32:
        return numberAt<float>(at);
    case AttributeType::f64:
        return numberAt<double>(at);
    }
    return 0.0;
}

PointValue valueOf(const Attribute& attribute, const Bytes& column, std::size_t index) {
    PointValue value{attribute, {}};
    const std::uint8_t* at = column.data() + index * attribute.size();
    for (int c = 0; c < attribute.components; ++c, at += attributeTypeSize(attribute.type))
        value.stored.push_back(numberAt(attribute.type, at));
    return value;
}

PointRecord recordOf(const CloudMetadata& metadata, const PointBatch& batch, std::size_t index) {
    PointRecord record;
    record.integers = batch.positions[index];
    record.position = metadata.grid.toWorld(record.integers);
    for (std::size_t a = 0; a < batch.columns.size(); ++a)
        record.values.push_back(valueOf(metadata.schema.attributes[a], batch.columns[a], index));
    return record;
}

Result<PointBatch> wholeNode(const CloudLoader& cloud, std::uint32_t node, const Result<Bytes>& bytes) {
    if (!bytes.ok())
        return bytes.error();
    const CloudMetadata& metadata = *cloud.opened.metadata;
    NodeBytes whole;
    whole.entry = cloud.hierarchy.node(node).entry;
    whole.attributes.resize(metadata.schema.attributes.size());
    std::iota(whole.attributes.begin(), whole.attributes.end(), 0);
    whole.bytes = *bytes;
    return decodeNode(metadata, whole);
}

} // namespace

Status PointQueries::ask(const CloudLoader& cloud, const PointIdentity& point) {
    auto refused = [&](std::string what) {
        return Error{ErrorCode::invalidArgument, std::move(what), cat("node ", point.node.text()),
                     "ask for points of the present picture"};
    };
    if (!cloud.ready())
        return refused("the cloud is not open");
    std::int32_t node = cloud.hierarchy.find(point.node);
    if (node < 0)
        return refused("the node is not known");
    std::uint32_t count = cloud.hierarchy.node(static_cast<std::size_t>(node)).entry.pointCount;
    if (point.index >= count)
        return refused(cat("point ", point.index, " of ", count));
    asked_.push_back({point, static_cast<std::uint32_t>(node)});
    return {};
}

std::vector<LoadItem> PointQueries::items(const CloudLoader& cloud) const {
    std::vector<std::uint32_t> nodes;
    for (const Question& question : asked_)
        if (question.point.cloud == cloud.state.id)
            nodes.push_back(question.node);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    std::vector<LoadItem> items;
    for (std::uint32_t node : nodes)
        items.push_back(cloud.pointsItem(node));
    return items;
}

void PointQueries::takeLoaded(const CloudLoader& cloud, std::uint32_t node, const Result<Bytes>& bytes) {
    Result<PointBatch> points = wholeNode(cloud, node, bytes);
    std::erase_if(asked_, [&](const Question& question) {
        if (question.point.cloud != cloud.state.id || question.node != node)
            return false;
        if (points.ok())
            answers_.push_back(
                {question.point, recordOf(*cloud.opened.metadata, *points, question.point.index)});
        else
            answers_.push_back({question.point, cloud.placed(points.error())});
        return true;
    });
}

void PointQueries::cancel(CloudId cloud) {
    std::erase_if(asked_, [&](const Question& question) {
        if (question.point.cloud != cloud)
            return false;
        answers_.push_back({question.point, Error{ErrorCode::cancelled, "the cloud was closed",
                                                  cat("node ", question.point.node.text()), ""}});
        return true;
    });
}

PointRecord positionRecord(const CloudMetadata& metadata, const ResidentNode& node, std::uint32_t index) {
    Vec3i corner = metadata.rootCube.nodeMin(node.key);
    Vec3<std::uint32_t> inNode = positionOf(node, index);
    PointRecord record;
    record.integers = {corner.x + inNode.x, corner.y + inNode.y, corner.z + inNode.z};
    record.position = metadata.grid.toWorld(record.integers);
    return record;
}

} // namespace stipple
