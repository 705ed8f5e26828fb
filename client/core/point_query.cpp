#include "client/core/point_query.hpp"

#include "shared/base/text.hpp"
#include <algorithm>

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

PointValue valueOf(const Attribute& attribute, const std::uint8_t* at) {
    PointValue value{attribute, {}};
    for (int c = 0; c < attribute.components; ++c, at += attributeTypeSize(attribute.type))
        value.stored.push_back(numberAt(attribute.type, at));
    return value;
}

// Of the point at `index` of the columns that a job for points makes.
PointRecord recordOf(const CloudMetadata& metadata, const NodeColumns& columns, std::size_t index) {
    PointRecord record;
    const std::uint8_t* at = columns.column(exactPosition).data() + index * 3 * sizeof(std::int64_t);
    record.integers = {loadLe<std::int64_t>(at), loadLe<std::int64_t>(at + 8), loadLe<std::int64_t>(at + 16)};
    record.position = metadata.grid.toWorld(record.integers);
    std::int32_t a = 0;
    for (const Attribute& attribute : metadata.schema.attributes)
        record.values.push_back(valueOf(attribute, columns.column(a++).data() + index * attribute.size()));
    return record;
}

// What answers to a job for points have to be like; workers send them as bytes.
bool holdsAll(const CloudMetadata& metadata, const NodeColumns& columns, std::size_t points) {
    bool whole = columns.column(exactPosition).size() == points * 3 * sizeof(std::int64_t);
    std::int32_t a = 0;
    for (const Attribute& attribute : metadata.schema.attributes)
        whole = whole && columns.column(a++).size() == points * attribute.size();
    return whole;
}

} // namespace

Status PointQueries::ask(const CloudLoader& cloud, const PointIdentity& point) {
    auto refused = [&](Phrase what) {
        return Error{ErrorCode::invalidArgument, std::move(what), cat("node ", point.node.text()),
                     say("ask for points of the present picture")};
    };
    if (!cloud.ready())
        return refused(say("the cloud is not open"));
    std::int32_t node = cloud.hierarchy.find(point.node);
    if (node < 0)
        return refused(say("the node is not known"));
    std::uint32_t count = cloud.hierarchy.node(static_cast<std::size_t>(node)).entry.pointCount;
    if (point.index >= count)
        return refused(say("point ", point.index, " of ", count));
    asked_.push_back({point, static_cast<std::uint32_t>(node), 0});
    return {};
}

std::vector<LoadItem> PointQueries::items(const CloudLoader& cloud) const {
    std::vector<std::uint32_t> nodes;
    for (const Question& question : asked_)
        if (question.batch == 0 && question.point.cloud == cloud.state.id)
            nodes.push_back(question.node);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    std::vector<LoadItem> items;
    for (std::uint32_t node : nodes)
        items.push_back(cloud.pointsItem(node));
    return items;
}

void PointQueries::takeLoaded(const CloudLoader& cloud, std::uint32_t node, Result<Bytes> bytes) {
    DecodeJob job;
    job.cloud = cloud.state.id;
    job.metadata = cloud.opened.metadata;
    job.entry = cloud.hierarchy.node(node).entry;
    std::uint32_t batch = ++lastBatch_;
    for (Question& question : asked_)
        if (question.batch == 0 && question.point.cloud == job.cloud && question.node == node) {
            question.batch = batch;
            job.points.push_back(question.point.index);
        }
    if (job.points.empty())
        return;
    if (!bytes.ok()) {
        answer(batch, [&](std::size_t) { return cloud.placed(bytes.error()); });
        return;
    }
    job.picture = std::move(*bytes);
    ++decoding_;
    std::size_t points = job.points.size();
    decoder_.decode(std::move(job), [this, alive = alive_, batch, points, metadata = cloud.opened.metadata,
                                     source = cloud.source->name()](Result<ResidentNode> decoded) {
        if (!*alive)
            return;
        --decoding_;
        if (decoded.ok() && !holdsAll(*metadata, decoded->columns, points))
            decoded = Error{ErrorCode::corrupt, say("a decoder left out attributes of a point"), "",
                            say("reload the page")};
        answer(batch, [&](std::size_t n) -> Result<PointRecord> {
            return decoded.ok() ? Result<PointRecord>(recordOf(*metadata, decoded->columns, n))
                                : decoded.error().at(source);
        });
    });
}

void PointQueries::answer(std::uint32_t batch,
                          const std::function<Result<PointRecord>(std::size_t)>& record) {
    std::size_t n = 0;
    std::erase_if(asked_, [&](const Question& question) {
        if (question.batch != batch)
            return false;
        answers_.push_back({question.point, record(n++)});
        return true;
    });
}

void PointQueries::cancel(CloudId cloud) {
    std::erase_if(asked_, [&](const Question& question) {
        if (question.point.cloud != cloud)
            return false;
        answers_.push_back({question.point, Error{ErrorCode::cancelled, say("the cloud was closed"),
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
