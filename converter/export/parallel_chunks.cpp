#include "converter/export/parallel_chunks.hpp"

#include "converter/export/ordered_work.hpp"
#include "converter/parallel/parallel.hpp"

#include <new>

namespace stipple {

namespace {
class ParallelChunks final : public las::ChunkWork {
  public:
    explicit ParallelChunks(int threads) : most_(2 * static_cast<std::size_t>(threads)), work_(threads) {}

    void submit(std::function<Bytes()> compress) override {
        work_.submit([compress = std::move(compress)]() -> Result<Bytes> {
            try {
                return compress();
            } catch (const std::bad_alloc&) {
                return outOfMemory();
            }
        });
    }
    std::size_t waiting() const override { return work_.waiting(); }
    std::size_t mostWaiting() const override { return most_; }
    Result<Bytes> take() override { return work_.take(); }

  private:
    std::size_t most_;
    OrderedWork<Result<Bytes>> work_;
};
} // namespace

std::function<std::unique_ptr<las::ChunkWork>()> parallelChunks(int threads) {
    if (threads <= 1)
        return nullptr;
    return [threads] { return std::make_unique<ParallelChunks>(threads); };
}

} // namespace stipple
