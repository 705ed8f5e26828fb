// Rows of cells as sorted texts: two stores hold the same points if these are equal.
#pragma once

#include "converter/build/tile.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace stipple::test {

// A point as bytes that do not depend on the layout: wide integers, then the attributes.
inline std::string pointText(const RowLayout& layout, const std::uint8_t* row) {
    Vec3i p = layout.position(row);
    std::string text(reinterpret_cast<const char*>(&p), sizeof p);
    return text.append(reinterpret_cast<const char*>(layout.attributes(row)), layout.attributeBytes());
}

// Appends a cell's points, which stay where they are, to `points`.
inline void addPoints(const RowLayout& layout, RowStore& store, std::size_t cell,
                      std::vector<std::string>& points) {
    Status done = store.drain(cell, true, [&](const std::uint8_t* rows, std::size_t count) -> Status {
        for (std::size_t i = 0; i < count; ++i)
            points.push_back(pointText(layout, rows + i * layout.rowBytes()));
        return {};
    });
    if (!done)
        FAIL(done.error().sentence());
}

inline Vec3i positionOf(const std::string& text) {
    Vec3i p;
    std::memcpy(&p, text.data(), sizeof p);
    return p;
}

// All points, sorted. Each has to lie in its cell.
inline std::vector<std::string> pointsOf(Tiles& tiles) {
    std::vector<std::string> all, ofCell;
    std::size_t misplaced = 0;
    for (std::size_t cell = 0; cell < tiles.cells->cells(); ++cell) {
        ofCell.clear();
        addPoints(tiles.layout, *tiles.cells, cell, ofCell);
        CHECK(ofCell.size() == tiles.cells->count(cell));
        for (const std::string& point : ofCell)
            misplaced +=
                tiles.grid.cube.keyOf(positionOf(point), tiles.grid.level) == tiles.grid.keyOf(cell) ? 0 : 1;
        all.insert(all.end(), ofCell.begin(), ofCell.end());
    }
    CHECK(misplaced == 0);
    std::sort(all.begin(), all.end());
    return all;
}

} // namespace stipple::test
