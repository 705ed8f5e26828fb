// codec_bench FILE.stipple [REPEATS]: bits per point and speed of the codecs on the nodes of a cloud.
//
// Every node is decoded once, encoded again and decoded REPEATS times (3); the fastest run of each node
// counts. One thread, its processor time. "encode" and "decode" are millions of points a second; positions
// encode without the choice of the order and the sort, which have their own row.
#include "shared/base/text.hpp"
#include "shared/codec/colour_codec.hpp"
#include "shared/codec/column_codec.hpp"
#include "shared/codec/position_codec.hpp"
#include "shared/codec/progressive_order.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/format/picture_attributes.hpp"
#include "shared/format/point_hash.hpp"
#include "shared/io/file_source.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <map>

namespace {

using namespace stipple;

struct Row {
    double points = 0, bytes = 0, encodeSeconds = 0, decodeSeconds = 0;
};

// Processor time of this thread, so that other programs do not count; Emscripten has only the wall clock.
double seconds() {
#ifdef __EMSCRIPTEN__
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
#else
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
#endif
}

double fastest(int repeats, const std::function<void()>& run) {
    double best = 1e9;
    for (int i = 0; i < repeats; ++i) {
        double start = seconds();
        run();
        best = std::min(best, seconds() - start);
    }
    return best;
}

template <class T>
T need(Result<T> result) {
    if (!result.ok()) {
        std::fprintf(stderr, "%s\n", result.error().sentence().c_str());
        std::exit(1);
    }
    return std::move(result).value();
}
void need(const Status& status) {
    if (!status.ok()) {
        std::fprintf(stderr, "%s\n", status.error().sentence().c_str());
        std::exit(1);
    }
}

class Bench {
  public:
    Bench(const CloudMetadata& metadata, int repeats) : metadata_(metadata), repeats_(repeats) {}

    void node(const NodeEntry& entry, const PointBatch& points) {
        auto count = static_cast<double>(points.size());
        std::vector<Vec3<std::uint32_t>> local;
        Vec3i corner = metadata_.rootCube.nodeMin(entry.key);
        for (const Vec3i& p : points.positions)
            local.push_back({static_cast<std::uint32_t>(p.x - corner.x),
                             static_cast<std::uint32_t>(p.y - corner.y),
                             static_cast<std::uint32_t>(p.z - corner.z)});
        SortedPoints sorted;
        record("order and sort", count, 0, fastest(repeats_, [&] { sorted = sortPoints(local); }), 0);
        positions(entry, sorted);
        colour(points, sorted);
        for (const AttributeBlock& block : attributeBlocks(metadata_))
            for (int a : block.attributes)
                attribute(static_cast<std::size_t>(a), points, sorted);
        record("point hash", count, 0, fastest(repeats_, [&] { PointHash().add(metadata_.schema, points); }),
               0);
        record("whole node", count, static_cast<double>(entry.sizeBytes()),
               fastest(1, [&] { need(encodeNode(metadata_, entry.key, points)); }), 0);
    }

    void print() const {
        std::printf("%-32s %10s %8s %8s\n", "", "bits/point", "encode", "decode");
        for (const std::string& name : order_) {
            const Row& row = rows_.at(name);
            std::printf("%-32s %10.2f %8.1f %8.1f\n", name.c_str(), 8 * row.bytes / row.points,
                        row.points / row.encodeSeconds / 1e6,
                        row.decodeSeconds > 0 ? row.points / row.decodeSeconds / 1e6 : 0);
        }
    }

  private:
    void positions(const NodeEntry& entry, const SortedPoints& sorted) {
        auto pointCount = static_cast<std::uint32_t>(sorted.keys.size());
        ByteWriter bytes;
        double encode = fastest(repeats_, [&] {
            bytes.bytes().clear();
            for (int s = 0; s < strataCount; ++s)
                if (stratumPoints(pointCount, s) > 0)
                    encodePositions(bytes, sorted, s);
        });
        std::vector<Vec3<std::uint32_t>> decoded;
        double decode = fastest(repeats_, [&] {
            decoded.clear();
            PositionDecoder decoder(pointCount, metadata_.rootCube.nodeBits(entry.key.level), strataCount);
            ByteReader reader(bytes.bytes());
            for (int s = 0; s < strataCount; ++s)
                if (stratumPoints(pointCount, s) > 0)
                    need(decoder.decode(s, reader));
            decoded = need(decoder.takePositions());
        });
        record("positions", pointCount, static_cast<double>(bytes.size()), encode, decode);
    }

