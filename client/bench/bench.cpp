#include "client/bench/bench.hpp"

#include "client/bench/reference_cache.hpp"
#include "client/bench/replay.hpp"
#include "client/core/attribute_needs.hpp"
#include "client/core/frame_planner.hpp"
#include "client/measure/comparison.hpp"
#include "client/measure/flip.hpp"
#include "client/measure/ssim.hpp"
#include "client/render/raster_setup.hpp"
#include "shared/base/text.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/io/file_source.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

namespace stipple::bench {
namespace {

constexpr std::uint64_t referencesAtOnce = 1ull << 30; // bytes

Status checkOptions(const BenchOptions& options) {
    auto refused = [](const std::string& what, const char* option) {
        return Error{ErrorCode::invalidArgument, what, option, ""};
    };
    if (std::min(options.width, options.height) < measure::ssimWindow ||
        std::max(options.width, options.height) > maxPartSide)
        return refused(cat("pictures of ", options.width, " × ", options.height, " pixels can't be compared"),
                       "--size");
    if (options.clouds.empty())
        return refused("there is no cloud", "");
    if (options.pathNames.empty() && options.paths.empty())
        return refused("there is no camera path", "--paths");
    if (options.modes.empty())
        return refused("there is no mode", "--modes");
    if (options.budgets.empty() || std::min(options.frames, options.samples) < 1 || options.repeats < 0)
        return refused("budgets, frames, samples and repeats must be positive", "");
    for (const std::string& name : options.pathNames)
        STIPPLE_CHECK([&]() -> Status {
            STIPPLE_TRY(path, builtInPath(name, {{0, 0, 0}, {1, 1, 1}}, 1));
            (void)path;
            return {};
        }());
    return {};
}

// Half as large as often as it takes to be at most samplePictureWidth wide: the mean of each four pixels.
Image scaledDown(Image image) {
    while (image.width > samplePictureWidth) {
        Image half{image.width / 2, image.height / 2, {}};
        auto row = static_cast<std::size_t>(image.width) * 4;
        for (std::size_t y = 0; y < static_cast<std::size_t>(half.height); ++y)
            for (std::size_t x = 0; x < static_cast<std::size_t>(half.width); ++x)
                for (std::size_t c = 0; c < 4; ++c) {
                    const std::uint8_t* p = &image.rgba[2 * y * row + 8 * x + c];
                    half.rgba.push_back(
                        static_cast<std::uint8_t>((p[0] + p[4] + p[row] + p[row + 4] + 2) / 4));
                }
        image = std::move(half);
    }
    return image;
}

// Everything about one cloud.
class CloudBench {
  public:
    CloudBench(const BenchOptions& options, std::string cloud, BenchResult& result)
        : options_(options), cloud_(std::move(cloud)), result_(result) {}

    Status run() {
        STIPPLE_CHECK(open());
        STIPPLE_CHECK(drawReferences());
        for (const Mode& mode : options_.modes) {
            if (std::string lack = lackOf(mode.style, *metadata_, info_.name); !lack.empty())
                info_.limitations.push_back(cat(mode.name, ": ", lack));
            STIPPLE_TRY(drawer, headless::FrameDrawer::create(mode.backend, options_.threads));
            for (std::uint64_t budget : budgetsOf(mode))
                for (const CameraPath& path : info_.paths)
                    STIPPLE_CHECK(runPath(mode, budget, path, *drawer));
            if (std::string_view limit = drawer->limitation(); !limit.empty())
                info_.limitations.push_back(cat(mode.name, ": ", limit));
        }
        result_.clouds.push_back(std::move(info_));
        return {};
    }

    static std::uint64_t runsOf(const BenchOptions& options) {
        std::uint64_t runs = 0;
        for (const Mode& mode : options.modes)
            runs += mode.sweep ? options.budgets.size() : 1;
        return runs * (options.pathNames.size() + options.paths.size()) * options.clouds.size();
    }

  private:
    Status open() {
        STIPPLE_TRY(source, openFileSource(cloud_));
        STIPPLE_TRY(reader, CloudReader::open(*source));
        metadata_ = std::make_shared<const CloudMetadata>(reader->metadata());
        if (metadata_->pointCount == 0)
            return Error{ErrorCode::invalidArgument, "the cloud has no points", cloud_, ""};
        info_.name = std::filesystem::path(cloud_).stem().string();
        info_.points = metadata_->pointCount;
        info_.pointHash = metadata_->pointHash;
        info_.bounds = metadata_->worldBounds();
        for (const std::string& name : options_.pathNames) {
            STIPPLE_TRY(path, builtInPath(name, info_.bounds, options_.frames));
            info_.paths.push_back(std::move(path));
        }
        info_.paths.insert(info_.paths.end(), options_.paths.begin(), options_.paths.end());
        cache_ = std::make_unique<ReferenceCache>(options_.cacheFolder, *metadata_);
        return {};
    }

    std::vector<std::uint64_t> budgetsOf(const Mode& mode) const {
        return mode.sweep ? options_.budgets : std::vector<std::uint64_t>{options_.usualBudget};
    }

    Style styleOf(const Mode& mode) const {
        Style style = mode.style;
        if (mode.worldSizeSpacings > 0) {
            Vec3d size = info_.bounds.max - info_.bounds.min;
            style.sizeWorld =
                mode.worldSizeSpacings * std::sqrt(size.x * size.y / static_cast<double>(info_.points));
        }
        if (mode.clipPart > 0)
            style.clipBoxes.push_back({(info_.bounds.min + info_.bounds.max) * 0.5,
                                       (info_.bounds.max - info_.bounds.min) * (mode.clipPart / 2),
                                       axesTurned(30)});
        return resolvedStyle(style, std::vector{metadata_});
    }

