#include "converter/export/ply_sink.hpp"

#include "converter/export/ply_properties.hpp"
#include "shared/base/text.hpp"

#include <array>

namespace stipple {

namespace {

std::string onOneLine(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < ' ')
            c = ' ';
    return text;
}

class PlySink final : public PointSink {
  public:
    PlySink(std::unique_ptr<ByteSink> to, const SinkInput& input, std::optional<std::uint64_t> count)
        : to_(std::move(to)), input_(input), layout_(plyLayout(input)), stated_(count) {}

    Status start() {
        if (!stated_ && !to_->canOverwrite())
            return Error{ErrorCode::invalidArgument,
                         "a PLY file begins with the number of its points, which is not known yet", "",
                         "write to a file"};
        return to_->append(bytesOf(header(stated_.value_or(0))));
    }

    Result<EncodedPoints> encode(PointBatch batch) const override {
        EncodedPoints points;
        points.count = batch.size();
        std::size_t stride = layout_.bytesPerPoint;
        points.bytes.resize(batch.size() * stride);
        for (std::size_t i = 0; i < batch.size(); ++i) {
            Vec3d world = input_.metadata.grid.toWorld(batch.positions[i]);
            storeLe(points.bytes.data() + i * stride, std::array{world.x, world.y, world.z});
        }
        std::size_t at = 3 * sizeof(double);
        for (const WrittenPlyProperty& property : layout_.properties) {
            STIPPLE_CHECK(putProperty(property, input_.attribute(property.column),
                                      batch.columns[property.column], points.bytes.data() + at, stride,
                                      batch.size()));
            at += property.size;
        }
        return points;
    }

    Status write(EncodedPoints points) override {
        written_ += points.count;
        return to_->append(points.bytes);
    }

    Status finish() override {
        if (stated_ && *stated_ != written_)
            return Error{ErrorCode::corrupt, cat(written_, " points came instead of ", *stated_), "",
                         "the cloud contradicts itself; convert the scan again"};
        if (!stated_)
            STIPPLE_CHECK(to_->overwrite(0, bytesOf(header(written_))));
        return to_->finish();
    }

  private:
    // Of the same size whatever the count, so that it can be written again: a comment takes up what is left.
    std::string header(std::uint64_t count) const {
        constexpr std::size_t digits = 20; // of the largest count
        std::string number = std::to_string(count);
        std::string text = "ply\nformat binary_little_endian 1.0\ncomment made by Stipple\n";
        const Crs& crs = input_.metadata.crs;
        if (crs.epsg)
            text += cat("comment crs EPSG:", *crs.epsg, "\n");
        if (!crs.wkt.empty())
            text += "comment crs " + onOneLine(crs.wkt) + "\n";
        for (const std::string& comment : layout_.comments)
            text += "comment " + comment + "\n";
        text += "comment" + std::string(digits - number.size(), ' ') + "\n";
        text += "element vertex " + number + "\nproperty double x\nproperty double y\nproperty double z\n";
        for (const WrittenPlyProperty& property : layout_.properties)
            text += cat("property ", property.type, " ", property.name, "\n");
        return text + "end_header\n";
    }

    static Bytes bytesOf(const std::string& text) { return Bytes(text.begin(), text.end()); }

    std::unique_ptr<ByteSink> to_;
    SinkInput input_;
    PlyLayout layout_;
    std::optional<std::uint64_t> stated_;
    std::uint64_t written_ = 0;
};

} // namespace

Result<std::unique_ptr<PointSink>> plySink(std::unique_ptr<ByteSink> to, const SinkInput& input,
                                           std::optional<std::uint64_t> count) {
    auto sink = std::make_unique<PlySink>(std::move(to), input, count);
    STIPPLE_CHECK(sink->start());
    return std::unique_ptr<PointSink>(std::move(sink));
}

} // namespace stipple
