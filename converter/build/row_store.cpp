#include "converter/build/row_store.hpp"

#include <algorithm>
#include <cstring>

namespace stipple {

namespace {
constexpr std::size_t fewestBuffers = 16;
}

RowPool::RowPool(std::size_t ramBytes, ScratchFile* file)
    : file_(file), most_(std::max(fewestBuffers, ramBytes / blockBytes)) {}

Result<RowPool::Buffer> RowPool::acquire() {
    {
        std::lock_guard lock(mutex_);
        if (!free_.empty()) {
            Buffer buffer = std::move(free_.back());
            free_.pop_back();
            return buffer;
        }
        if (allocated_ < most_) {
            ++allocated_;
            return std::make_unique_for_overwrite<std::uint8_t[]>(blockBytes);
        }
    }
    return moveOneOut();
}

void RowPool::release(Buffer buffer) {
    if (!buffer)
        return;
    std::lock_guard lock(mutex_);
    free_.push_back(std::move(buffer));
}

void RowPool::noteFull(Full full) {
    std::lock_guard lock(mutex_);
    full_.push_back(full);
}

void RowPool::add(RowStore* store) {
    std::lock_guard lock(mutex_);
    stores_.push_back(store);
}

void RowPool::forget(const RowStore* store) {
    std::lock_guard lock(mutex_);
    std::erase_if(full_, [&](const Full& full) { return full.store == store; });
    std::erase(stores_, store);
}

// The oldest full block; where there is none, one that is half full, a quarter full …
Result<RowPool::Buffer> RowPool::moveOneOut() {
    if (!file_)
        return Error{ErrorCode::limitExceeded, "the points do not fit the memory allowed", "",
                     "allow more with --memory"};
    for (;;) {
        Full full{};
        {
            std::lock_guard lock(mutex_);
            if (full_.empty())
                break;
            full = full_.front();
            full_.pop_front();
        }
        STIPPLE_TRY(buffer, full.store->moveOut(full.cell, full.block, 1));
        if (buffer)
            return std::move(buffer);
    }
    std::vector<RowStore*> stores;
    {
        std::lock_guard lock(mutex_);
        stores = stores_;
    }
    for (std::uint32_t part = 2; part != 0; part *= 2)
        for (RowStore* store : stores) {
            STIPPLE_TRY(buffer, store->moveOutPartial(std::max(1u, store->rowsPerBlock_ / part)));
            if (buffer)
                return std::move(buffer);
        }
    return Error{ErrorCode::limitExceeded, "no buffer is left for the points", "",
                 "allow more memory with --memory, or fewer threads"};
}

RowStore::RowStore(RowPool& pool, std::size_t rowBytes, std::size_t cells)
    : pool_(pool), rowBytes_(rowBytes),
      rowsPerBlock_(static_cast<std::uint32_t>(RowPool::blockBytes / rowBytes)), cells_(cells) {
    pool_.add(this);
}

RowStore::~RowStore() {
    pool_.forget(this);
    for (Cell& cell : cells_)
        for (Block& block : cell.blocks)
            pool_.release(std::move(block.ram));
}

Status RowStore::append(std::size_t index, const std::uint8_t* rows, std::size_t count) {
    Cell& cell = cells_[index];
    RowPool::Buffer spare; // taken without the cell's lock, as that may have to wait for another cell
    while (count > 0) {
        bool filled = false;
        std::size_t filledBlock = 0;
        {
            std::lock_guard lock(cell.mutex);
            bool hasRoom =
                !cell.blocks.empty() && cell.blocks.back().ram && cell.blocks.back().rows < rowsPerBlock_;
            if (!hasRoom && spare) {
                cell.blocks.emplace_back().ram = std::move(spare);
                hasRoom = true;
            }
            if (hasRoom) {
                Block& block = cell.blocks.back();
                std::size_t part = std::min<std::size_t>(count, rowsPerBlock_ - block.rows);
                std::memcpy(block.ram.get() + block.rows * rowBytes_, rows, part * rowBytes_);
                block.rows += static_cast<std::uint32_t>(part);
                cell.count += part;
                rows += part * rowBytes_;
                count -= part;
                filled = block.rows == rowsPerBlock_;
                filledBlock = cell.blocks.size() - 1;
            }
        }
        if (filled)
            pool_.noteFull({this, index, filledBlock});
        if (count > 0 && !spare) {
            STIPPLE_TRY(buffer, pool_.acquire());
            spare = std::move(buffer);
        }
    }
    pool_.release(std::move(spare));
    return {};
}

Status RowStore::save(Block& block) {
    if (block.saved == block.rows)
        return {};
    if (!pool_.file_)
        return Error{ErrorCode::limitExceeded, "there is no file for temporary points", "", ""};
    if (block.offset == nowhere)
        block.offset = pool_.file_->reserve(RowPool::blockBytes);
    std::size_t from = block.saved * rowBytes_, size = (block.rows - block.saved) * rowBytes_;
    STIPPLE_CHECK(pool_.file_->write(block.offset + from, ByteSpan(block.ram.get() + from, size)));
    pool_.spilledBytes_ += size;
    block.saved = block.rows;
    return {};
}

Result<RowPool::Buffer> RowStore::moveOut(std::size_t index, std::size_t number, std::uint32_t leastRows) {
    Cell& cell = cells_[index];
    std::lock_guard lock(cell.mutex);
    if (number >= cell.blocks.size())
        return RowPool::Buffer{};
    Block& block = cell.blocks[number];
    if (!block.ram || block.rows < leastRows)
        return RowPool::Buffer{};
    STIPPLE_CHECK(save(block));
    return std::move(block.ram);
}

Result<RowPool::Buffer> RowStore::moveOutPartial(std::uint32_t leastRows) {
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        std::size_t index = nextPartial_++ % cells_.size(), last = 0;
        {
            std::lock_guard lock(cells_[index].mutex);
            if (cells_[index].blocks.empty())
                continue;
            last = cells_[index].blocks.size() - 1;
        }
        STIPPLE_TRY(buffer, moveOut(index, last, leastRows));
        if (buffer)
            return std::move(buffer);
    }
    return RowPool::Buffer{};
}

