#include "client/core/kept_bytes.hpp"

#include <algorithm>

namespace stipple {

void KeptBytes::add(std::uint32_t cloud, std::uint64_t offset, Bytes bytes) {
    ByteRange range{offset, bytes.size()};
    if (headBytes(cloud, range) == range.size)
        return;
    for (auto part = parts_.lower_bound({cloud, offset});
         part != parts_.end() && part->first.first == cloud && part->first.second < range.end();) {
        bool isCovered = part->first.second + part->second.bytes.size() <= range.end();
        part = isCovered ? drop(part) : std::next(part);
    }
    auto [part, isNew] = parts_.try_emplace({cloud, offset});
    if (!isNew)
        return; // one from there reaches further
    part->second.use = uses_.insert(uses_.begin(), part->first);
    part->second.bytes = std::move(bytes);
    bytes_ += range.size;
}

KeptBytes::Parts::const_iterator KeptBytes::partAt(std::uint32_t cloud, std::uint64_t offset) const {
    auto at = parts_.upper_bound({cloud, offset});
    if (at == parts_.begin())
        return parts_.end();
    --at;
    bool holds = at->first.first == cloud && offset - at->first.second < at->second.bytes.size();
    return holds ? at : parts_.end();
}

std::uint64_t KeptBytes::headBytes(std::uint32_t cloud, ByteRange range) const {
    std::uint64_t here = 0;
    while (here < range.size) {
        auto part = partAt(cloud, range.offset + here);
        if (part == parts_.end())
            break;
        here = part->first.second + part->second.bytes.size() - range.offset;
    }
    return std::min(here, range.size);
}

void KeptBytes::append(std::uint32_t cloud, ByteRange range, Bytes& to) {
    while (range.size > 0) {
        const auto& [key, part] = *partAt(cloud, range.offset);
        touch(part);
        std::uint64_t skip = range.offset - key.second;
        std::uint64_t size = std::min<std::uint64_t>(part.bytes.size() - skip, range.size);
        auto from = part.bytes.begin() + static_cast<std::ptrdiff_t>(skip);
        to.insert(to.end(), from, from + static_cast<std::ptrdiff_t>(size));
        range = {range.offset + size, range.size - size};
    }
}

void KeptBytes::limit(std::uint64_t bytes) {
    while (bytes_ > bytes)
        drop(parts_.find(uses_.back()));
}

void KeptBytes::erase(std::uint32_t cloud, ByteRange range) {
    for (auto part = parts_.lower_bound({cloud, 0});
         part != parts_.end() && part->first.first == cloud && part->first.second < range.end();) {
        bool isHit = part->first.second + part->second.bytes.size() > range.offset;
        part = isHit ? drop(part) : std::next(part);
    }
}

void KeptBytes::eraseCloud(std::uint32_t cloud) {
    for (auto part = parts_.lower_bound({cloud, 0}); part != parts_.end() && part->first.first == cloud;)
        part = drop(part);
}

KeptBytes::Parts::iterator KeptBytes::drop(Parts::const_iterator part) {
    bytes_ -= part->second.bytes.size();
    uses_.erase(part->second.use);
    return parts_.erase(part);
}

} // namespace stipple
