// More points than memory holds, sorted into cells.
//
//   RowPool    a fixed number of buffers in memory, and a scratch file for what does not fit
//   RowStore   cells; each has its rows in blocks of one buffer's size
//
// A block fills in memory. When every buffer is taken, the oldest full block goes to the file and its buffer
// is used again, so memory is constant; where no block is full, the fullest quarter of them goes. What that
// costs depends on the number of buffers, not on that of the cells. What has been drained gives back its
// buffers and its place on the disk.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"
#include "shared/io/scratch_file.hpp"

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace stipple {

class RowStore;

// Thread: any. Must outlive its stores.
class RowPool {
  public:
    static constexpr std::size_t blockBytes = 64 * 1024;

    // Buffers of `ramBytes` together (16 at least). `file` may be null: then nothing can be moved out, and
    // running out of buffers is limitExceeded.
    RowPool(std::size_t ramBytes, ScratchFile* file);

    ScratchFile* file() const { return file_; }
    // Bytes that went to the file so far.
    std::uint64_t spilledBytes() const { return spilledBytes_; }

  private:
    friend class RowStore;
    struct Place {
        RowStore* store;
        std::size_t cell, block;
    };
    using Buffer = std::unique_ptr<std::uint8_t[]>;

    Result<Buffer> acquire();
    void release(Buffer buffer);
    void note(Place block, bool isFull); // that it is in memory
    void forget(const RowStore* store);
    Result<Buffer> moveOneOut();
    Result<std::size_t> movePartsOut(); // how many

    ScratchFile* file_;
    std::size_t most_, allocated_ = 0;
    std::mutex mutex_;
    std::vector<Buffer> free_;
    // Blocks in memory; entries may be out of date.
    std::deque<Place> full_; // oldest first
    std::vector<Place> open_;
    std::mutex moving_; // one thread at a time looks for parts to move out
    std::atomic<std::uint64_t> spilledBytes_{0};
};

class RowStore {
  public:
    // Rows of 1 to RowPool::blockBytes bytes.
    RowStore(RowPool& pool, std::size_t rowBytes, std::size_t cells);
    ~RowStore();
    RowStore(const RowStore&) = delete;
    RowStore& operator=(const RowStore&) = delete;

    std::size_t cells() const { return cells_.size(); }
    std::uint64_t count(std::size_t cell) const { return cells_[cell].count; }

    // Thread: any.
    Status append(std::size_t cell, const std::uint8_t* rows, std::size_t count);

    // Hands over a cell's rows, block by block. Unless `keep`, they leave memory; what is in the file stays
    // there until forget(). Thread: any, one per cell.
    Status drain(std::size_t cell, bool keep,
                 const std::function<Status(const std::uint8_t* rows, std::size_t count)>& take);
    // Gives the cell's place in the file back.
    void forget(std::size_t cell);

    // For checkpoints: every row to the file (what stays in memory stays there too); then what the store
    // is, in a form that restore() understands. Thread: one, while nobody appends.
    Status saveAll();
    void describe(ByteWriter& to) const;
    // False if the bytes are no description of such a store.
    bool restore(ByteReader& from);

  private:
    friend class RowPool;
    static constexpr std::uint64_t nowhere = ~std::uint64_t{0};
    struct Block {
        RowPool::Buffer ram;
        std::uint64_t offset = nowhere; // in the file; a whole block's bytes are reserved there
        std::uint32_t rows = 0, saved = 0;
    };
    struct Cell {
        std::vector<Block> blocks;
        std::uint64_t count = 0;
        std::mutex mutex;
    };

    Status save(Block& block);
    // Moves a block to the file and returns its buffer; null if it is not in memory.
    Result<RowPool::Buffer> moveOut(std::size_t cell, std::size_t block);
    std::uint32_t rowsInMemory(std::size_t cell, std::size_t block);

    RowPool& pool_;
    std::size_t rowBytes_;
    std::uint32_t rowsPerBlock_;
    std::deque<Cell> cells_; // in place: mutexes don't move
};

} // namespace stipple
