// While it lives, this process can't write beyond `bytes` of any file, as if the disk were full there.
#pragma once

#include <catch2/catch.hpp>

#include <csignal>
#include <sys/resource.h>

namespace stipple::test {

class FileSizeLimit {
  public:
    explicit FileSizeLimit(rlim_t bytes) : signal_(std::signal(SIGXFSZ, SIG_IGN)) {
        REQUIRE(::getrlimit(RLIMIT_FSIZE, &before_) == 0);
        struct rlimit limit {
            bytes, before_.rlim_max
        };
        REQUIRE(::setrlimit(RLIMIT_FSIZE, &limit) == 0);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, signal_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

  private:
    void (*signal_)(int);
    struct rlimit before_ {};
};

} // namespace stipple::test
