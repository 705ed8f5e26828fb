#include "converter/input/e57/e57_input.hpp"

#include "converter/crs/crs.hpp"
#include "converter/input/e57/measure.hpp"
#include "converter/input/float_grid.hpp"
#include "converter/input/idle_files.hpp"
#include "converter/input/input_file.hpp"
#include "shared/base/text.hpp"
#include "shared/codec/checksum.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace stipple {

namespace {
using namespace e57;

constexpr std::uint64_t recordsPerPart = std::uint64_t{1} << 18;
constexpr std::size_t walkPagesPerBlock = 4, walkBlocks = 4; // only packets' headers are read
constexpr std::size_t maxCrsBytes = 65536;

Error atFile(Error error, const std::string& path) {
    return error.where.find(path) == std::string::npos ? error.at(path) : error;
}

// What an open file is known by: the XML section says where everything is.
struct Identity {
    std::uint64_t sizeBytes = 0, xmlHash = 0;
    std::uint32_t firstPage = 0;
    friend bool operator==(const Identity&, const Identity&) = default;
};

struct OpenFile {
    std::unique_ptr<ByteSource> source;
    FileHeader header;
    Bytes xml;
    std::uint64_t xmlOffset = 0; // logical

    Identity identity() const { return {source->sizeBytes(), xxh64(xml), header.pageChecksum}; }
};

Result<OpenFile> openFile(const std::string& path, const std::atomic<bool>* stop) {
    OpenFile file;
    STIPPLE_TRY(source, openInputFile(path, stop));
    file.source = std::move(source);
    STIPPLE_TRY(header, readFileHeader(*file.source));
    file.header = header;
    STIPPLE_TRY(offset, logicalOffset(header.xmlOffset, header, "the XML section"));
    file.xmlOffset = offset;
    if (header.xmlBytes > maxXmlBytes)
        return Error{ErrorCode::limitExceeded,
                     cat("the XML section has ", header.xmlBytes, " bytes; up to ", maxXmlBytes, " are read"),
                     "byte 32", ""};
    PagedFile pages(*file.source, header, recordPagesPerBlock, 1);
    if (header.xmlBytes > pages.sizeBytes() - offset)
        return Error{ErrorCode::truncated, "the XML section ends behind the file's end", placeOf(offset),
                     "was it copied completely?"};
    file.xml.resize(static_cast<std::size_t>(header.xmlBytes));
    STIPPLE_CHECK(pages.read(offset, file.xml));
    return file;
}

// Scans that are read; those without points are left out with a warning.
Result<std::vector<ScanEntry>> usableScans(Document& document, std::vector<std::string>& warnings) {
    std::vector<ScanEntry> withPoints, withRecords;
    for (ScanEntry& scan : document.scans) {
        if (!scan.hasPoints)
            warnings.push_back(cat("scan ", scan.number, " has no points"));
        else
            withPoints.push_back(scan);
    }
    if (withPoints.empty())
        return Error{ErrorCode::unsupported,
                     cat("the file holds no scan with points (data3D is ",
                         document.scans.empty() ? "empty" : "without", ")",
                         document.pictures > 0 ? cat(", only ", document.pictures, " pictures") : ""),
                     "", "give a file with points"};
    std::copy_if(withPoints.begin(), withPoints.end(), std::back_inserter(withRecords),
                 [](const ScanEntry& scan) { return scan.recordCount > 0; });
    return withRecords.empty() ? withPoints : withRecords;
}

Result<Layout> layOut(OpenFile& file, Document& document, std::vector<std::string>& warnings) {
    Layout layout;
    layout.header = file.header;
    STIPPLE_TRY(scans, usableScans(document, warnings));
    layout.scans = std::move(scans);
    PagedFile pages(*file.source, file.header, walkPagesPerBlock, walkBlocks);
    for (const ScanEntry& scan : layout.scans) {
        auto fields = coordinateFields(scan);
        if (!fields)
            return fields.error().at(cat("scan ", scan.number));
        layout.coordinates.push_back(*fields);
        auto section = readSection(pages, file.header, scan, recordsPerPart);
        if (!section)
            return section.error().at(cat("scan ", scan.number));
        layout.sections.push_back(std::move(section).value());
    }
    layout.exact = exactGrid(layout.entries(), layout.coordinates);
    return layout;
}

// Whether counts and ranges can't be known without reading the points.
bool mustMeasure(const Layout& layout, const std::vector<std::vector<std::size_t>>& ranged) {
    if (!layout.exact)
        return true;
    for (std::size_t s = 0; s < layout.scans.size(); ++s)
        if (layout.coordinates[s].invalidState >= 0 || !ranged[s].empty() ||
            !allInRange(layout.scans[s], layout.coordinates[s], layout.exact->maps[s]))
            return true;
    return false;
}

// Every record is a point.
Measure countOnly(const Layout& layout) {
    Measure result;
    for (std::size_t s = 0; s < layout.scans.size(); ++s) {
        result.points.emplace_back();
        for (const RecordSpan& span : layout.sections[s].spans)
            result.points.back().push_back(span.count);
        result.ranges.emplace_back(layout.scans[s].fields.size());
    }
    return result;
}

Grid gridOver(const Layout& layout, const Measure& measured, double wantedStep) {
    if (layout.exact)
        return layout.exact->grid;
    double step = wantedStep;
    for (std::size_t s = 0; s < layout.scans.size() && wantedStep <= 0; ++s) {
        if (measured.local[s].empty())
            continue;
        double own = finestStep(layout.scans[s], layout.coordinates[s], measured.local[s]);
        step = step <= 0 ? own : std::min(step, own);
    }
    return floatGrid(measured.world, Precision{}, step);
}

BoxI boundsOnGrid(const Grid& grid, const BoxD& world) {
    BoxI box;
    if (world.empty())
        return box;
    // Rounding is monotone, so the corners of the box are those of the rounded points.
    Kept corners;
    ReadReport unused;
    corners.world = {world.min, world.max};
    roundToGrid(grid, corners, unused);
    box.min = corners.positions[0];
    box.max = corners.positions[1];
    return box;
}

class E57Input final : public PointInput {
  public:
    static Result<std::unique_ptr<PointInput>> open(const std::string& path, const InputOptions& options) {
        auto input = std::make_unique<E57Input>();
        input->stop_ = options.stop;
        auto file = openFile(path, options.stop);
        if (!file)
            return atFile(file.error(), path);
        if (Status described = input->describe(path, *file, options); !described)
            return atFile(described.error(), path);
        input->idle_.put(std::move(file->source));
        return std::unique_ptr<PointInput>(std::move(input));
    }

