#include "client/core/kept_bytes.hpp"

#include <algorithm>

namespace stipple {

void KeptBytes::add(std::uint32_t cloud, std::uint64_t offset, Bytes bytes) {
    if (bytes.empty())
        return;
    std::uint64_t size = bytes.size();
    if (parts_.try_emplace({cloud, offset}, std::move(bytes)).second) {
        ages_.emplace_back(cloud, offset);
        bytes_ += size;
    }
}

KeptBytes::Parts::const_iterator KeptBytes::partAt(std::uint32_t cloud, std::uint64_t offset) const {
    auto at = parts_.upper_bound({cloud, offset});
    if (at == parts_.begin())
        return parts_.end();
    --at;
    bool holds = at->first.first == cloud && offset - at->first.second < at->second.size();
    return holds ? at : parts_.end();
}

std::uint64_t KeptBytes::headBytes(std::uint32_t cloud, ByteRange range) const {
    std::uint64_t here = 0;
    while (here < range.size) {
        auto part = partAt(cloud, range.offset + here);
        if (part == parts_.end())
            break;
        here = part->first.second + part->second.size() - range.offset;
    }
    return std::min(here, range.size);
}

void KeptBytes::append(std::uint32_t cloud, ByteRange range, Bytes& to) const {
    while (range.size > 0) {
        const auto& [key, bytes] = *partAt(cloud, range.offset);
        std::uint64_t skip = range.offset - key.second;
        std::uint64_t size = std::min<std::uint64_t>(bytes.size() - skip, range.size);
        auto from = bytes.begin() + static_cast<std::ptrdiff_t>(skip);
        to.insert(to.end(), from, from + static_cast<std::ptrdiff_t>(size));
        range = {range.offset + size, range.size - size};
    }
}

void KeptBytes::limit(std::uint64_t bytes) {
    while (bytes_ > bytes && !ages_.empty()) {
        if (auto part = parts_.find(ages_.front()); part != parts_.end()) {
            bytes_ -= part->second.size();
            parts_.erase(part);
        }
        ages_.pop_front();
    }
}

void KeptBytes::eraseCloud(std::uint32_t cloud) {
    for (auto part = parts_.lower_bound({cloud, 0}); part != parts_.end() && part->first.first == cloud;) {
        bytes_ -= part->second.size();
        part = parts_.erase(part);
    }
    std::erase_if(ages_, [&](const Key& key) { return key.first == cloud; });
}

} // namespace stipple
