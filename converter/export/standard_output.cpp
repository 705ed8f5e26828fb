#include "converter/export/standard_output.hpp"

#include "shared/base/text.hpp"

#include <cerrno>
#include <cstring>
#include <unistd.h>

namespace stipple {

namespace {

class StandardOutputSink final : public ByteSink {
  public:
    Status finish() override { return {}; }
    std::string name() const override { return "standard output"; }

  private:
    Status put(ByteSpan bytes) override {
        while (!bytes.empty()) {
            ssize_t part = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
            if (part < 0 && errno == EINTR)
                continue;
            if (part <= 0)
                return Error{ErrorCode::writeFailed, cat("can't be written: ", std::strerror(errno)), name(),
                             ""};
            bytes = bytes.subspan(static_cast<std::size_t>(part));
        }
        return {};
    }
};

} // namespace

std::unique_ptr<ByteSink> standardOutputSink() {
    return std::make_unique<StandardOutputSink>();
}

} // namespace stipple
