#include "server/api/picture_service.hpp"

#include "client/headless/png.hpp"
#include "client/headless/webp.hpp"

#include <algorithm>

namespace stipple::server {

Result<std::shared_ptr<const std::string>>
PictureService::picture(const std::string& key, const std::shared_ptr<const CloudVersion>& cloud,
                        headless::PictureRequest request, std::string_view format,
                        const std::atomic<bool>& stop) {
    request.stop = &stop;
    request.limits.cacheBytes = limits_.sessionCacheBytes;
    using Made = SharedCache<std::string, std::string>::Made;
    auto make = [&]() -> Result<Made> {
        STIPPLE_TRY(picture, draw(cloud, request));
        STIPPLE_TRY(coded, format == "webp" ? headless::encodeWebp(picture.image)
                                            : headless::encodePng(picture.image));
        auto text = std::make_shared<const std::string>(coded.begin(), coded.end());
        std::uint64_t bytes = text->size();
        return Made{std::move(text), bytes};
    };
    return pictures_.get(key, make, stop);
}

Result<headless::Picture> PictureService::draw(const std::shared_ptr<const CloudVersion>& cloud,
                                               const headless::PictureRequest& request) {
    std::string version = cloud->version();
    Session session = takeSession(version);
    if (!session) {
        STIPPLE_TRY(opened, headless::PictureSession::open(cloud->openSource(), request));
        session = std::move(opened);
    }
    auto picture = session->draw(request);
    if (picture) // after an error it is not to be used again
        giveSession(version, std::move(session));
    return picture;
}

PictureService::Session PictureService::takeSession(const std::string& version) {
    std::lock_guard lock(mutex_);
    auto found = std::find_if(sessions_.begin(), sessions_.end(),
                              [&](const auto& entry) { return entry.first == version; });
    if (found == sessions_.end())
        return nullptr;
    Session session = std::move(found->second);
    sessions_.erase(found);
    ++sessionsReused_;
    return session;
}

void PictureService::giveSession(const std::string& version, Session session) {
    std::list<std::pair<std::string, Session>> ended; // without the lock
    std::lock_guard lock(mutex_);
    sessions_.emplace_front(version, std::move(session));
    while (sessions_.size() > limits_.sessions)
        ended.splice(ended.begin(), sessions_, std::prev(sessions_.end()));
}

} // namespace stipple::server