    const InputDescription& description() const override { return description_; }
    const std::vector<InputPart>& parts() const override { return parts_; }
    Result<std::unique_ptr<PointStream>> openPart(std::size_t part) const override;
    std::optional<std::string> contradiction(const BoxI& found) const override;

    // A source of the file for one stream, and back.
    Result<std::unique_ptr<ByteSource>> take() const;
    void giveBack(std::unique_ptr<ByteSource> source) const {
        idle_.putAfterPart(std::move(source), parts_.size());
    }

    const Layout& layout() const { return layout_; }
    const AttributePlan& plan() const { return plan_; }

  private:
    // The spans that a part consists of.
    struct PartSpans {
        std::size_t scan = 0, begin = 0, end = 0;
    };
    friend class E57Stream;

    Status describe(const std::string& path, OpenFile& file, const InputOptions& options);
    Status describeCrs(const Document& document);
    void describeBounds(const Measure& measured, bool isMeasured);
    void divide(const Measure& measured);

    InputDescription description_;
    const std::atomic<bool>* stop_ = nullptr;
    Identity identity_;
    Layout layout_;
    AttributePlan plan_;
    std::vector<InputPart> parts_;
    std::vector<PartSpans> partSpans_;
    BoxD statedBounds_; // of the world, where the file's own statement is what is known
    mutable IdleFiles<std::unique_ptr<ByteSource>> idle_;
};

Status E57Input::describe(const std::string& path, OpenFile& file, const InputOptions& options) {
    InputDescription& d = description_;
    d.path = path;
    identity_ = file.identity();
    STIPPLE_TRY(document, parseDocument(file.xml, file.xmlOffset));
    d.warnings = std::move(document.warnings);
    STIPPLE_TRY(layout, layOut(file, document, d.warnings));
    layout_ = std::move(layout);
    auto ranged = fieldsToMeasure(layout_.entries());
    bool isMeasured = mustMeasure(layout_, ranged);
    Measure measured;
    if (isMeasured) {
        STIPPLE_TRY(result,
                    measure({[this] { return take(); }, options.threads, options.stop}, layout_, ranged));
        measured = std::move(result);
    } else {
        measured = countOnly(layout_);
    }
    d.grid = gridOver(layout_, measured, options.scale);
    plan_ = planAttributes(layout_.entries(), layout_.coordinates, measured.ranges);
    d.schema = plan_.schema;
    d.gpsTime = plan_.gpsTime;
    d.warnings.insert(d.warnings.end(), plan_.warnings.begin(), plan_.warnings.end());
    if (document.pictures > 0)
        d.warnings.push_back(cat("its ", document.pictures, " pictures (images2D) are left out"));
    divide(measured);
    std::size_t scans = layout_.scans.size();
    d.source = {std::filesystem::path(path).filename().string(),
                cat("E57 ", file.header.versionMajor, ".", file.header.versionMinor, ", ", scans,
                    scans == 1 ? " scan" : " scans"),
                0, file.source->sizeBytes()};
    for (const InputPart& part : parts_)
        d.source.pointCount += part.points;
    describeBounds(measured, isMeasured);
    return describeCrs(document);
}

Status E57Input::describeCrs(const Document& document) {
    const std::string& text = document.coordinateMetadata;
    if (text.empty())
        return {};
    if (text.size() > maxCrsBytes) {
        description_.warnings.push_back(
            cat("its coordinateMetadata of ", text.size(), " bytes is too long for a coordinate system"));
        return {};
    }
    auto crs = crsFromUser(text);
    if (crs)
        description_.crs = *crs;
    else if (crs.error().code == ErrorCode::invalidArgument)
        description_.warnings.push_back(cat("its coordinateMetadata ", crs.error().what));
    else
        return crs.error();
    return {};
}

// Measured; or, where nothing had to be read for other reasons, as the scans state them.
void E57Input::describeBounds(const Measure& measured, bool isMeasured) {
    InputDescription& d = description_;
    d.boundsAreMeasured = isMeasured;
    if (isMeasured) {
        d.bounds = layout_.exact ? measured.bounds : boundsOnGrid(d.grid, measured.world);
        return;
    }
    for (const ScanEntry& scan : layout_.scans) {
        if (!scan.cartesianBounds || scan.cartesianBounds->empty()) {
            statedBounds_ = {};
            return;
        }
        statedBounds_.extend(scan.pose.apply(scan.cartesianBounds->min));
        statedBounds_.extend(scan.pose.apply(scan.cartesianBounds->max));
    }
    bool countable = d.source.pointCount > 0;
    for (int axis = 0; axis < 3; ++axis)
        countable = countable &&
                    std::abs(d.grid.toSteps(statedBounds_.min)[axis]) < double{farthestInteger} &&
                    std::abs(d.grid.toSteps(statedBounds_.max)[axis]) < double{farthestInteger};
    if (countable)
        d.bounds = boundsOnGrid(d.grid, statedBounds_);
    else
        statedBounds_ = {};
}

std::optional<std::string> E57Input::contradiction(const BoxI& found) const {
    if (found.empty() || statedBounds_.empty())
        return std::nullopt;
    const Grid& grid = description_.grid;
    Vec3d low = grid.toWorld(found.min), high = grid.toWorld(found.max);
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(low[axis] - statedBounds_.min[axis]) > grid.scale[axis] ||
            std::abs(high[axis] - statedBounds_.max[axis]) > grid.scale[axis])
            return cat("its cartesianBounds give ", "xyz"[axis], " from ", statedBounds_.min[axis], " to ",
                       statedBounds_.max[axis], ", but the points lie from ", low[axis], " to ", high[axis]);
    return std::nullopt;
}

