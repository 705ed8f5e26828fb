#include "shared/io/byte_source.hpp"

#include <optional>

namespace stipple {

Result<Bytes> readNow(ByteSource& source, ByteRange range) {
    std::optional<Result<Bytes>> answer;
    source.read(range, [&](Result<Bytes> result) { answer.emplace(std::move(result)); });
    while (!answer)
        source.pump(std::chrono::milliseconds(100));
    return std::move(*answer);
}

} // namespace stipple
