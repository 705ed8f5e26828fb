// Files of tables in memory, opened and read.
#pragma once

#include "converter/input/pcd_input.hpp"
#include "converter/input/ply_input.hpp"
#include "converter/input/ptx_input.hpp"
#include "converter/input/text_input.hpp"
#include "shared/io/memory_source.hpp"
#include "tests/support/data.hpp"

#include <catch2/catch.hpp>

namespace stipple::test {

using Opener = Result<std::unique_ptr<PointInput>> (*)(const std::string&, std::unique_ptr<SharedSource>,
                                                       const InputOptions&);

inline Bytes bytesOf(const std::string& text) {
    return Bytes(text.begin(), text.end());
}

inline Result<std::unique_ptr<PointInput>> tryOpen(Opener open, Bytes bytes,
                                                   const InputOptions& options = {}) {
    return open("scan",
                std::make_unique<SharedSource>(std::make_unique<MemorySource>(std::move(bytes), "scan")),
                options);
}

// Everything that an input hands out.
struct Read {
    InputDescription description;
    PointBatch points;
    ReadReport report;
    std::size_t parts = 0;

    const Schema& schema() const { return description.schema; }
    Vec3d world(std::size_t i) const { return description.grid.toWorld(points.positions[i]); }
    AttributeType type(std::string_view name) const {
        int a = schema().find(name);
        REQUIRE(a >= 0);
        return schema().attributes[static_cast<std::size_t>(a)].type;
    }
    template <class T>
    std::vector<T> column(std::string_view name) const {
        int a = schema().find(name);
        REQUIRE(a >= 0);
        const Attribute& attribute = schema().attributes[static_cast<std::size_t>(a)];
        REQUIRE(attribute.size() == sizeof(T) * static_cast<std::size_t>(attribute.components));
        const Bytes& bytes = points.columns[static_cast<std::size_t>(a)];
        std::vector<T> values(bytes.size() / sizeof(T));
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = loadLe<T>(bytes.data() + i * sizeof(T));
        return values;
    }
    bool warns(const std::string& words) const {
        for (const std::string& warning : description.warnings)
            if (warning.find(words) != std::string::npos)
                return true;
        return false;
    }
};

// Errors of streams are failures: what was opened can be read.
inline Read readAll(const PointInput& input) {
    Read read;
    read.description = input.description();
    read.parts = input.parts().size();
    read.points.resize(read.schema(), 0);
    BoxI bounds;
    for (std::size_t part = 0; part < input.parts().size(); ++part) {
        auto stream = input.openPart(part);
        REQUIRE(stream.ok());
        PointBatch batch;
        std::size_t count = 0;
        for (;;) {
            Status next = (*stream)->next(batch);
            INFO((next.ok() ? "" : next.error().sentence()));
            REQUIRE(next.ok());
            if (batch.size() == 0)
                break;
            REQUIRE(batch.size() <= pointsPerBatch);
            count += batch.size();
            for (Vec3i p : batch.positions)
                bounds.extend(p);
            read.points.positions.insert(read.points.positions.end(), batch.positions.begin(),
                                         batch.positions.end());
            for (std::size_t a = 0; a < batch.columns.size(); ++a)
                read.points.columns[a].insert(read.points.columns[a].end(), batch.columns[a].begin(),
                                              batch.columns[a].end());
        }
        REQUIRE(count == input.parts()[part].points);
        read.report.add((*stream)->report());
    }
    REQUIRE(read.points.size() == read.description.source.pointCount);
    REQUIRE(bounds == read.description.bounds);
    return read;
}

inline Read readTable(Opener open, Bytes bytes, const InputOptions& options = {}) {
    auto input = tryOpen(open, std::move(bytes), options);
    INFO((input.ok() ? "" : input.error().sentence()));
    REQUIRE(input.ok());
    return readAll(**input);
}
inline Read readTable(Opener open, const std::string& text, const InputOptions& options = {}) {
    return readTable(open, bytesOf(text), options);
}

// One of the real scans.
inline Read readFile(const std::string& name) {
    auto input = openInput(dataPath("other/" + name));
    INFO((input.ok() ? name : input.error().sentence()));
    REQUIRE(input.ok());
    return readAll(**input);
}

// The sentence with which a file is refused.
inline std::string refusal(Opener open, Bytes bytes, const InputOptions& options = {}) {
    auto input = tryOpen(open, std::move(bytes), options);
    REQUIRE_FALSE(input.ok());
    return input.error().sentence();
}
inline std::string refusal(Opener open, const std::string& text, const InputOptions& options = {}) {
    return refusal(open, bytesOf(text), options);
}

// Opens the file cut after each byte, and with each of its first `headerBytes` bytes changed: each is refused
// with a sentence, or read to the end. Returns how many were refused.
inline std::size_t damageEverywhere(Opener open, const Bytes& file, std::size_t headerBytes) {
    std::size_t refused = 0;
    auto check = [&](Bytes bytes) {
        auto input = tryOpen(open, std::move(bytes));
        if (input) {
            readAll(**input);
        } else {
            REQUIRE_FALSE(input.error().what.empty());
            REQUIRE(input.error().where.find("scan") == 0);
            ++refused;
        }
    };
    for (std::size_t size = 0; size < file.size(); ++size)
        check(Bytes(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size)));
    for (std::size_t at = 0; at < std::min(headerBytes, file.size()); ++at)
        for (int change : {1, 0x80, 0xFF}) {
            Bytes bytes = file;
            bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ change);
            check(std::move(bytes));
        }
    return refused;
}

} // namespace stipple::test
