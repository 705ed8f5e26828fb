// stipple render FILE|URL -o OUT.png: one picture of one cloud, without a window.
#include "client/core/json.hpp"
#include "client/headless/http_source.hpp"
#include "client/headless/http_url.hpp"
#include "client/headless/picture.hpp"
#include "client/headless/png.hpp"
#include "client/headless/stored_source.hpp"
#include "shared/base/text.hpp"
#include "shared/cli/number_check.hpp"
#include "shared/cli/verb.hpp"
#include "shared/io/output_file.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <memory>

namespace stipple {

void addRenderVerb(CLI::App& program, cli::Action& action);

namespace {

using namespace headless;

struct Options {
    std::string input, output;
    std::string size = "1280x720";
    std::string style = "{}";
    std::string projection;
    std::string backend = "software";
    std::string until = "complete";
    double timeoutSeconds = 60;
    bool json = false;
    std::string pick; // "X,Y"
    std::string cacheFolder;
    std::uint64_t cacheFolderBytes = 4ull << 30;
    PictureRequest request;
    std::shared_ptr<StoredSourceCounts> stored; // of cacheFolder
};

// With --cache what comes of an address is kept there, and what is kept does not come again.
Result<std::unique_ptr<ByteSource>> openInput(Options& options) {
    if (options.cacheFolder.empty())
        return openSource(options.input);
    if (!looksLikeUrl(options.input))
        return Error{ErrorCode::invalidArgument, "only what comes from a server is kept", "--cache",
                     "leave it out, or give an address"};
    STIPPLE_TRY(store, RangeStore::open(options.cacheFolder, options.cacheFolderBytes));
    options.stored = std::make_shared<StoredSourceCounts>();
    return openStoredSource(options.input, store, options.stored);
}

// "1280x720".
bool parseSize(const std::string& text, int& width, int& height) {
    int read = 0;
    return std::sscanf(text.c_str(), "%5dx%5d%n", &width, &height, &read) == 2 &&
           static_cast<std::size_t>(read) == text.size();
}

Result<PictureRequest> requestOf(const Options& options) {
    PictureRequest request = options.request;
    if (!parseSize(options.size, request.width, request.height))
        return Error{ErrorCode::invalidArgument, cat("'", options.size, "' is no picture size"), "--size",
                     "write WIDTHxHEIGHT, for example 1280x720"};
    STIPPLE_TRY(json, parseJson(options.style, "--style"));
    STIPPLE_TRY(style, styleFromJson(json));
    request.style = style;
    if (!options.projection.empty())
        request.projection =
            options.projection == "orthographic" ? Projection::orthographic : Projection::perspective;
    request.backend = options.backend == "gles" ? Backend::gles : Backend::software;
    request.until = options.until == "first" ? Until::first : Until::complete;
    request.timeout = std::chrono::milliseconds(static_cast<std::int64_t>(options.timeoutSeconds * 1000));
    STIPPLE_CHECK(checkRequest(request));
    return request;
}

// "320,240.5".
Result<PickRequest> pointerOf(const std::string& text) {
    PickRequest pointer;
    int read = 0;
    bool isPlace = std::sscanf(text.c_str(), "%lf,%lf%n", &pointer.x, &pointer.y, &read) == 2 &&
                   static_cast<std::size_t>(read) == text.size() && std::isfinite(pointer.x) &&
                   std::isfinite(pointer.y);
    if (!isPlace)
        return Error{ErrorCode::invalidArgument, cat("'", text, "' is no place in the picture"), "--pick",
                     "write X,Y in pixels from the left and from the top, for example 640,360"};
    return pointer;
}

// Prints what is under the pointer as JSON: null if nothing is.
Status pick(Options& options) {
    STIPPLE_TRY(request, requestOf(options));
    STIPPLE_TRY(pointer, pointerOf(options.pick));
    STIPPLE_TRY(source, openInput(options));
    STIPPLE_TRY(session, PictureSession::open(std::move(source), request));
    STIPPLE_TRY(picked, session->pick(request, pointer));
    nlohmann::json answer;
    if (picked) {
        answer = toJson(picked->record);
        answer["point"] = toJson(picked->identity);
        answer["pixelsAway"] = picked->pixelsAway;
        answer["distance"] = picked->distance;
    }
    std::printf("%s\n", jsonText(answer).c_str());
    return {};
}

Status render(Options& options) {
    if (options.output.empty() == options.pick.empty())
        return Error{ErrorCode::invalidArgument, "either a picture or a point is asked for", "--output",
                     "give --output OUT.png, or --pick X,Y"};
    if (!options.pick.empty())
        return pick(options);
    STIPPLE_TRY(request, requestOf(options));
    STIPPLE_TRY(source, openInput(options));
    // An output that can't be written is known before anything is loaded.
    STIPPLE_TRY(file, OutputFile::create(options.output));
    STIPPLE_TRY(png, PngWriter::begin(request.width, request.height,
                                      [&file = *file](ByteSpan bytes) { return file.append(bytes); }));
    STIPPLE_TRY(picture, drawPicture(std::move(source), request,
                                     [&png = *png](const Image& rows) { return png.append(rows); }));
    STIPPLE_CHECK(png->finish());
    STIPPLE_CHECK(file->commit());

    for (const std::string& sentence : picture.limitations)
        std::fprintf(stderr, "warning: %s\n", sentence.c_str());
    if (options.json) {
        nlohmann::json answer{
            {"output", options.output},
            {"width", request.width},
            {"height", request.height},
            {"backend", options.backend},
            {"renderer", picture.renderer},
            {"limitations", picture.limitations},
            {"camera", toJson(picture.camera)},
            {"frame", toJson(picture.frame)},
            {"session", toJson(picture.session)},
            {"seconds",
             {{"open", picture.openSeconds}, {"load", picture.loadSeconds}, {"draw", picture.drawSeconds}}}};
        if (options.stored)
            answer["cache"] = {{"bytesFromDisk", options.stored->bytesFromDisk},
                               {"readsFromDisk", options.stored->readsFromDisk}};
        std::printf("%s\n", jsonText(answer).c_str());
    } else {
        std::printf(
            "%s: %d x %d pixels, %llu points of %llu nodes; opened in %.3f s, loaded in %.3f s, drawn in "
            "%.3f s\n",
            options.output.c_str(), request.width, request.height,
            static_cast<unsigned long long>(picture.frame.pointsDrawn),
            static_cast<unsigned long long>(picture.frame.nodesDrawn), picture.openSeconds,
            picture.loadSeconds, picture.drawSeconds);
    }
    return {};
}

} // namespace

void addRenderVerb(CLI::App& program, cli::Action& action) {
    auto options = std::make_shared<Options>();
    CLI::App* verb = program.add_subcommand("render", "Draw a picture of a .stipple file, local or served");
    verb->add_option("input", options->input, "File, or address (http://…)")->required();
    verb->add_option("-o,--output", options->output, "Picture to write (PNG)");
    verb->add_option("--pick", options->pick,
                     "Instead of a picture: X,Y in pixels from the top left; prints the point that is shown "
                     "there, or next to it, with all its attributes, as JSON");
    verb->add_option(
            "--view", options->request.view,
            "top, front, side, iso, or a camera as JSON: {\"position\": [x, y, z], \"target\": [x, y, z], …}")
        ->capture_default_str();
    verb->add_option("--size", options->size, "Width and height in pixels, each at most 65000")
        ->capture_default_str();
    verb->add_option("--budget", options->request.limits.pointBudget, "Points drawn at most")
        ->check(cli::wholeNumber(1, cli::mostPoints))
        ->capture_default_str();
    verb->add_option("--backend", options->backend, "software or gles")
        ->check(CLI::IsMember({"software", "gles"}))
        ->capture_default_str();
    verb->add_option("--style", options->style,
                     "How points look, as JSON: {\"colourMode\": \"elevation\", \"sizePixels\": 3, …}");
    verb->add_option("--projection", options->projection, "perspective or orthographic")
        ->check(CLI::IsMember({"perspective", "orthographic"}));
    verb->add_option("--until", options->until,
                     "Draw when the view is complete, or as soon as there is anything to see (first)")
        ->check(CLI::IsMember({"complete", "first"}))
        ->capture_default_str();
    verb->add_option("--threads", options->request.threads, "Of the software backend; 0: one per core")
        ->check(cli::wholeNumber(0, 256))
        ->capture_default_str();
    verb->add_option("--timeout", options->timeoutSeconds, "Seconds for opening and loading")
        ->check(cli::number(0.001, 86400))
        ->capture_default_str();
    verb->add_option("--cache", options->cacheFolder,
                     "Folder in which what comes of an address is kept for the next time (made if absent)");
    verb->add_option("--cache-bytes", options->cacheFolderBytes, "At most in that folder")
        ->check(cli::wholeNumber(1, std::uint64_t{1} << 50))
        ->capture_default_str();
    verb->add_flag("--json", options->json, "Print camera and counters as JSON");
    verb->callback([options, &action] {
        action = [options] {
            Status status = render(*options);
            return status.ok() ? static_cast<int>(cli::success) : cli::fail("render", status.error());
        };
    });
}

} // namespace stipple
