#include "server/site/version_cache.hpp"

#include <iterator>
#include <utility>

namespace stipple::server {

std::shared_ptr<const CloudVersion> VersionCache::find(const std::string& id) {
    std::lock_guard lock(mutex_);
    auto found = places_.find(id);
    if (found == places_.end())
        return nullptr;
    entries_.splice(entries_.begin(), entries_, found->second);
    return found->second->version;
}

void VersionCache::keep(const std::string& id, std::shared_ptr<const CloudVersion> version) {
    std::lock_guard lock(mutex_);
    if (auto old = places_.find(id); old != places_.end())
        dropLocked(old->second);
    metadataBytes_ += version->metadataText.size();
    entries_.push_front({id, std::move(version)});
    places_[id] = entries_.begin();
    while (entries_.size() > 1 &&
           (entries_.size() > limits_.versions || metadataBytes_ > limits_.metadataBytes))
        dropLocked(std::prev(entries_.end()));
}

void VersionCache::drop(const std::string& id) {
    std::lock_guard lock(mutex_);
    if (auto found = places_.find(id); found != places_.end())
        dropLocked(found->second);
}

void VersionCache::shrinkTo(std::size_t count) {
    std::lock_guard lock(mutex_);
    while (entries_.size() > count)
        dropLocked(std::prev(entries_.end()));
}

std::size_t VersionCache::size() const {
    std::lock_guard lock(mutex_);
    return entries_.size();
}

void VersionCache::dropLocked(std::list<Entry>::iterator entry) {
    metadataBytes_ -= entry->version->metadataText.size();
    places_.erase(entry->id);
    entries_.erase(entry);
}

} // namespace stipple::server
