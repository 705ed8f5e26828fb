// A byte source that the browser drives: an address read with fetch, or a File that was dropped on the page.
// Answers arrive between frames and wait here until pump() delivers them.
#pragma once

#include "shared/io/byte_source.hpp"
#include "shared/io/range_answer.hpp"

#include <memory>

namespace stipple::web {

std::unique_ptr<ByteSource> makeFetchSource(const std::string& url);
// `file` is the page's number for a File of `sizeBytes` bytes; it is closed with the source.
std::unique_ptr<ByteSource> makeFileSource(std::uint32_t file, const std::string& name,
                                           std::uint64_t sizeBytes);

// What the page reports about request `request`; unknown (cancelled) requests are ignored.
// Bytes of the body to read, or -1: none, the request is answered.
double acceptHeaders(std::uint32_t request, const RangeAnswer& answer);
// The file of that request is, in part, at hand in the browser's store.
void markStored(std::uint32_t request);
// Where the next `size` bytes of the body are to be put, before the next call into the program; they count as
// here. Null: nowhere, the request is answered (more than it was to be).
std::uint8_t* bodyBuffer(std::uint32_t request, std::size_t size);
void finishBody(std::uint32_t request); // also where bytes are missing
enum class ReadFailure : int {
    network = 0,
    shortBody = 1,
    longBody = 2,
    fileGone = 3,
    notAllowed =
        4, // another origin's server is there, but the browser hides its answer; detail: the page's origin
    mixedContent = 5, // http from an https page; nothing was asked for
    notPrepared = 6   // the page's request hook failed
};
void failRead(std::uint32_t request, ReadFailure failure, const std::string& detail);

} // namespace stipple::web
