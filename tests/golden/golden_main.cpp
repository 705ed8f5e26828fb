// Golden pictures: a folder below tests/golden is a test.
//
//   stipple_golden [--update] [--scenes FOLDER] [--work FOLDER] [NAME…]
//
// Each scene is drawn from its .stipple file by the software renderer, which must give expected.png exactly,
// and by GLES where there is a context, within the tolerance below; the counters must be expected.json's.
// What was drawn, and where it differs, lands in the work folder. --update writes the expected files anew
// from the software picture, and such a run never passes.
#include "client/core/json.hpp"
#include "client/headless/egl_context.hpp"
#include "client/headless/picture.hpp"
#include "client/headless/png.hpp"
#include "client/measure/pixel_error.hpp"
#include "shared/base/text.hpp"
#include "shared/io/file_source.hpp"
#include "tests/golden/scene.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

using namespace stipple;
using namespace stipple::golden;
namespace fs = std::filesystem;

namespace {

// GLES may differ in one pixel of 500 by more than 3 levels: drivers fuse multiplications and additions.
constexpr int glesLevels = 3;
constexpr std::size_t glesPixelsPerWrong = 500;

struct Arguments {
    bool update = false;
    std::string scenes = STIPPLE_SOURCE_DIR "/tests/golden";
    std::string work = "golden";
    std::vector<std::string> names;
};

Arguments argumentsOf(int argc, char** argv) {
    Arguments arguments;
    for (int i = 1; i < argc; ++i) {
        std::string word = argv[i];
        if (word == "--update")
            arguments.update = true;
        else if (word == "--scenes" && i + 1 < argc)
            arguments.scenes = argv[++i];
        else if (word == "--work" && i + 1 < argc)
            arguments.work = argv[++i];
        else
            arguments.names.push_back(word);
    }
    return arguments;
}

std::vector<std::string> sceneFolders(const Arguments& arguments) {
    std::vector<std::string> folders;
    for (const auto& entry : fs::directory_iterator(arguments.scenes))
        if (fs::exists(entry.path() / "scene.json"))
            folders.push_back(entry.path().string());
    std::sort(folders.begin(), folders.end());
    if (!arguments.names.empty())
        folders.erase(std::remove_if(folders.begin(), folders.end(),
                                     [&](const std::string& folder) {
                                         return std::find(arguments.names.begin(), arguments.names.end(),
                                                          fs::path(folder).filename()) ==
                                                arguments.names.end();
                                     }),
                      folders.end());
    return folders;
}

// The counters that must not change unnoticed. Passes differ between renderers by design.
nlohmann::json countersOf(const headless::Picture& picture) {
    nlohmann::json frame = toJson(picture.frame);
    frame.erase("passesRun");
    nlohmann::json session = toJson(picture.session), kept;
    for (const char* name :
         {"requests", "bytesReceived", "chunksLoaded", "nodesDecoded", "pointsDecoded", "requestsFailed"})
        kept[name] = session.at(name);
    return {{"frame", frame}, {"session", kept}};
}

// Grey picture of the differences, four times as strong.
Image differenceImage(const Image& a, const Image& b) {
    Image image = a;
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        image.rgba[i] =
            i % 4 == 3
                ? 255
                : static_cast<std::uint8_t>(std::min(255, 4 * std::abs(int(a.rgba[i]) - int(b.rgba[i]))));
    return image;
}

struct Judge {
    const Arguments& arguments;
    const Scene& scene;
    bool passed = true;

    void fail(const std::string& why) {
        std::printf("FAILED %s: %s\n", scene.name.c_str(), why.c_str());
        passed = false;
    }
    std::string workPath(const std::string& ending) const {
        return arguments.work + "/" + scene.name + "." + ending;
    }
    void check(Status status) {
        if (!status.ok())
            fail(status.error().sentence());
    }

