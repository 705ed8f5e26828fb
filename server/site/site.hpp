// From a request to its response: routes, CORS, and what every response carries. Knows no socket. Thread:
// any.
//
//   /                        the page              GET HEAD OPTIONS
//   /api/v1/…                server/api            GET HEAD OPTIONS
//   /clouds/ID.stipple       its file, in ranges   GET HEAD OPTIONS
#pragma once

#include "server/http/handler.hpp"
#include "server/http/target.hpp"
#include "server/site/cloud_catalog.hpp"
#include "server/site/page.hpp"

#include <cstdint>
#include <memory>

namespace stipple::server {

inline constexpr std::size_t maxTargetBytes = 4096; // longer: 414

class Site final : public RequestHandler {
  public:
    Site(std::unique_ptr<CloudCatalog> catalog, Page page)
        : catalog_(std::move(catalog)), page_(std::move(page)) {}

    Answer answer(const HttpRequest& request, std::int64_t nowSeconds) const override;
    void complete(const HttpRequest& request, HttpResponse& response) const override;
    const CloudCatalog& catalog() const { return *catalog_; }

  private:
    Answer route(const HttpRequest& request, std::int64_t nowSeconds) const;
    HttpResponse answerFile(const HttpRequest& request, std::string_view name, std::int64_t nowSeconds) const;

    std::unique_ptr<CloudCatalog> catalog_;
    Page page_;
};

} // namespace stipple::server
