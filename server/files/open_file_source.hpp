// A byte source over a file that is already open, for readers of clouds. Answers inside read(); `changed`
// once the opened bytes may no longer be those that were opened.
#pragma once

#include "server/files/open_file.hpp"
#include "shared/io/byte_source.hpp"

#include <memory>
#include <string>

namespace stipple::server {

// `name` is for messages. Many sources may share one file, each on a thread of its own.
std::unique_ptr<ByteSource> sourceOver(std::shared_ptr<const OpenFile> file, std::string name);

} // namespace stipple::server
