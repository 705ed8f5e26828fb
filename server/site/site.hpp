// From a request to its response: routes, CORS, and what every response carries. Knows no socket. Thread:
// any.
//
//   /                        the page              GET HEAD OPTIONS
//   /api/v1/…                server/api            GET HEAD OPTIONS
//   /clouds/ID.stipple       its file, in ranges   GET HEAD OPTIONS
#pragma once

#include "server/http/message.hpp"
#include "server/http/target.hpp"
#include "server/site/cloud_catalog.hpp"
#include "server/site/page.hpp"

#include <cstdint>
#include <memory>

namespace stipple::server {

inline constexpr std::size_t maxTargetBytes = 4096; // longer: 414

class Site {
  public:
    Site(std::unique_ptr<CloudCatalog> catalog, Page page)
        : catalog_(std::move(catalog)), page_(std::move(page)) {}

    HttpResponse answer(const HttpRequest& request, std::int64_t nowSeconds) const;
    const CloudCatalog& catalog() const { return *catalog_; }

  private:
    HttpResponse route(const HttpRequest& request, std::int64_t nowSeconds) const;
    HttpResponse answerFile(const HttpRequest& request, std::string_view name, std::int64_t nowSeconds) const;

    std::unique_ptr<CloudCatalog> catalog_;
    Page page_;
};

// The response to bytes that are no request; closes the connection. `status`: 400, 431 or 505.
HttpResponse answerUnreadable(int status);

} // namespace stipple::server
