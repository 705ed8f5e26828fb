// What the page does for the viewer: fetching, files that were dropped, workers, the canvas. Implemented in
// TypeScript (www/src/wasm/host.ts), reached through host.js. Each call returns at once; answers come back
// through the exports named beside it (viewer_exports.cpp). Offsets and sizes are doubles, exact to 2^53.
#pragma once

#include <cstddef>
#include <cstdint>

extern "C" {

// Starts a GET of `url` with `Range: rangeField`. Answered by stipple_read_headers, then by a
// stipple_read_buffer for each piece of the body and stipple_read_done, or by stipple_read_failed.
void stippleHostFetch(std::uint32_t request, const char* url, const char* rangeField);
// Reads bytes [offset, offset + size) of a File the page holds. Answered likewise, without headers.
void stippleHostReadFile(std::uint32_t request, std::uint32_t file, double offset, double size);
void stippleHostAbort(std::uint32_t request); // no answer comes any more
void stippleHostCloseFile(std::uint32_t file);

// Every worker keeps what `message` (client/web/cloud_message.hpp) says of cloud `cloud`, or forgets it.
void stippleHostDescribeCloud(std::uint32_t cloud, const std::uint8_t* message, std::size_t size);
void stippleHostForgetCloud(std::uint32_t cloud);
// Has a worker decode a job; the bytes are copied before this returns. Answered by stipple_decode_answer.
void stippleHostDecode(std::uint32_t job, const std::uint8_t* message, std::size_t messageSize,
                       const std::uint8_t* picture, std::size_t pictureSize, const std::uint8_t* attributes,
                       std::size_t attributesSize);

// Something arrived: a frame should be asked for.
void stippleHostWake();

// Makes a WebGL2 context of the page's canvas current; false: the browser has none.
bool stippleHostCreateContext();

} // extern "C"
