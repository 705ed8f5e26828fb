#include "tests/unit/shared/las/allocation_meter.hpp"

#include <cstdlib>
#include <new>

namespace {
std::size_t allocated = 0;

void* allocate(std::size_t size) {
    allocated += size;
    if (void* memory = std::malloc(size > 0 ? size : 1))
        return memory;
    std::abort();
}
} // namespace

namespace stipple::test {
std::size_t allocatedBytes() {
    return allocated;
}
} // namespace stipple::test

void* operator new(std::size_t size) {
    return allocate(size);
}
void* operator new[](std::size_t size) {
    return allocate(size);
}
// Sanitizers bring these along, not by way of the ones above.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    return allocate(size);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
    return allocate(size);
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete[](void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
    std::free(memory);
}
