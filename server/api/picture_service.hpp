// Draws pictures of clouds and keeps them: coded pictures by what was asked for, and opened clouds with the
// nodes they have decoded, for other pictures of the same cloud. Thread: any.
#pragma once

#include "client/headless/picture.hpp"
#include "server/cache/shared_cache.hpp"
#include "server/site/cloud_version.hpp"

#include <atomic>
#include <list>
#include <memory>
#include <mutex>
#include <string>

namespace stipple::server {

struct PictureLimits {
    std::uint64_t pictureBytes = 64ull << 20;       // coded pictures kept
    std::size_t sessions = 4;                       // opened clouds kept while nobody draws from them
    std::uint64_t sessionCacheBytes = 128ull << 20; // decoded nodes of each
};

class PictureService {
  public:
    explicit PictureService(const PictureLimits& limits = {})
        : limits_(limits), pictures_(limits.pictureBytes) {}

    // The coded picture, drawn unless it is kept. `key` names version, request and format (keptKeyOf()). Of
    // several threads that want the same picture one draws it. Errors: those of drawPicture.
    Result<std::shared_ptr<const std::string>>
    picture(const std::string& key, const std::shared_ptr<const CloudVersion>& cloud,
            headless::PictureRequest request, std::string_view format, const std::atomic<bool>& stop);
    // Null: it is not kept.
    std::shared_ptr<const std::string> kept(const std::string& key) { return pictures_.find(key); }

    CacheCounts counts() const { return pictures_.counts(); }
    std::uint64_t sessionsReused() const { return sessionsReused_; }

  private:
    using Session = std::unique_ptr<headless::PictureSession>;
    Result<headless::Picture> draw(const std::shared_ptr<const CloudVersion>& cloud,
                                   const headless::PictureRequest& request);
    Session takeSession(const std::string& version);
    void giveSession(const std::string& version, Session session);

    const PictureLimits limits_;
    SharedCache<std::string, std::string> pictures_;
    std::mutex mutex_;
    std::list<std::pair<std::string, Session>> sessions_; // by version, most recently used first
    std::atomic<std::uint64_t> sessionsReused_{0};
};

} // namespace stipple::server
