// The rules in force, and reading them anew while requests go on. Thread: any.
#pragma once

#include "server/access/access_rules.hpp"

#include <memory>
#include <mutex>
#include <string>

namespace stipple::server {

class AccessControl {
  public:
    // `path` of an access file. Errors: as readAccessFile.
    static Result<std::unique_ptr<AccessControl>> open(const std::string& path);

    // Reads the file anew; on an error the rules stay as they were.
    Status reload();
    // Requests that run keep the rules they began with.
    std::shared_ptr<const AccessRules> rules() const;

  private:
    explicit AccessControl(std::string path) : path_(std::move(path)) {}
    std::string path_;
    mutable std::mutex mutex_;
    std::shared_ptr<const AccessRules> rules_; // under mutex_
};

} // namespace stipple::server
