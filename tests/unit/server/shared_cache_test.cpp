#include "server/cache/shared_cache.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <thread>
#include <vector>

using namespace stipple;
using namespace stipple::server;

namespace {

using Cache = SharedCache<int, std::string>;
const std::atomic<bool> never{false};

Cache::Make making(const std::string& text, std::uint64_t bytes, int* times = nullptr) {
    return [=]() -> Result<Cache::Made> {
        if (times)
            ++*times;
        return Cache::Made{std::make_shared<const std::string>(text), bytes};
    };
}

template <class Done>
void waitUntil(const Done& done) {
    for (int i = 0; i < 10'000 && !done(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    REQUIRE(done());
}

} // namespace

TEST_CASE("a value is made once and handed out again") {
    Cache cache(100);
    int times = 0;
    CHECK(cache.find(1) == nullptr);
    CHECK(**cache.get(1, making("one", 10, &times), never) == "one");
    CHECK(**cache.get(1, making("other", 10, &times), never) == "one");
    CHECK(*cache.find(1) == "one");
    CHECK(times == 1);
    CHECK(cache.counts().misses == 1);
    CHECK(cache.counts().hits == 2);
    CHECK(cache.counts().bytes == 10);
}

TEST_CASE("the least recently used value leaves when there is no room") {
    Cache cache(30);
    for (int key : {1, 2, 3})
        REQUIRE(cache.get(key, making("x", 10), never).ok());
    CHECK(cache.find(1)); // used again
    REQUIRE(cache.get(4, making("x", 10), never).ok());
    CHECK(cache.find(1));
    CHECK_FALSE(cache.find(2));
    CHECK(cache.find(3));
    CHECK(cache.counts().evicted == 1);
    CHECK(cache.counts().bytes == 30);
    REQUIRE(cache.get(5, making("x", 25), never).ok());
    CHECK(cache.counts().bytes <= 30);
}

TEST_CASE("a value that is larger than the cache is handed out and not kept") {
    Cache cache(30);
    REQUIRE(cache.get(1, making("small", 10), never).ok());
    CHECK(**cache.get(2, making("large", 31), never) == "large");
    CHECK_FALSE(cache.find(2));
    CHECK(cache.find(1));
    CHECK(cache.counts().bytes == 10);
}

TEST_CASE("an error is not kept") {
    Cache cache(100);
    auto failing = []() -> Result<Cache::Made> { return Error{ErrorCode::ioFailed, "no", "", ""}; };
    CHECK(cache.get(1, failing, never).error().code == ErrorCode::ioFailed);
    CHECK(**cache.get(1, making("one", 1), never) == "one");
}

TEST_CASE("threads that want the same value wait for the one that makes it") {
    Cache cache(100);
    std::atomic<int> made{0}, asking{0};
    std::atomic<bool> mayGoOn{false};
    auto slow = [&]() -> Result<Cache::Made> {
        ++made;
        while (!mayGoOn)
            std::this_thread::yield();
        return Cache::Made{std::make_shared<const std::string>("slow"), 200}; // too large to keep
    };
    std::vector<std::thread> threads;
    std::atomic<int> right{0};
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([&] {
            ++asking;
            auto value = cache.get(7, slow, never);
            if (value && **value == "slow")
                ++right;
        });
    waitUntil([&] { return made == 1 && asking == 4; });
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    mayGoOn = true;
    for (std::thread& thread : threads)
        thread.join();
    CHECK(right == 4);
    CHECK(made <= 2); // 2 only if a thread came after the value had been handed out
}

TEST_CASE("when the maker is cancelled one that waits takes over") {
    Cache cache(100);
    std::atomic<bool> isMaking{false}, mayGoOn{false};
    std::thread maker([&] {
        auto value = cache.get(
            1,
            [&]() -> Result<Cache::Made> {
                isMaking = true;
                while (!mayGoOn)
                    std::this_thread::yield();
                return Error{ErrorCode::cancelled, "its client left", "", ""};
            },
            never);
        CHECK(value.error().code == ErrorCode::cancelled);
    });
    waitUntil([&] { return isMaking.load(); });
    std::thread waiter([&] {
        auto value = cache.get(1, making("mine", 1), never);
        CHECK((value.ok() && **value == "mine"));
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    mayGoOn = true;
    maker.join();
    waiter.join();
}

TEST_CASE("waiting ends when the waiter itself is stopped") {
    Cache cache(100);
    std::atomic<bool> isMaking{false}, mayGoOn{false}, stop{false};
    std::thread maker([&] {
        CHECK(cache
                  .get(
                      1,
                      [&]() -> Result<Cache::Made> {
                          isMaking = true;
                          while (!mayGoOn)
                              std::this_thread::yield();
                          return Cache::Made{std::make_shared<const std::string>("late"), 1};
                      },
                      never)
                  .ok());
    });
    waitUntil([&] { return isMaking.load(); });
    std::thread waiter([&] {
        CHECK(cache.get(1, making("mine", 1), stop).error().code == ErrorCode::cancelled);
        mayGoOn = true; // the maker was still at it
    });
    stop = true;
    waiter.join();
    maker.join();
    CHECK(*cache.find(1) == "late");
}

TEST_CASE("an exception of the maker leaves nobody waiting") {
    Cache cache(100);
    auto throwing = []() -> Result<Cache::Made> { throw std::bad_alloc(); };
    CHECK_THROWS_AS(cache.get(1, throwing, never), std::bad_alloc);
    CHECK(**cache.get(1, making("one", 1), never) == "one");
}
