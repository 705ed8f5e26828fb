// The API over a small cloud in a folder of its own, asked without a socket.
#pragma once

#include "server/api/api.hpp"
#include "server/api/picture_service.hpp"
#include "server/site/cloud_catalog.hpp"
#include "tests/support/small_cloud.hpp"
#include "tests/support/temporary_folder.hpp"

#include <nlohmann/json.hpp>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace stipple::test {

struct ApiAnswer {
    int status = 0;
    server::HttpResponse response;
    std::string body;
    nlohmann::json json; // of the body, if it is JSON
    std::string field(std::string_view name) const { return response.field(name); }
};

class ApiFixture {
  public:
    explicit ApiFixture(const SmallCloudOptions& options = {}, const server::ApiLimits& limits = {});

    // Over a cloud that is there already; its id is the file's stem.
    explicit ApiFixture(const std::string& path, const server::ApiLimits& limits = {});

    using Fields = std::vector<std::pair<std::string_view, std::string_view>>;
    // The whole answer; a job is run to its end on this thread.
    ApiAnswer ask(const std::string& target, Fields fields = {}, std::string_view method = "GET") const;

    std::shared_ptr<const server::CloudVersion> cloudVersion() const { return *catalog_->current("small"); }
    server::PictureService& pictures() const { return resources_.pictures(); }
    const SmallCloud& cloud() const { return cloud_; } // of id "small"
    std::string version() const { return ask("/api/v1/clouds/small").json["version"]; }
    const server::ApiResources& resources() const { return resources_; }
    std::string path() const { return folder_.file("small.stipple"); }

  private:
    TemporaryFolder folder_;
    SmallCloud cloud_;
    std::unique_ptr<server::CloudCatalog> catalog_;
    mutable server::ApiResources resources_;
};

} // namespace stipple::test
