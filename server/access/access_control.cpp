#include "server/access/access_control.hpp"

namespace stipple::server {

Result<std::unique_ptr<AccessControl>> AccessControl::open(const std::string& path) {
    std::unique_ptr<AccessControl> control(new AccessControl(path));
    STIPPLE_CHECK(control->reload());
    return control;
}

Status AccessControl::reload() {
    STIPPLE_TRY(rules, readAccessFile(path_));
    auto fresh = std::make_shared<const AccessRules>(std::move(rules));
    std::lock_guard lock(mutex_);
    rules_ = std::move(fresh);
    return {};
}

std::shared_ptr<const AccessRules> AccessControl::rules() const {
    std::lock_guard lock(mutex_);
    return rules_;
}

} // namespace stipple::server
