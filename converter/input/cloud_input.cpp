#include "converter/input/cloud_input.hpp"

#include "converter/input/idle_files.hpp"
#include "shared/base/text.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/io/file_source.hpp"

#include <filesystem>

namespace stipple {

namespace {
struct OpenCloud {
    std::unique_ptr<ByteSource> source;
    std::unique_ptr<CloudReader> reader;
};

Result<OpenCloud> openCloud(const std::string& path) {
    STIPPLE_TRY(source, openFileSource(path));
    auto reader = CloudReader::open(*source);
    if (!reader)
        return reader.error().where.find(path) == std::string::npos ? reader.error().at(path)
                                                                    : reader.error();
    return OpenCloud{std::move(source), std::move(reader).value()};
}

// What the times count from is said once: by the description's kind, as by the scans that the cloud was made
// of.
void takeGpsTimeKind(InputDescription& description) {
    int index = description.schema.find(attribute_names::gpsTime);
    if (index < 0)
        return;
    std::string& text = description.schema.attributes[static_cast<std::size_t>(index)].description;
    if (text == standardGpsTimeText)
        description.gpsTime = GpsTimeKind::adjustedStandard;
    else if (text == weekGpsTimeText)
        description.gpsTime = GpsTimeKind::week;
    else
        return;
    text.clear();
}

class CloudInput final : public PointInput {
  public:
    static Result<std::unique_ptr<PointInput>> open(const std::string& path) {
        auto input = std::make_unique<CloudInput>();
        STIPPLE_TRY(cloud, openCloud(path));
        const CloudMetadata& metadata = cloud.reader->metadata();
        InputDescription& d = input->description_;
        d.path = path;
        d.source = {std::filesystem::path(path).filename().string(), "Stipple cloud", metadata.pointCount,
                    cloud.reader->header().fileBytes, metadata.pointHash};
        d.grid = metadata.grid;
        d.schema = metadata.schema;
        d.crs = metadata.crs;
        d.bounds = metadata.bounds;
        d.madeOf = metadata.sources;
        takeGpsTimeKind(d);
        input->pointHash_ = metadata.pointHash;
        std::uint64_t points = 0;
        STIPPLE_CHECK(cloud.reader->visitNodes([&](const NodeEntry& entry) -> Status {
            if (entry.pointCount > 0) {
                input->parts_.push_back({entry.pointCount});
                input->entries_.push_back(entry);
            }
            points += entry.pointCount;
            return {};
        }));
        if (points != metadata.pointCount)
            return Error{
                ErrorCode::corrupt,
                cat("its nodes hold ", points, " points, but its metadata say ", metadata.pointCount), path,
                "`stipple verify` tells what else is wrong with it"};
        input->idle_.put(std::move(cloud));
        return std::unique_ptr<PointInput>(std::move(input));
    }

    const InputDescription& description() const override { return description_; }
    const std::vector<InputPart>& parts() const override { return parts_; }
    Result<std::unique_ptr<PointStream>> openPart(std::size_t part) const override;

    Result<PointBatch> readNode(std::size_t part) const {
        STIPPLE_TRY(cloud, take());
        auto points = cloud.reader->readNode(entries_[part]);
        idle_.putAfterPart(std::move(cloud), parts_.size());
        return points;
    }

  private:
    Result<OpenCloud> take() const {
        if (std::optional<OpenCloud> idle = idle_.take())
            return std::move(*idle);
        STIPPLE_TRY(cloud, openCloud(description_.path));
        if (cloud.reader->metadata().pointHash != pointHash_ ||
            cloud.reader->header().fileBytes != description_.source.sizeBytes)
            return Error{ErrorCode::changed, "the file changed while it was being read", description_.path,
                         "convert again"};
        return std::move(cloud);
    }

    InputDescription description_;
    std::string pointHash_;
    std::vector<InputPart> parts_;
    std::vector<NodeEntry> entries_; // of each part
    mutable IdleFiles<OpenCloud> idle_;
};

// Hands a node out in batches.
class NodeStream final : public PointStream {
  public:
    NodeStream(const CloudInput& input, std::size_t part) : input_(input), part_(part) {}

    Status next(PointBatch& batch) override {
        if (at_ == 0) {
            STIPPLE_TRY(points, input_.readNode(part_));
            points_ = std::move(points);
        }
        const Schema& schema = input_.description().schema;
        std::size_t count = std::min(pointsPerBatch, points_.size() - at_);
        batch.resize(schema, count);
        std::copy_n(points_.positions.begin() + static_cast<std::ptrdiff_t>(at_), count,
                    batch.positions.begin());
        for (std::size_t a = 0; a < batch.columns.size(); ++a) {
            std::size_t width = schema.attributes[a].size();
            std::copy_n(points_.columns[a].begin() + static_cast<std::ptrdiff_t>(at_ * width), count * width,
                        batch.columns[a].begin());
        }
        at_ += count;
        return {};
    }
    const ReadReport& report() const override { return report_; }

  private:
    const CloudInput& input_;
    std::size_t part_, at_ = 0;
    PointBatch points_;
    ReadReport report_;
};

Result<std::unique_ptr<PointStream>> CloudInput::openPart(std::size_t part) const {
    return std::unique_ptr<PointStream>(std::make_unique<NodeStream>(*this, part));
}
} // namespace

Result<std::unique_ptr<PointInput>> openCloudInput(const std::string& path) {
    return CloudInput::open(path);
}

} // namespace stipple