    ReferenceRequest referenceRequest(const Style& style, const Camera& camera) const {
        return {camera, style, options_.width, options_.height, options_.samples};
    }

    // Those that are not there yet, each once, so many at a time as memory should hold.
    Status drawReferences() {
        std::vector<ReferenceRequest> missing;
        for (const Mode& mode : options_.modes)
            for (const CameraPath& path : info_.paths)
                for (const Camera& camera : path.cameras) {
                    ReferenceRequest request = referenceRequest(styleOf(mode), camera);
                    auto same = [&](const ReferenceRequest& other) {
                        return other.camera == request.camera && other.style == request.style;
                    };
                    if (std::none_of(missing.begin(), missing.end(), same) && !cache_->has(request))
                        missing.push_back(request);
                }
        std::uint64_t bytes =
            reference::Canvas::bytesFor(options_.width, options_.height, options_.samples, true);
        auto atOnce = static_cast<std::size_t>(std::max<std::uint64_t>(1, referencesAtOnce / bytes));
        for (std::size_t first = 0; first < missing.size(); first += atOnce)
            STIPPLE_CHECK(
                drawReferences(std::span(missing).subspan(first, std::min(atOnce, missing.size() - first)),
                               first, missing.size()));
        return {};
    }

    Status drawReferences(std::span<const ReferenceRequest> requests, std::size_t before, std::size_t all) {
        std::vector<reference::Job> jobs;
        for (const ReferenceRequest& request : requests)
            jobs.push_back({reference::viewOf(request.camera, request.width, request.height, info_.bounds),
                            request.style, request.samples});
        reference::Options options;
        options.threads = options_.threads;
        options.memoryBytes = referencesAtOnce;
        options.progress = [&](std::uint64_t done, std::uint64_t total) {
            report(cat("reference pictures of ", info_.name),
                   before + requests.size() * done / std::max<std::uint64_t>(1, total), all);
        };
        STIPPLE_TRY(source, openFileSource(cloud_));
        STIPPLE_TRY(pictures, renderCloud(*source, jobs, options));
        for (std::size_t i = 0; i < pictures.size(); ++i) {
            STIPPLE_CHECK(cache_->put(requests[i], pictures[i]));
            if (options_.cacheFolder.empty())
                kept_.emplace_back(requests[i], std::move(pictures[i]));
        }
        return {};
    }

    Result<DepthImage> reference(const ReferenceRequest& request) const {
        for (const auto& [of, picture] : kept_)
            if (of.camera == request.camera && of.style == request.style)
                return picture;
        if (auto found = cache_->find(request))
            return std::move(*found);
        return Error{ErrorCode::corrupt, "a kept reference picture can't be used any more",
                     options_.cacheFolder, "remove the folder; its pictures are then drawn again"};
    }

    Status runPath(const Mode& mode, std::uint64_t budget, const CameraPath& path,
                   headless::FrameDrawer& drawer) {
        report("runs", result_.runs.size(), runsOf(options_));
        ReplayRequest request;
        request.cloud = cloud_;
        request.path = &path;
        request.style = styleOf(mode);
        request.limits = mode.limits;
        request.limits.pointBudget = budget;
        // The cache is to hold what a path sees: 16 bytes a point, twice, and more for short ones.
        request.limits.cacheBytes = std::max<std::uint64_t>(mode.limits.cacheBytes, 2ull << 30);
        request.width = options_.width;
        request.height = options_.height;
        request.repeats = options_.repeats;
        request.threads = options_.threads;
        request.reference = [&](std::size_t i) {
            return reference(referenceRequest(request.style, path.cameras[i]));
        };
        bool shown = options_.pictures && &path == &info_.paths.front();
        if (shown)
            request.show = [&](std::size_t i, const DepthImage& wanted, const Image& picture,
                               const measure::Plane<float>& flip) {
                if (i == path.cameras.size() / 2)
                    result_.pictures.push_back({info_.name, path.name, mode.name, budget, i,
                                                scaledDown(picture), scaledDown(wanted.image),
                                                scaledDown(measure::differencePicture(wanted.image, picture)),
                                                scaledDown(measure::errorPicture(flip))});
            };
        STIPPLE_TRY(frames, replay(request, drawer));
        result_.runs.push_back({info_.name, path.name, mode.name, budget, drawer.name(), std::move(frames)});
        return {};
    }

    void report(const std::string& phase, std::uint64_t done, std::uint64_t total) const {
        if (options_.progress)
            options_.progress(phase, done, total);
    }

    const BenchOptions& options_;
    std::string cloud_;
    BenchResult& result_;
    CloudResult info_;
    std::shared_ptr<const CloudMetadata> metadata_;
    std::unique_ptr<ReferenceCache> cache_;
    std::vector<std::pair<ReferenceRequest, DepthImage>> kept_; // without a folder
};

} // namespace

Result<BenchResult> runBench(const BenchOptions& options) {
    STIPPLE_CHECK(checkOptions(options));
    BenchResult result;
    result.machine = thisMachine();
    result.width = options.width;
    result.height = options.height;
    result.repeats = options.repeats;
    result.samples = options.samples;
    result.threads = options.threads;
    result.modes = options.modes;
    for (const std::string& cloud : options.clouds)
        STIPPLE_CHECK(CloudBench(options, cloud, result).run());
    return result;
}

} // namespace stipple::bench