// Spans are joined until a part has enough records; parts never join scans.
void E57Input::divide(const Measure& measured) {
    for (std::size_t s = 0; s < layout_.scans.size(); ++s) {
        const std::vector<RecordSpan>& spans = layout_.sections[s].spans;
        std::uint64_t points = 0, records = 0;
        std::size_t begin = 0;
        for (std::size_t i = 0; i < spans.size(); ++i) {
            points += measured.points[s][i];
            records += spans[i].count;
            if (records < recordsPerPart && i + 1 < spans.size())
                continue;
            parts_.push_back({points});
            partSpans_.push_back({s, begin, i + 1});
            points = records = 0;
            begin = i + 1;
        }
    }
}

Result<std::unique_ptr<ByteSource>> E57Input::take() const {
    if (std::optional<std::unique_ptr<ByteSource>> idle = idle_.take())
        return std::move(*idle);
    auto file = openFile(description_.path, stop_);
    if (!file)
        return atFile(file.error(), description_.path);
    if (file->identity() != identity_)
        return Error{ErrorCode::changed, "the file changed while it was being read", description_.path,
                     "convert again when it is complete"};
    return std::move(file->source);
}

class E57Stream final : public PointStream {
  public:
    E57Stream(const E57Input& input, std::unique_ptr<ByteSource> source, const E57Input::PartSpans& part)
        : input_(input), source_(std::move(source)),
          file_(*source_, input.layout().header, recordPagesPerBlock, recordBlocks), part_(part),
          scan_(input.layout().scans[part.scan]), span_(part.begin) {
        std::vector<std::size_t> used = input.layout().coordinates[part.scan].all();
        fields_ = input.plan().fieldsOf(part.scan);
        fields_.insert(fields_.end(), used.begin(), used.end());
        std::sort(fields_.begin(), fields_.end());
        fields_.erase(std::unique(fields_.begin(), fields_.end()), fields_.end());
        run_ = std::min(RecordReader::goodRun(scan_, fields_.size()), pointsPerBatch);
    }
    ~E57Stream() override { input_.giveBack(std::move(source_)); }

