#include "client/web/viewer.hpp"

#include "client/core/attribute_needs.hpp"
#include "client/core/cloud_facts.hpp"
#include "client/core/json.hpp"
#include "client/render/picture_parts.hpp"
#include "client/web/browser_source.hpp"
#include "client/web/host.hpp"

#include <nlohmann/json.hpp>

#include <emscripten/heap.h>

#include <utility>

namespace stipple::web {
namespace {

Error contextError() {
    return {ErrorCode::unsupported, say("this browser gives the page no WebGL2"), "",
            say("switch hardware acceleration on, or use another browser")};
}

// A frame that brings more to the GPU than this is late on many machines.
SessionLimits pageLimits() {
    SessionLimits limits;
    limits.uploadBytes = 4 << 20;
    return limits;
}

} // namespace

Viewer::Viewer()
    : decoder_(std::make_unique<WorkerDecoder>()), session_(ViewSession::create(*decoder_, pageLimits())) {
    session_->setViewport(width_, height_);
}

Result<std::unique_ptr<Viewer>> Viewer::create() {
    std::unique_ptr<Viewer> viewer(new Viewer);
    STIPPLE_CHECK(viewer->contextRestored());
    return viewer;
}

CloudId Viewer::add(std::unique_ptr<ByteSource> source, const std::string& name, const BoxD& expected) {
    if (session_->clouds().empty() && !cameraWasSet_)
        pendingView_ = NamedView::iso;
    return session_->addCloud(std::move(source), name, expected);
}

CloudId Viewer::addUrl(const std::string& url, const std::string& name, const BoxD& expected) {
    return add(makeFetchSource(url), name, expected);
}

CloudId Viewer::addFile(std::uint32_t file, const std::string& name, std::uint64_t sizeBytes) {
    return add(makeFileSource(file, name, sizeBytes), name);
}

void Viewer::removeCloud(CloudId id) {
    session_->removeCloud(id);
    decoder_->forgetCloud(id);
    cameraWasSet_ &= !session_->clouds().empty();
}

void Viewer::setVisible(CloudId id, bool visible) {
    session_->setVisible(id, visible);
}

std::string Viewer::cloudsJson() const {
    nlohmann::json list = nlohmann::json::array();
    for (const CloudState& cloud : session_->clouds())
        list.push_back(toJson(cloud));
    return jsonText(list);
}

std::string Viewer::cloudFactsJson(CloudId id) const {
    for (const CloudState& cloud : session_->clouds())
        if (cloud.id == id && cloud.metadata)
            return jsonText(stipple::cloudFactsJson(*cloud.metadata));
    return jsonText(nullptr);
}

void Viewer::resize(int width, int height, bool inParts) {
    width_ = width;
    height_ = height;
    inParts_ = inParts;
    partsBegun_ = false;
    if (!inParts) {
        partTarget_ = {};
        partPixels_ = {};
    }
    session_->setViewport(width, height);
}

Status Viewer::setLimits(std::string_view json) {
    STIPPLE_TRY(value, parseJson(json, "limits"));
    STIPPLE_TRY(limits, limitsFromJson(value, session_->limits()));
    session_->setLimits(limits);
    return {};
}

std::string Viewer::limitsJson() const {
    return jsonText(toJson(session_->limits()));
}

void Viewer::load() {
    session_->load();
    if (!pendingViewIsDue())
        return;
    applyPendingView();
    session_->load();
}

// What was skipped may have changed where the picture has not.
void Viewer::keepCounters() {
    FrameCounters before = std::exchange(drawn_.counters, session_->plan().counters);
    drawn_.counters.passesRun = before.passesRun;
    drawn_.counters.passesSkipped = before.passesSkipped;
}

bool Viewer::frame() {
    if (!renderer_ || partsBegun_)
        return false;
    bool isNew = session_->update();
    if (session_->regionsMustGoOn())
        stippleHostWake();
    if (pendingViewIsDue()) {
        applyPendingView();
        isNew = session_->update() || isNew;
    }
    if (!isNew && !drawAgain_) {
        keepCounters();
        return false;
    }
    drawAgain_ = false;
    drawn_ = session_->plan();
    if (drawn_.counters.nodesDelayed > 0)
        stippleHostWake(); // they come with the next frame
    if (inParts_)
        return true;
    Status status = renderer_->draw(drawn_);
    drawError_ = status.ok() ? std::nullopt : std::optional(status.error());
    return true;
}

Result<ByteSpan> Viewer::drawPart(const PictureWindow& kept) {
    if (!renderer_)
        return contextError();
    partsBegun_ = true;
    PictureWindow part = withMargin(kept, drawn_);
    STIPPLE_CHECK(partTarget_.resize(part.width, part.height));
    drawn_.part = part;
    Status drawn = renderer_->draw(drawn_, partTarget_.framebuffer.id());
    drawn_.part = {};
    STIPPLE_CHECK(drawn);
    partPixels_.resize(4 * static_cast<std::size_t>(kept.width) * static_cast<std::size_t>(kept.height));
    glReadPixels(kept.left - part.left, kept.bottom - part.bottom, kept.width, kept.height, GL_RGBA,
                 GL_UNSIGNED_BYTE, partPixels_.data());
    return ByteSpan(partPixels_);
}

bool Viewer::settled() const {
    return !pendingViewIsDue() && session_->settled();
}

std::string Viewer::countersJson() const {
    return jsonText({{"frame", toJson(drawn_.counters)},
                     {"session", toJson(session_->counters())},
                     {"gpuBytes", renderer_ ? renderer_->gpuBytes() : 0},
                     {"heapBytes", emscripten_get_heap_size()},
                     {"decodesPending", decoder_->pending()},
                     {"settled", settled()}});
}

std::string Viewer::errorsJson() const {
    nlohmann::json list = nlohmann::json::array(); // what clouds lack is in their states
    if (drawError_)
        list.push_back(drawError_->said());
    if (renderer_ && !renderer_->limitation().empty())
        list.push_back(renderer_->limitation().marked());
    for (const CloudState& cloud : session_->clouds())
        if (cloud.metadata && cloud.visible)
            if (Phrase lack = lackOf(session_->style(), *cloud.metadata, cloud.name); !lack.empty())
                list.push_back(lack.marked());
    return jsonText(list);
}

void Viewer::contextLost() {
    renderer_.reset();
    partTarget_ = {};
}

Status Viewer::contextRestored() {
    if (!stippleHostCreateContext())
        return contextError();
    STIPPLE_TRY(renderer, GlesRenderer::create());
    renderer_ = std::move(renderer);
    drawAgain_ = true;
    return {};
}

} // namespace stipple::web
