// The clouds that are open, by id: the least recently used are closed first. Whoever still sends from a
// closed one keeps its file open until then. Thread: any.
#pragma once

#include "server/site/cloud_version.hpp"

#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>

namespace stipple::server {

class VersionCache {
  public:
    struct Limits {
        std::size_t versions = 256; // each is an open file
        std::uint64_t metadataBytes = 256u
                                      << 20; // of their documents, which a version holds as text and parsed
    };
    explicit VersionCache(const Limits& limits) : limits_(limits) {}

    std::shared_ptr<const CloudVersion> find(const std::string& id); // null: not there
    void keep(const std::string& id, std::shared_ptr<const CloudVersion> version);
    void drop(const std::string& id);
    // Closes all but the `count` used last.
    void shrinkTo(std::size_t count);
    std::size_t size() const;

  private:
    struct Entry {
        std::string id;
        std::shared_ptr<const CloudVersion> version;
    };
    void dropLocked(std::list<Entry>::iterator entry);

    const Limits limits_;
    mutable std::mutex mutex_;
    std::list<Entry> entries_; // most recently used first
    std::unordered_map<std::string, std::list<Entry>::iterator> places_;
    std::uint64_t metadataBytes_ = 0;
};

} // namespace stipple::server
