// Scans for the converter's tests: written with las::Writer into a folder that goes when the test ends.
#pragma once

#include "converter/build/convert.hpp"
#include "shared/las/las_reader.hpp"
#include "shared/las/las_writer.hpp"
#include "shared/points/point_batch.hpp"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <unistd.h>

namespace stipple::test {

class TemporaryFolder {
  public:
    TemporaryFolder() {
        static int made = 0;
        path_ = std::filesystem::temp_directory_path() /
                ("stipple-test-" + std::to_string(::getpid()) + "-" + std::to_string(made++));
        std::filesystem::create_directories(path_);
    }
    ~TemporaryFolder() { std::filesystem::remove_all(path_); }
    std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    std::size_t files() const {
        return static_cast<std::size_t>(
            std::distance(std::filesystem::directory_iterator(path_), std::filesystem::directory_iterator()));
    }

  private:
    std::filesystem::path path_;
};

struct TestScan {
    Grid grid{{0.01, 0.01, 0.01}, {500000, 4000000, 0}};
    Schema schema;
    PointBatch points;
    int pointFormat = 0;
};

// Values that a LAS field of that name has room for.
inline std::uint64_t fieldLimit(const std::string& name, int pointFormat) {
    bool small = pointFormat < 6;
    if (name == "Return Number" || name == "Number of Returns")
        return small ? 7 : 15;
    if (name == "Classification")
        return small ? 31 : 255;
    if (name == "Scanner Channel")
        return 3;
    for (const char* flag :
         {"Scan Direction Flag", "Edge of Flight Line", "Synthetic", "Key-point", "Withheld", "Overlap"})
        if (name == flag)
            return 1;
    return ~std::uint64_t{0};
}

inline void fillAttributes(TestScan& scan, std::mt19937_64& random) {
    for (std::size_t a = 0; a < scan.schema.attributes.size(); ++a) {
        const Attribute& attribute = scan.schema.attributes[a];
        std::uint64_t limit = fieldLimit(attribute.name, scan.pointFormat);
        std::size_t width = attributeTypeSize(attribute.type);
        Bytes& column = scan.points.columns[a];
        for (std::size_t at = 0; at + width <= column.size(); at += width) {
            std::uint64_t value = limit == ~std::uint64_t{0} ? random() : random() % (limit + 1);
            if (attribute.type == AttributeType::f64)
                value = std::bit_cast<std::uint64_t>(static_cast<double>(value % 100000) / 64.0);
            if (attribute.type == AttributeType::f32)
                value = std::bit_cast<std::uint32_t>(static_cast<float>(value % 10000) / 16.0f);
            std::memcpy(column.data() + at, &value, width);
        }
    }
}

// A bumpy surface of `count` points, 600 × 400 m, every attribute of the format filled at random.
inline TestScan surfaceScan(int pointFormat, std::size_t count, std::uint64_t seed) {
    TestScan scan;
    scan.pointFormat = pointFormat;
    scan.schema = las::schemaOf(pointFormat);
    scan.points.resize(scan.schema, count);
    std::mt19937_64 random(seed);
    for (Vec3i& p : scan.points.positions) {
        p.x = static_cast<std::int64_t>(random() % 60000);
        p.y = static_cast<std::int64_t>(random() % 40000);
        p.z = (p.x / 100 * (p.y / 100)) % 500 + static_cast<std::int64_t>(random() % 20);
    }
    fillAttributes(scan, random);
    return scan;
}

inline void writeScan(const TestScan& scan, const std::string& path) {
    las::WriterOptions options;
    options.grid = scan.grid;
    options.schema = scan.schema;
    options.pointFormat = scan.pointFormat;
    auto writer = las::Writer::create(path, options);
    if (!writer)
        FAIL(writer.error().sentence());
    Status written = (*writer)->write(scan.points);
    if (!written)
        FAIL(written.error().sentence());
    Status finished = (*writer)->finish();
    if (!finished)
        FAIL(finished.error().sentence());
}

inline void noProgress(const std::string&, std::uint64_t, std::uint64_t) {}

inline ConvertResult convertOrFail(const std::vector<std::string>& inputs, const std::string& output,
                                   const ConvertOptions& options = {}) {
    auto result = convertFiles(inputs, output, options, noProgress);
    if (!result)
        FAIL(result.error().sentence());
    return std::move(result).value();
}

inline Bytes fileBytes(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return Bytes(std::istreambuf_iterator<char>(file), {});
}

} // namespace stipple::test
