// Room on disk for answers that can't be sent while they are made: files without a name, which go when the
// last byte is sent, or with the process. All of them together are bounded. Thread: any; a sink: one.
#pragma once

#include "server/files/open_file.hpp"
#include "shared/io/byte_sink.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

namespace stipple {
class ScratchFile;
}

namespace stipple::server {

class ScratchSpace {
  public:
    // The error of a sink that there is no room for.
    static constexpr const char* noRoomText =
        "the server has no room for another answer that is made as a file";

    // `maxBytes`: of all files at once.
    ScratchSpace(std::string folder, std::uint64_t maxBytes);

    // Of the room, what one file holds. Given back with the last who holds it.
    class Share {
      public:
        explicit Share(std::shared_ptr<ScratchSpace> space) : space_(std::move(space)) {}
        ~Share();
        Share(const Share&) = delete;
        Share& operator=(const Share&) = delete;
        bool grow(std::uint64_t bytes); // false: there is no room

      private:
        std::shared_ptr<ScratchSpace> space_;
        std::uint64_t bytes_ = 0;
    };

    const std::string& folder() const { return folder_; }
    std::uint64_t maxBytes() const { return maxBytes_; }
    std::uint64_t usedBytes() const { return used_; }

  private:
    std::string folder_;
    std::uint64_t maxBytes_;
    std::atomic<std::uint64_t> used_{0};
};

// A file in that room. Errors: writeFailed (the disk), limitExceeded (there is no room now).
class ScratchSink final : public ByteSink {
  public:
    static Result<std::unique_ptr<ScratchSink>> open(std::shared_ptr<ScratchSpace> space);
    ~ScratchSink() override;

    bool canOverwrite() const override { return true; }
    Status overwrite(std::uint64_t offset, ByteSpan bytes) override;
    Status finish() override;
    std::string name() const override { return "the temporary file"; }

    // To be called before the sink is given away: where finish() puts the file to send. It keeps the room
    // until it goes.
    using FilePlace = std::shared_ptr<std::shared_ptr<const OpenFile>>;
    FilePlace place() const { return place_; }

  private:
    ScratchSink(std::unique_ptr<ScratchFile> file, std::shared_ptr<ScratchSpace> space);
    Status put(ByteSpan bytes) override;

    std::unique_ptr<ScratchFile> file_;
    std::shared_ptr<ScratchSpace::Share> share_;
    FilePlace place_ = std::make_shared<std::shared_ptr<const OpenFile>>();
};

} // namespace stipple::server
