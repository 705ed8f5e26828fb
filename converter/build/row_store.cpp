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

void RowPool::note(Place block, bool isFull) {
    std::lock_guard lock(mutex_);
    if (isFull)
        full_.push_back(block);
    else
        open_.push_back(block);
}

void RowPool::forget(const RowStore* store) {
    std::lock_guard lock(mutex_);
    auto isOfStore = [&](const Place& place) { return place.store == store; };
    std::erase_if(full_, isOfStore);
    std::erase_if(open_, isOfStore);
}

Result<RowPool::Buffer> RowPool::moveOneOut() {
    if (!file_)
        return Error{ErrorCode::limitExceeded, "the points do not fit the memory allowed", "",
                     "allow more with --memory"};
    for (;;) {
        Place full{};
        {
            std::lock_guard lock(mutex_);
            if (!free_.empty()) {
                Buffer buffer = std::move(free_.back());
                free_.pop_back();
                return buffer;
            }
            if (!full_.empty()) {
                full = full_.front();
                full_.pop_front();
            }
        }
        if (full.store) {
            STIPPLE_TRY(buffer, full.store->moveOut(full.cell, full.block));
            if (buffer)
                return std::move(buffer);
            continue;
        }
        std::lock_guard moving(moving_);
        {
            std::lock_guard lock(mutex_);
            if (!free_.empty() || !full_.empty())
                continue; // another thread has been here
        }
        STIPPLE_TRY(moved, movePartsOut());
        if (moved == 0)
            return Error{ErrorCode::limitExceeded, "no buffer is left for the points", "",
                         "allow more memory with --memory, or fewer threads"};
    }
}

Result<std::size_t> RowPool::movePartsOut() {
    std::vector<Place> places;
    {
        std::lock_guard lock(mutex_);
        places.swap(open_);
    }
    struct Part {
        std::uint32_t rows;
        Place place;
    };
    std::vector<Part> parts;
    for (const Place& place : places)
        if (std::uint32_t rows = place.store->rowsInMemory(place.cell, place.block); rows > 0)
            parts.push_back({rows, place});
    auto chosen = parts.begin() + static_cast<std::ptrdiff_t>((parts.size() + 3) / 4);
    std::nth_element(parts.begin(), chosen, parts.end(),
                     [](const Part& a, const Part& b) { return a.rows > b.rows; });
    for (auto part = chosen; part != parts.end(); ++part)
        note(part->place, false);
    for (auto part = parts.begin(); part != chosen; ++part) {
        STIPPLE_TRY(buffer, part->place.store->moveOut(part->place.cell, part->place.block));
        release(std::move(buffer));
    }
    return static_cast<std::size_t>(chosen - parts.begin());
}

RowStore::RowStore(RowPool& pool, std::size_t rowBytes, std::size_t cells)
    : pool_(pool), rowBytes_(rowBytes),
      rowsPerBlock_(static_cast<std::uint32_t>(RowPool::blockBytes / rowBytes)), cells_(cells) {}

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
        bool filled = false, begun = false;
        std::size_t block = 0;
        {
            std::lock_guard lock(cell.mutex);
            bool hasRoom =
                !cell.blocks.empty() && cell.blocks.back().ram && cell.blocks.back().rows < rowsPerBlock_;
            if (!hasRoom && spare) {
                cell.blocks.emplace_back().ram = std::move(spare);
                hasRoom = begun = true;
            }
            if (hasRoom) {
                Block& last = cell.blocks.back();
                std::size_t part = std::min<std::size_t>(count, rowsPerBlock_ - last.rows);
                std::memcpy(last.ram.get() + last.rows * rowBytes_, rows, part * rowBytes_);
                last.rows += static_cast<std::uint32_t>(part);
                cell.count += part;
                rows += part * rowBytes_;
                count -= part;
                filled = last.rows == rowsPerBlock_;
                block = cell.blocks.size() - 1;
            }
        }
        if (filled || begun)
            pool_.note({this, index, block}, filled);
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

Result<RowPool::Buffer> RowStore::moveOut(std::size_t index, std::size_t number) {
    Cell& cell = cells_[index];
    std::lock_guard lock(cell.mutex);
    if (number >= cell.blocks.size() || !cell.blocks[number].ram)
        return RowPool::Buffer{};
    STIPPLE_CHECK(save(cell.blocks[number]));
    return std::move(cell.blocks[number].ram);
}

std::uint32_t RowStore::rowsInMemory(std::size_t index, std::size_t number) {
    Cell& cell = cells_[index];
    std::lock_guard lock(cell.mutex);
    return number < cell.blocks.size() && cell.blocks[number].ram ? cell.blocks[number].rows : 0;
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
            {
                std::lock_guard lock(cell.mutex);
                cell.blocks[i].ram = std::move(ram);
            }
            pool_.note({this, index, i}, rows == rowsPerBlock_); // who looked meanwhile took it for gone
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
