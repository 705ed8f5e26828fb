// Makes a cloud's file larger, for measuring servers on files that no conversion has to be waited for:
// appends pseudo-random bytes, which no node refers to, and corrects the header.
//   pad_cloud CLOUD.stipple BYTES [SEED]
#include "shared/format/file_parts.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <vector>

using namespace stipple;

int main(int count, char** arguments) {
    if (count != 3 && count != 4) {
        std::fprintf(stderr, "usage: pad_cloud CLOUD.stipple BYTES [SEED]\n");
        return 2;
    }
    std::fstream file(arguments[1], std::ios::in | std::ios::out | std::ios::binary);
    Bytes head(fileHeaderBytes);
    file.read(reinterpret_cast<char*>(head.data()), static_cast<std::streamsize>(head.size()));
    auto header = parseFileHeader(head);
    if (!file || !header) {
        std::fprintf(stderr, "%s is no cloud\n", arguments[1]);
        return 3;
    }
    std::uint64_t wanted = std::strtoull(arguments[2], nullptr, 10);
    std::mt19937_64 random(count == 4 ? std::strtoull(arguments[3], nullptr, 10) : 1);
    std::vector<std::uint64_t> noise(1 << 17);
    for (file.seekp(0, std::ios::end); header->fileBytes < wanted && file;) {
        for (std::uint64_t& word : noise)
            word = random();
        std::uint64_t size =
            std::min<std::uint64_t>(wanted - header->fileBytes, noise.size() * sizeof noise[0]);
        file.write(reinterpret_cast<const char*>(noise.data()), static_cast<std::streamsize>(size));
        header->fileBytes += size;
    }
    head = writeFileHeader(*header);
    file.seekp(0);
    file.write(reinterpret_cast<const char*>(head.data()), static_cast<std::streamsize>(head.size()));
    return file.flush() ? 0 : 4;
}