    void colour(const PointBatch& points, const SortedPoints& sorted) {
        std::vector<int> attributes = pictureAttributes(metadata_);
        if (attributes.empty())
            return;
        auto pointCount = static_cast<std::uint32_t>(sorted.keys.size());
        auto channels = static_cast<int>(attributes.size());
        std::vector<std::uint16_t> values;
        for (std::uint32_t i : sorted.input)
            for (int a : attributes)
                values.push_back(points.value<std::uint16_t>(a, i));
        ByteWriter bytes;
        double encode = fastest(repeats_, [&] {
            bytes.bytes().clear();
            ColourWidth width = narrowestWidth(values);
            for (int s = 0; s < strataCount; ++s)
                if (stratumPoints(pointCount, s) > 0)
                    encodeColour(bytes, values, channels, width, s, neighbourChoices(sorted.keys, s));
        });
        std::array<std::vector<NeighbourChoice>, strataCount> choices;
        for (int s = 1; s < strataCount; ++s)
            choices[static_cast<std::size_t>(s)] = neighbourChoices(sorted.keys, s);
        std::vector<std::uint16_t> decoded;
        double decode = fastest(repeats_, [&] {
            decoded.clear();
            ColourDecoder decoder(pointCount, channels, strataCount);
            ByteReader reader(bytes.bytes());
            for (int s = 0; s < strataCount; ++s)
                if (stratumPoints(pointCount, s) > 0)
                    need(decoder.decode(s, reader, choices[static_cast<std::size_t>(s)]));
            decoded = decoder.takeValues();
        });
        record(channels == 3 ? "picture RGB" : "picture intensity", pointCount,
               static_cast<double>(bytes.size()), encode, decode);
    }

    void attribute(std::size_t a, const PointBatch& points, const SortedPoints& sorted) {
        const Attribute& attribute = metadata_.schema.attributes[a];
        std::size_t size = attribute.size(), width = attributeTypeSize(attribute.type);
        auto components = static_cast<std::size_t>(attribute.components);
        Bytes values;
        for (std::uint32_t i : sorted.input)
            values.insert(values.end(), points.columns[a].begin() + static_cast<std::ptrdiff_t>(i * size),
                          points.columns[a].begin() + static_cast<std::ptrdiff_t>((i + 1) * size));
        ByteWriter bytes;
        double encode = fastest(repeats_, [&] {
            bytes.bytes().clear();
            encodeColumn(bytes, values, width, components);
        });
        double decode = fastest(repeats_, [&] {
            ByteReader reader(bytes.bytes());
            need(decodeColumn(reader, points.size(), width, components));
        });
        record(attribute.name, static_cast<double>(points.size()), static_cast<double>(bytes.size()), encode,
               decode);
    }

    void record(const std::string& name, double points, double bytes, double encode, double decode) {
        if (rows_.find(name) == rows_.end())
            order_.push_back(name);
        Row& row = rows_[name];
        row.points += points;
        row.bytes += bytes;
        row.encodeSeconds += encode;
        row.decodeSeconds += decode;
    }

    const CloudMetadata& metadata_;
    int repeats_;
    std::map<std::string, Row> rows_;
    std::vector<std::string> order_;
};

} // namespace

int main(int argumentCount, char** arguments) {
    if (argumentCount < 2) {
        std::fprintf(stderr, "codec_bench FILE.stipple [REPEATS]\n");
        return 2;
    }
    auto source = need(openFileSource(arguments[1]));
    auto reader = need(CloudReader::open(*source));
    Bench bench(reader->metadata(), argumentCount > 2 ? std::max(1, std::atoi(arguments[2])) : 3);
    need(reader->visitNodes([&](const NodeEntry& entry) -> Status {
        if (entry.pointCount == 0)
            return {};
        STIPPLE_TRY(points, reader->readNode(entry));
        bench.node(entry, points);
        return {};
    }));
    bench.print();
    return 0;
}