Status RowStore::drain(std::size_t index, bool keep,
                       const std::function<Status(const std::uint8_t* rows, std::size_t count)>& take) {
    Cell& cell = cells_[index];
    Bytes fromFile;
    for (std::size_t i = 0; i < cell.blocks.size(); ++i) {
        RowPool::Buffer ram;
        std::uint64_t offset = nowhere;
        std::uint32_t rows = 0;
        {
            // Another thread may be moving this very block out.
            std::lock_guard lock(cell.mutex);
            Block& block = cell.blocks[i];
            ram = std::move(block.ram);
            offset = block.offset;
            rows = block.rows;
        }
        const std::uint8_t* from = ram.get();
        if (!from && rows > 0) {
            fromFile.resize(rows * rowBytes_);
            STIPPLE_CHECK(pool_.file_->read(offset, fromFile));
            from = fromFile.data();
        }
        if (rows > 0)
            STIPPLE_CHECK(take(from, rows));
        if (keep && ram) {
            std::lock_guard lock(cell.mutex);
            cell.blocks[i].ram = std::move(ram);
        } else {
            pool_.release(std::move(ram));
        }
    }
    return {};
}

void RowStore::forget(std::size_t index) {
    Cell& cell = cells_[index];
    std::lock_guard lock(cell.mutex);
    for (Block& block : cell.blocks) {
        pool_.release(std::move(block.ram));
        if (block.offset != nowhere)
            pool_.file_->discard(block.offset, RowPool::blockBytes);
    }
    cell.blocks.clear();
    cell.count = 0;
}

Status RowStore::saveAll() {
    for (Cell& cell : cells_)
        for (Block& block : cell.blocks)
            STIPPLE_CHECK(save(block));
    return {};
}

void RowStore::describe(ByteWriter& to) const {
    to.write<std::uint64_t>(rowBytes_);
    to.write<std::uint64_t>(cells_.size());
    for (const Cell& cell : cells_) {
        to.write(static_cast<std::uint32_t>(cell.blocks.size()));
        for (const Block& block : cell.blocks) {
            to.write(block.offset);
            to.write(block.rows);
        }
    }
}

bool RowStore::restore(ByteReader& from) {
    if (from.read<std::uint64_t>() != rowBytes_ || from.read<std::uint64_t>() != cells_.size())
        return false;
    for (Cell& cell : cells_) {
        auto blocks = from.read<std::uint32_t>();
        for (std::uint32_t i = 0; i < blocks && from.ok(); ++i) {
            Block& block = cell.blocks.emplace_back();
            block.offset = from.read<std::uint64_t>();
            block.rows = block.saved = from.read<std::uint32_t>();
            if (block.rows > rowsPerBlock_ || block.offset > pool_.file_->end())
                return false;
            cell.count += block.rows;
        }
    }
    return from.ok();
}

} // namespace stipple
