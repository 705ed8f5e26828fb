// Reference pictures, kept on disk: they take seconds each, and the same ones are needed again and again.
#pragma once

#include "client/reference/render_cloud.hpp"

#include <optional>
#include <string>

namespace stipple::bench {

// Everything that a reference picture depends on.
struct ReferenceRequest {
    Camera camera;
    Style style; // with ranges
    int width = 0, height = 0, samples = 1;
};

class ReferenceCache {
  public:
    // `folder` is made when the first picture is put in; empty: nothing is kept. Pictures of clouds whose
    // metadata differ in points, grid or bounds, and those of another referenceVersion, don't meet.
    ReferenceCache(std::string folder, const CloudMetadata& metadata);

    bool has(const ReferenceRequest& request) const;
    // None if it isn't there, or what is there can't be used.
    std::optional<DepthImage> find(const ReferenceRequest& request) const;
    Status put(const ReferenceRequest& request, const DepthImage& picture) const;

  private:
    std::string keyOf(const ReferenceRequest& request) const;
    std::string pathOf(const std::string& key) const;

    std::string folder_;
    std::string cloud_; // JSON
};

} // namespace stipple::bench
