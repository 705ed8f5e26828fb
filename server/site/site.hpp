// From a request to its response: routes, who may read what, and what every response carries. Knows no
// socket. Thread: any.
//
//   /                        the page              GET HEAD OPTIONS
//   /api/v1/…                server/api            GET HEAD OPTIONS
//   /clouds/ID.stipple       its file, in ranges   GET HEAD OPTIONS
#pragma once

#include "server/access/access_control.hpp"
#include "server/api/api_resources.hpp"
#include "server/http/cors.hpp"
#include "server/http/handler.hpp"
#include "server/http/target.hpp"
#include "server/site/cloud_catalog.hpp"
#include "server/site/page.hpp"

#include <cstdint>
#include <memory>

namespace stipple::server {

inline constexpr std::size_t maxTargetBytes = 8192; // longer: 414; polygons of some 400 corners fit

struct SiteOptions {
    std::unique_ptr<AccessControl> access; // null: every cloud is public
    CorsRules cors;
    ApiLimits api = {};
};

class Site final : public RequestHandler {
  public:
    Site(std::unique_ptr<CloudCatalog> catalog, Page page, SiteOptions options = {})
        : catalog_(std::move(catalog)), resources_(std::make_unique<ApiResources>(options.api)),
          page_(std::move(page)), access_(std::move(options.access)), cors_(std::move(options.cors)) {}

    Answer answer(const HttpRequest& request, std::int64_t nowSeconds) const override;
    void complete(const HttpRequest& request, HttpResponse& response) const override;
    void spareDescriptors() const override { catalog_->closeHalf(); }
    std::vector<Measurement> measurements() const override; // clouds, caches, and which version this is
    std::string userOf(const HttpRequest& request) const override; // the name of its token
    const CloudCatalog& catalog() const { return *catalog_; }
    AccessControl* access() const { return access_.get(); } // null: every cloud is public

  private:
    std::shared_ptr<const AccessRules> rules() const { return access_ ? access_->rules() : nullptr; }
    bool isForAll(const HttpRequest& request, const HttpResponse& response) const;
    // Who routes: the thread of an event loop, which never waits, or a job's.
    enum class MayWait { no, yes };
    Answer route(const HttpRequest& request, std::int64_t nowSeconds, MayWait mayWait) const;
    Answer routeRead(const HttpRequest& request, Target target, std::int64_t nowSeconds,
                     MayWait mayWait) const;
    Answer answerFile(const HttpRequest& request, const std::string& id, std::int64_t nowSeconds,
                      MayWait mayWait) const;
    Job answerByJob(const HttpRequest& request, const std::string& id, std::int64_t nowSeconds) const;
    Status answerWaiting(const HttpRequest& request, const std::string& id, std::int64_t nowSeconds,
                         AnswerWriter& writer) const;

    std::unique_ptr<CloudCatalog> catalog_;
    std::unique_ptr<ApiResources> resources_;
    Page page_;
    std::unique_ptr<AccessControl> access_;
    CorsRules cors_;
};

} // namespace stipple::server
