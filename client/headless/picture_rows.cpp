#include "client/headless/picture_rows.hpp"

#include "client/render/picture_parts.hpp"

#include <algorithm>
#include <cstring>

namespace stipple::headless {
namespace {

// Up to here in one piece.
constexpr int onePieceSide = 4096;
// Every OpenGL ES 3 draws this (§6.2, MAX_TEXTURE_SIZE).
constexpr int partSide = 2048 - 2 * maxPartMargin;
// Of a row of parts: 64 MB.
constexpr int bandPixels = 1 << 24;

// Puts `kept` of a picture of `drawn` into the rows that begin at the top of `kept`.
void paste(const Image& picture, const PictureWindow& drawn, const PictureWindow& kept, Image& rows) {
    std::size_t skipped = static_cast<std::size_t>(drawn.bottom + drawn.height - kept.bottom - kept.height);
    for (std::size_t y = 0; y < static_cast<std::size_t>(kept.height); ++y) {
        std::size_t from = (skipped + y) * static_cast<std::size_t>(drawn.width) +
                           static_cast<std::size_t>(kept.left - drawn.left);
        std::size_t to = y * static_cast<std::size_t>(rows.width) + static_cast<std::size_t>(kept.left);
        std::memcpy(rows.rgba.data() + 4 * to, picture.rgba.data() + 4 * from,
                    4 * static_cast<std::size_t>(kept.width));
    }
}

} // namespace

Status drawRows(FrameDrawer& drawer, FramePlan& plan, const TakeRows& take) {
    plan.part = {};
    if (std::max(plan.width, plan.height) <= onePieceSide) {
        STIPPLE_TRY(image, drawer.draw(plan));
        return take(*image);
    }
    Image rows;
    rows.width = plan.width;
    for (const PictureWindow& kept :
         partsOf(plan, partSide, std::clamp(bandPixels / plan.width, 1, partSide))) {
        rows.height = kept.height;
        rows.rgba.resize(4 * static_cast<std::size_t>(rows.width) * static_cast<std::size_t>(rows.height));
        plan.part = withMargin(kept, plan);
        STIPPLE_TRY(picture, drawer.draw(plan));
        paste(*picture, plan.part, kept, rows);
        if (kept.left + kept.width == plan.width)
            STIPPLE_CHECK(take(rows));
    }
    plan.part = {};
    return {};
}

} // namespace stipple::headless
