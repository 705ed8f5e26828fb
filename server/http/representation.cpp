#include "server/http/representation.hpp"

#include "server/http/byte_range.hpp"
#include "server/http/entity_tag.hpp"
#include "server/http/problem.hpp"
#include "shared/base/text.hpp"
#include "shared/io/http_date.hpp"

namespace stipple::server {

namespace {

BodyPart sliceOf(const Representation& representation, ByteRange range) {
    if (const auto* file = std::get_if<std::shared_ptr<const OpenFile>>(&representation.content))
        return FileSlice{*file, range.offset, range.size};
    if (std::holds_alternative<Representation::Elsewhere>(representation.content))
        return FileSlice{nullptr, range.offset, range.size};
    const auto& text = std::get<std::string>(representation.content);
    return text.substr(static_cast<std::size_t>(range.offset), static_cast<std::size_t>(range.size));
}

void setRangeFields(HttpResponse& response, const Representation& representation) {
    response.set("Accept-Ranges", "bytes");
    if (!representation.vary.empty())
        response.set("Vary", representation.vary);
}

// What 200, 206, 304, 412 and 416 all repeat.
void setFields(HttpResponse& response, const Representation& representation) {
    setValidatorFields(response, representation.validators, representation.cacheControl);
    setRangeFields(response, representation);
}

// RFC 9110 §14.6. Any boundary that can't occur in a part's header will do: parts are delimited by their
// Content-Range, but a reader that searches must not find the boundary in the data by chance, so it is long
// and depends on the version.
void setMultipartBody(HttpResponse& response, const Representation& representation,
                      const std::vector<ByteRange>& parts) {
    std::string tag = tagOfText(representation.validators.etag); // "hash-size", in quotes
    std::string boundary = cat("stipple-part-", tag.substr(1, 16));
    // The coding is that of the parts: the multipart body around them is not coded.
    std::string fields = cat("\r\nContent-Type: ", representation.contentType);
    if (!representation.contentCoding.empty())
        fields += cat("\r\nContent-Encoding: ", representation.contentCoding);
    for (const ByteRange& part : parts) {
        response.body.push_back(cat(response.body.empty() ? "" : "\r\n", "--", boundary, fields,
                                    "\r\nContent-Range: ", contentRange(part, representation.sizeBytes()),
                                    "\r\n\r\n"));
        response.body.push_back(sliceOf(representation, part));
    }
    response.body.push_back(cat("\r\n--", boundary, "--\r\n"));
    response.set("Content-Type", cat("multipart/byteranges; boundary=", boundary));
}

} // namespace

Representation Representation::ofText(std::string text, std::string contentType, std::string cacheControl) {
    Validators validators{tagOfText(text), 0};
    return {std::move(text), std::move(contentType), std::move(cacheControl), std::move(validators)};
}

Representation Representation::ofFile(std::shared_ptr<const OpenFile> file, std::string contentType,
                                      std::string cacheControl) {
    Validators validators{file->identity().entityTag(), file->identity().modifiedSeconds()};
    return {std::move(file), std::move(contentType), std::move(cacheControl), std::move(validators)};
}

std::uint64_t Representation::sizeBytes() const {
    if (const auto* elsewhere = std::get_if<Elsewhere>(&content))
        return elsewhere->sizeBytes;
    const auto* file = std::get_if<std::shared_ptr<const OpenFile>>(&content);
    return file ? (*file)->identity().sizeBytes : std::get<std::string>(content).size();
}

void setValidatorFields(HttpResponse& response, const Validators& validators,
                        const std::string& cacheControl) {
    response.set("ETag", validators.etag);
    if (validators.lastModifiedSeconds != 0)
        response.set("Last-Modified", httpDate(validators.lastModifiedSeconds));
    response.set("Cache-Control", cacheControl);
}

std::optional<HttpResponse> answerPreconditions(const HttpRequest& request, const Validators& validators,
                                                const std::string& cacheControl, std::int64_t nowSeconds) {
    switch (evaluatePreconditions(request, validators, nowSeconds)) {
    case Precondition::failed: {
        HttpResponse response = problemResponse(412, "this is not the version that the request asks for");
        setValidatorFields(response, validators, "no-store");
        return response;
    }
    case Precondition::notModified: {
        HttpResponse response;
        response.status = 304;
        setValidatorFields(response, validators, cacheControl);
        return response;
    }
    case Precondition::passed:
        break;
    }
    return std::nullopt;
}

HttpResponse answerRepresentation(const HttpRequest& request, const Representation& representation,
                                  std::int64_t nowSeconds) {
    if (auto answer = answerPreconditions(request, representation.validators, representation.cacheControl,
                                          nowSeconds)) {
        setRangeFields(*answer, representation);
        return *answer;
    }

    std::uint64_t sizeBytes = representation.sizeBytes();
    ResolvedRanges ranges; // HEAD ignores Range (RFC 9110 §14.2)
    if (request.method == "GET" && rangeApplies(request, representation.validators, nowSeconds))
        ranges = resolveRanges(request.field("Range").value_or(""), sizeBytes);
    if (ranges.kind == RangeAnswerKind::unsatisfiable || ranges.kind == RangeAnswerKind::refused) {
        HttpResponse response = problemResponse(
            416, ranges.kind == RangeAnswerKind::refused
                     ? cat("the range is malformed, or names more than ", maxRangesInRequest, " parts")
                     : cat("no byte of the ", sizeBytes, " lies in the range"));
        setFields(response, representation);
        response.set("Cache-Control", "no-store");
        response.set("Content-Range", unsatisfiedRange(sizeBytes));
        return response;
    }

    HttpResponse response;
    setFields(response, representation);
    response.set("Content-Type", representation.contentType);
    if (ranges.parts.size() <= 1 && !representation.contentCoding.empty())
        response.set("Content-Encoding", representation.contentCoding);
    if (ranges.kind == RangeAnswerKind::whole) {
        response.body.push_back(sliceOf(representation, {0, sizeBytes}));
        return response;
    }
    response.status = 206;
    if (ranges.parts.size() == 1) {
        response.set("Content-Range", contentRange(ranges.parts.front(), sizeBytes));
        response.body.push_back(sliceOf(representation, ranges.parts.front()));
    } else {
        setMultipartBody(response, representation, ranges.parts);
    }
    return response;
}

} // namespace stipple::server
