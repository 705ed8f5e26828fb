// A GET or HEAD on something that has bytes and a version: preconditions, ranges, and the fields that belong
// to each status (RFC 9110 §8, §13, §14, §15). Pure but for what FileSlice keeps open.
#pragma once

#include "server/http/message.hpp"
#include "server/http/preconditions.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>

namespace stipple::server {

struct Representation {
    struct Elsewhere { // its slices have no file
        std::uint64_t sizeBytes = 0;
    };
    std::variant<std::string, std::shared_ptr<const OpenFile>, Elsewhere> content;
    std::string contentType;
    std::string cacheControl;
    Validators validators;
    std::string contentCoding = {}; // "br"; empty: none. Size and ranges are of the coded bytes (§14.1.2)
    std::string vary = {};          // field names by which another one might have been chosen; empty: none

    static Representation ofText(std::string text, std::string contentType, std::string cacheControl);
    static Representation ofFile(std::shared_ptr<const OpenFile> file, std::string contentType,
                                 std::string cacheControl);
    std::uint64_t sizeBytes() const;
};

// 304 or 412 where the request's conditions say so; nothing: go on. `cacheControl` is that of the 304.
std::optional<HttpResponse> answerPreconditions(const HttpRequest& request, const Validators& validators,
                                                const std::string& cacheControl, std::int64_t nowSeconds);
// ETag, Last-Modified and Cache-Control.
void setValidatorFields(HttpResponse& response, const Validators& validators,
                        const std::string& cacheControl);

// 200, 206 (one part, or multipart/byteranges for several), 304, 412 or 416.
HttpResponse answerRepresentation(const HttpRequest& request, const Representation& representation,
                                  std::int64_t nowSeconds);

} // namespace stipple::server
