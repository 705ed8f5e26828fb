#include "converter/input/las_input.hpp"

#include "converter/crs/crs.hpp"
#include "converter/input/idle_files.hpp"
#include "shared/base/text.hpp"
#include "shared/io/file_source.hpp"

#include <cmath>
#include <filesystem>

namespace stipple {

namespace {
constexpr std::uint64_t pointsPerPart = std::uint64_t{1} << 18;
constexpr std::uint16_t standardTimeBit = 1; // of the header's global encoding

Error atFile(Error error, const std::string& path) {
    return error.where.find(path) == std::string::npos ? error.at(path) : error;
}

bool isUsable(const Grid& grid) {
    for (int axis = 0; axis < 3; ++axis)
        if (!std::isfinite(grid.scale[axis]) || grid.scale[axis] <= 0 || !std::isfinite(grid.offset[axis]))
            return false;
    return true;
}

// The stated bounds as integers; empty where they are no bounds that 32-bit integers could have.
BoxI statedBounds(const las::Header& header) {
    constexpr double limit = 4294967296.0;
    BoxI box;
    Vec3d low = header.grid.toSteps(header.bounds.min), high = header.grid.toSteps(header.bounds.max);
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(low[axis]) < limit) || !(std::abs(high[axis]) < limit) || low[axis] > high[axis])
            return box;
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = std::llround(low[axis]);
        box.max[axis] = std::llround(high[axis]);
    }
    return box;
}

class LasInput final : public PointInput {
  public:
    static Result<std::unique_ptr<PointInput>> open(const std::string& path) {
        auto input = std::make_unique<LasInput>();
        STIPPLE_TRY(las, openLas(path));
        STIPPLE_CHECK(input->describe(path, las));
        input->divide(*las.reader);
        input->idle_.put(std::move(las));
        return std::unique_ptr<PointInput>(std::move(input));
    }

    const InputDescription& description() const override { return description_; }
    const std::vector<InputPart>& parts() const override { return parts_; }
    Result<std::unique_ptr<PointStream>> openPart(std::size_t part) const override;

    std::optional<std::string> contradiction(const BoxI& found) const override {
        return las::boundsContradiction(header_, found);
    }

    // A reader of the file for one stream, and back.
    Result<OpenLas> take() const;
    void giveBack(OpenLas las) const { idle_.putAfterPart(std::move(las), parts_.size()); }

  private:
    Status describe(const std::string& path, const OpenLas& las) {
        const las::Header& header = las.reader->header();
        InputDescription& d = description_;
        header_ = header;
        header_.vlrs.clear();
        d.path = path;
        d.source = {std::filesystem::path(path).filename().string(), lasFormatText(header),
                    las.reader->pointCount(), las.source->sizeBytes()};
        d.lostPoints = header.pointCount - std::min(header.pointCount, las.reader->pointCount());
        d.grid = header.grid;
        d.schema = las.reader->schema();
        d.imposedAttributes = las::schemaOf(header.pointFormat).attributes.size();
        d.warnings = las.reader->warnings();
        if (!isUsable(d.grid))
            return Error{ErrorCode::corrupt, "a scale factor or offset of the header is no usable number",
                         path, "mend the header, or write the file again from its source"};
        if (d.schema.find(attribute_names::gpsTime) >= 0)
            d.gpsTime = (header.globalEncoding & standardTimeBit) != 0 ? GpsTimeKind::adjustedStandard
                                                                       : GpsTimeKind::week;
        if (d.source.pointCount > 0)
            d.bounds = statedBounds(header);
        STIPPLE_TRY(reading, crsOfLas(header));
        d.crs = reading.crs;
        d.warnings.insert(d.warnings.end(), reading.warnings.begin(), reading.warnings.end());
        return {};
    }

    void divide(const las::Reader& reader) {
        std::uint64_t end = reader.pointCount(), begin = 0;
        std::span<const std::uint64_t> chunks = reader.chunkStarts();
        auto close = [&](std::uint64_t at) {
            parts_.push_back({at - begin});
            starts_.push_back(begin);
            begin = at;
        };
        for (std::uint64_t start : chunks)
            if (start < end && start - begin >= pointsPerPart)
                close(start);
        while (begin < end)
            close(chunks.empty() ? std::min(begin + pointsPerPart, end) : end);
    }

    InputDescription description_;
    las::Header header_; // without its records
    std::vector<InputPart> parts_;
    std::vector<std::uint64_t> starts_; // of each part
    mutable IdleFiles<OpenLas> idle_;
};

class LasStream final : public PointStream {
  public:
    LasStream(const LasInput& input, OpenLas las, std::uint64_t first, std::uint64_t count)
        : input_(input), las_(std::move(las)), at_(first), end_(first + count) {}
    ~LasStream() override { input_.giveBack(std::move(las_)); }

    Status next(PointBatch& batch) override {
        std::uint64_t count = std::min<std::uint64_t>(pointsPerBatch, end_ - at_);
        if (count == 0) {
            batch.resize(las_.reader->schema(), 0);
            return {};
        }
        if (Status read = las_.reader->read(at_, count, batch); !read)
            return atFile(read.error(), input_.description().path);
        if (batch.size() != count)
            return Error{ErrorCode::truncated, cat("the points end after ", at_ + batch.size()),
                         input_.description().path, "the file changed, or is damaged"};
        at_ += count;
        return {};
    }
    const ReadReport& report() const override { return report_; }

  private:
    const LasInput& input_;
    OpenLas las_;
    std::uint64_t at_, end_;
    ReadReport report_;
};

Result<OpenLas> LasInput::take() const {
    if (std::optional<OpenLas> idle = idle_.take())
        return std::move(*idle);
    STIPPLE_TRY(las, openLas(description_.path));
    if (las.reader->pointCount() != description_.source.pointCount ||
        las.source->sizeBytes() != description_.source.sizeBytes)
        return Error{ErrorCode::changed, "the file changed while it was being read", description_.path,
                     "convert again when it is complete"};
    return std::move(las);
}

Result<std::unique_ptr<PointStream>> LasInput::openPart(std::size_t part) const {
    STIPPLE_TRY(las, take());
    return std::unique_ptr<PointStream>(
        std::make_unique<LasStream>(*this, std::move(las), starts_[part], parts_[part].points));
}
} // namespace

std::string lasFormatText(const las::Header& header) {
    return cat(header.compressed ? "LAZ " : "LAS ", header.versionMajor, ".", header.versionMinor,
               ", point format ", header.pointFormat);
}

Result<OpenLas> openLas(const std::string& path) {
    STIPPLE_TRY(source, openFileSource(path));
    auto reader = las::Reader::open(*source);
    if (!reader)
        return atFile(reader.error(), path);
    return OpenLas{std::move(source), std::move(reader).value()};
}

Result<std::unique_ptr<PointInput>> openLasInput(const std::string& path) {
    return LasInput::open(path);
}

} // namespace stipple
