// Open files that wait for their next reader.
#include "converter/input/idle_files.hpp"

#include <catch2/catch.hpp>

#include <memory>

using namespace stipple;

namespace {
// Stands for an open file: counts those that are open.
struct Counted {
    explicit Counted(int& open) : open_(&open, [](int* count) { --*count; }) { ++open; }
    std::unique_ptr<int, void (*)(int*)> open_;
};
} // namespace

TEST_CASE("a file is handed out again, and opened where none waits", "[idle]") {
    int open = 0;
    IdleFiles<Counted> idle;
    CHECK_FALSE(idle.take());
    idle.put(Counted(open));
    CHECK(open == 1);
    {
        auto file = idle.take();
        CHECK(file);
        CHECK_FALSE(idle.take());
    }
    CHECK(open == 0);
}

TEST_CASE("thousands of inputs keep few files open, and those that are read through none", "[idle]") {
    int open = 0;
    {
        std::vector<std::unique_ptr<IdleFiles<Counted>>> inputs;
        for (int i = 0; i < 2000; ++i) {
            inputs.push_back(std::make_unique<IdleFiles<Counted>>());
            inputs.back()->put(Counted(open));
        }
        CHECK(open == maxIdleFiles);
        auto file = inputs[0]->take();
        REQUIRE(file);
        inputs[0]->putAfterPart(std::move(*file), 2);
        CHECK(open == maxIdleFiles);
        file = inputs[0]->take();
        REQUIRE(file);
        inputs[0]->putAfterPart(std::move(*file), 2);
        CHECK(open == maxIdleFiles - 1);
        inputs.back()->put(Counted(open)); // there is room again
        CHECK(open == maxIdleFiles);
    }
    CHECK(open == 0);
    IdleFiles<Counted> next;
    next.put(Counted(open));
    CHECK(open == 1);
}