    void judgePicture(const Image& actual, const Image& expected, const char* backend, int levels,
                      std::size_t allowed) {
        if (actual.width != expected.width || actual.height != expected.height) {
            fail(cat(backend, ": ", actual.width, " × ", actual.height, " pixels, expected ", expected.width,
                     " × ", expected.height));
            return;
        }
        measure::PixelError apart = measure::pixelError(expected, actual, levels);
        check(headless::writePng(workPath(cat(backend, ".png")), actual));
        std::printf("  %s, %s: largest difference %d, mean %.5f, %llu pixels beyond %d levels\n",
                    scene.name.c_str(), backend, apart.largest, apart.mean,
                    static_cast<unsigned long long>(apart.differing), levels);
        if (apart.differing > allowed) {
            check(headless::writePng(workPath(cat(backend, ".difference.png")),
                                     differenceImage(actual, expected)));
            fail(cat(backend, ": ", apart.differing, " pixels differ by more than ", levels, " levels; ",
                     allowed, " may; see ", workPath(cat(backend, ".difference.png"))));
        }
    }
};

Result<headless::Picture> draw(const Scene& scene, const std::string& cloud, headless::Backend backend) {
    STIPPLE_TRY(source, openFileSource(cloud));
    headless::PictureRequest request = scene.request;
    request.backend = backend;
    return headless::drawPicture(std::move(source), request);
}

bool runScene(const Arguments& arguments, const std::string& folder, bool haveGles) {
    auto scene = readScene(folder);
    if (!scene.ok()) {
        std::printf("FAILED %s\n", scene.error().sentence().c_str());
        return false;
    }
    Judge judge{arguments, *scene};
    auto cloud = makeCloud(scene->cloud, arguments.work);
    if (!cloud.ok()) {
        judge.fail(cloud.error().sentence());
        return false;
    }
    auto software = draw(*scene, *cloud, headless::Backend::software);
    if (!software.ok()) {
        judge.fail(software.error().sentence());
        return false;
    }
    std::string counters = countersOf(*software).dump(2) + "\n";
    if (arguments.update) {
        judge.check(headless::writePng(folder + "/expected.png", software->image));
        std::ofstream(folder + "/expected.json") << counters;
        std::printf("updated %s\n", scene->name.c_str());
        return judge.passed;
    }

    auto expected = headless::readPng(folder + "/expected.png");
    if (!expected.ok()) {
        judge.fail(expected.error().sentence());
        return false;
    }
    judge.judgePicture(software->image, *expected, "software", 0, 0);
    std::ofstream(judge.workPath("counters.json")) << counters;
    std::ifstream file(folder + "/expected.json");
    std::string expectedCounters((std::istreambuf_iterator<char>(file)), {});
    if (counters != expectedCounters)
        judge.fail(
            cat("the counters differ; compare ", judge.workPath("counters.json"), " with expected.json"));

    if (haveGles) {
        auto gles = draw(*scene, *cloud, headless::Backend::gles);
        if (gles.ok())
            judge.judgePicture(gles->image, *expected, "gles", glesLevels,
                               expected->rgba.size() / 4 / glesPixelsPerWrong);
        else
            judge.fail(gles.error().sentence());
    }
    return judge.passed;
}

} // namespace

int main(int argc, char** argv) {
    Arguments arguments = argumentsOf(argc, argv);
    fs::create_directories(arguments.work);
    std::vector<std::string> folders = sceneFolders(arguments);
    if (folders.empty()) {
        std::printf("FAILED: there is no such scene in %s\n", arguments.scenes.c_str());
        return 1;
    }
    bool haveGles = false;
    {
        auto context = headless::EglContext::create();
        haveGles = context.ok();
        if (!haveGles)
            std::printf("GLES skipped: %s\n", context.error().sentence().c_str());
    }
    int failed = 0;
    for (const std::string& folder : folders)
        failed += runScene(arguments, folder, haveGles) ? 0 : 1;
    if (arguments.update) {
        std::printf("The expected files are new. Look at them, then run again without --update.\n");
        return 1;
    }
    std::printf("%zu scenes, %d failed\n", folders.size(), failed);
    return failed == 0 ? 0 : 1;
}