    Status next(PointBatch& batch) override {
        batch.resize(input_.description().schema, 0);
        while (batch.size() == 0) {
            if (!reader_ || reader_->remaining() == 0) {
                if (span_ == part_.end)
                    return {};
                const Section& section = input_.layout().sections[part_.scan];
                reader_.emplace(file_, scan_, section, section.spans[span_++], fields_);
            }
            if (Status read = readRun(batch); !read)
                return atFile(read.error(), input_.description().path);
        }
        return {};
    }
    const ReadReport& report() const override { return report_; }

  private:
    Status readRun(PointBatch& batch) {
        std::size_t count = static_cast<std::size_t>(std::min<std::uint64_t>(run_, reader_->remaining()));
        STIPPLE_CHECK(reader_->next(count, columns_));
        const Layout& layout = input_.layout();
        const CoordinateFields& coordinates = layout.coordinates[part_.scan];
        if (layout.exact) {
            placeExactly(coordinates, layout.exact->maps[part_.scan], columns_, count, kept_, report_);
        } else {
            locate(scan_, coordinates, columns_, count, kept_, report_);
            roundToGrid(input_.description().grid, kept_, report_);
        }
        batch.positions.assign(kept_.positions.begin(), kept_.positions.end());
        const AttributePlan& plan = input_.plan();
        for (std::size_t a = 0; a < batch.columns.size(); ++a)
            fillAttribute(plan.schema.attributes[a], plan.sources[part_.scan][a], scan_, columns_, kept_.rows,
                          batch.columns[a]);
        return {};
    }

    const E57Input& input_;
    std::unique_ptr<ByteSource> source_;
    PagedFile file_;
    E57Input::PartSpans part_;
    const ScanEntry& scan_;
    std::size_t span_; // the next one
    std::vector<std::size_t> fields_;
    std::size_t run_;
    std::optional<RecordReader> reader_;
    std::vector<Column> columns_;
    Kept kept_;
    ReadReport report_;
};

Result<std::unique_ptr<PointStream>> E57Input::openPart(std::size_t part) const {
    STIPPLE_TRY(source, take());
    return std::unique_ptr<PointStream>(
        std::make_unique<E57Stream>(*this, std::move(source), partSpans_[part]));
}
} // namespace

Result<std::unique_ptr<PointInput>> openE57Input(const std::string& path, const InputOptions& options) {
    return E57Input::open(path, options);
}

} // namespace stipple
