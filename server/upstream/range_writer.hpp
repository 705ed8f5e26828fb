// Answers whose bytes lie at another server: parts of no file (FileSlice) are filled from its blocks.
#pragma once

#include "server/http/job.hpp"
#include "server/http/message.hpp"
#include "server/upstream/upstream_version.hpp"

namespace stipple::server {

// An answer up to this size is made as a whole, a larger one is sent while it comes.
inline constexpr std::uint64_t wholeAnswerBytes = 1024 * 1024;

// Whether some part of the body is elsewhere.
bool needsBytes(const HttpResponse& response);

// Fills in what is held already; false, and `response` is as it was, if that is not all, or too much to
// copy. Doesn't wait.
bool fillFromHeld(HttpResponse& response, UpstreamVersion& version);

// Waits for the bytes and writes the answer. Errors: before anything was answered those of
// UpstreamVersion::blocks; afterwards networkFailed, and the answer is cut: never bytes of two versions.
Status writeRanges(HttpResponse response, UpstreamVersion& version, AnswerWriter& writer);

} // namespace stipple::server
