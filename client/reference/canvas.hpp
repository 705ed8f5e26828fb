// Marks to a picture. Each pixel is looked at in `samples` × `samples` places, evenly spread; with one, at
// its centre, as the renderers do. More give the picture that the mean of so many shifted ones would: a
// pixel's colour is the mean of its samples' levels (a box filter), its distance the nearest of theirs.
//
// Memory: 28 bytes a sample, with splats 60.
#pragma once

#include "client/reference/spot.hpp"
#include "client/render/image.hpp"

#include <span>

namespace stipple::reference {

// What the marks of a style are drawn as: splats take paraboloids as circles.
PointShape drawnShape(const Style& style);

class Canvas {
  public:
    Canvas(int width, int height, int samples = 1);

    static std::uint64_t bytesFor(int width, int height, int samples, bool splats = false);

    // Draws marks over what is there; their order of arrival makes no difference. Thread: one at a time.
    void draw(std::span<const Mark> marks, PointShape shape);

    // High-quality splats: after all marks are drawn, and with all of them again. finish() then shows the
    // mean of those within their blend depth of the nearest (client/core/style.hpp).
    void blend(std::span<const Mark> marks, const Style& style);

    // Marks the samples that would show another mark if those of `marks` were moved, grew or came nearer by
    // `slack`. Once all marks are drawn, with all of them; what finish() answers then is in doubt there.
    void doubt(std::span<const Mark> marks, const Style& style, const Slack& slack);

    // The picture, with background and eye-dome lighting.
    DepthImage finish(const Style& style) const;
    // Per pixel, after doubt(): whether any of its samples is in doubt, or one that lights it.
    std::vector<bool> doubtful(const Style& style) const;
    // Per pixel, after doubt(): by how much the distance of what it shows changes if its mark is off by the
    // slack. More than nothing for paraboloids and discs.
    std::vector<double> distanceSlack() const;

  private:
    template <class Visit>
    void visitSamples(const Mark& mark, PointShape shape, const Slack* slack, const Visit& visit) const;
    template <class Visit>
    void visitNeighbours(const EyeDomeLighting& edl, int x, int y, const Visit& visit) const;
    void doubtBlend(const Mark& mark, std::size_t sample, const Spot& spot, const Splats& splats,
                    const Slack& slack);
    Colour colourAt(std::size_t sample) const;
    double shadeOf(const EyeDomeLighting& edl, int x, int y) const;
    std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
    }

    int samples_, columns_, rows_;
    std::vector<double> distances_; // infinite where there is no mark
    std::vector<std::uint64_t> orders_;
    std::vector<Colour> colours_;
    std::vector<std::array<double, 4>> sums_; // weighted colours, weights; empty before blend()
    std::vector<bool> doubtful_;              // empty before doubt()
    std::vector<double> distanceSlack_;       // of what is shown; empty before doubt()
    std::vector<double> swings_;              // splats: how far the weights of doubt() move a colour, levels
};

} // namespace stipple::reference
