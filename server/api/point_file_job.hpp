// The job that writes points of a cloud as a file into an answer.
#pragma once

#include "server/api/api_resources.hpp"
#include "server/api/point_formats.hpp"
#include "server/api/points_request.hpp"
#include "server/api/validity.hpp"
#include "server/http/job.hpp"
#include "shared/select/cloud_filter.hpp"

#include <memory>
#include <string>

namespace stipple::server {

// Everything about the answer that is known before points are read. Owns what it needs.
struct PointFile {
    std::shared_ptr<const CloudVersion> cloud;
    CloudFilter filter; // over cloud->metadata
    PointsRequest request;
    CloudMetadata metadata;      // with station and offset where the filter has a corridor
    std::vector<int> attributes; // of that metadata: what is written
    ExportFormat format = ExportFormat::las;
    HttpResponse head; // 200, with every field but the count
    PointLimits limits;
    std::shared_ptr<ScratchSpace> scratch;
};

// Errors: those of walkPoints() and of formats; limitExceeded for more than the limits; cancelled once the
// client has left. Before the first byte they become problem documents.
Status writePointFile(const PointFile& file, AnswerWriter& writer);

} // namespace stipple::server
