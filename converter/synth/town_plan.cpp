#include "converter/synth/town_plan.hpp"

#include "converter/synth/noise.hpp"

#include <algorithm>
#include <cmath>

namespace stipple::synth {

namespace {

// Distance to the centre of the nearest street, and which.
std::size_t nearest(const std::vector<Street>& streets, double x) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < streets.size(); ++i)
        if (std::abs(streets[i].centre - x) < std::abs(streets[best].centre - x))
            best = i;
    return best;
}

} // namespace

TownPlan::TownPlan(std::uint64_t seed, double side) : seed_(seed), side_(side) {
    Random random(seed ^ 0x7061746c);
    // Even numbers everywhere: kerbs lie on the edges of cells.
    bool riverPlaced = false;
    for (double v = 20; v < side - powerLineMargin - 14;) {
        along_.push_back({v, 4});
        bool here = !riverPlaced && v > side * 0.42;
        rowOf_.push_back(here ? -1 : 0);
        if (here) {
            river_ = v + 6 + riverHalf;
            riverPlaced = true;
            v += 12 + 2 * riverHalf;
        } else {
            v += 2 * random.integer(26, 31);
        }
    }
    for (double u = 20; u < side - 16; u += 2 * random.integer(34, 48))
        across_.push_back({u, 4});
    std::size_t middle = nearest(across_, side / 2);
    across_[middle].halfWidth = 6;
    main_ = across_[middle].centre;

    int row = 0;
    for (std::size_t j = 0; j + 1 < along_.size(); ++j) {
        if (rowOf_[j] < 0)
            continue;
        rowOf_[j] = row++;
        for (std::size_t i = 0; i + 1 < across_.size(); ++i) {
            Block block;
            block.area = {across_[i].centre + across_[i].halfWidth + pavement,
                          along_[j].centre + along_[j].halfWidth + pavement,
                          across_[i + 1].centre - across_[i + 1].halfWidth - pavement,
                          along_[j + 1].centre - along_[j + 1].halfWidth - pavement};
            block.use = random.chance(0.22) ? Block::Use::flats : Block::Use::houses;
            blocks_.push_back(block);
        }
    }
    // What a town has once per some twenty blocks.
    constexpr Block::Use special[] = {Block::Use::church, Block::Use::park, Block::Use::towers,
                                      Block::Use::market};
    std::size_t groups = std::max<std::size_t>(1, blocks_.size() / 20);
    for (std::size_t group = 0; group < groups; ++group)
        for (Block::Use use : special) {
            if (blocks_.size() < 6)
                break;
            std::size_t size = blocks_.size() / groups;
            std::size_t at;
            do
                at = group * size + random.bits() % size;
            while (blocks_[at].use != Block::Use::houses && blocks_[at].use != Block::Use::flats);
            blocks_[at].use = use;
        }
}

Vec2d TownPlan::place(double u, double v) const {
    return {u - side_ / 2 + 24 * fractalNoise(seed_ + 11, u / 190, v / 190, 1),
            v - side_ / 2 + 24 * fractalNoise(seed_ + 12, u / 190, v / 190, 1)};
}

double TownPlan::height(double u, double v) const {
    double d = std::abs(v - river_);
    double bank = -5 * (1 - smoothStep(11, riverHalf, d));
    double away = smoothStep(riverHalf + 8, 220, d);
    double relief = 9 + 9 * fractalNoise(seed_ + 13, u / 170, v / 170, 2);
    return waterLevel(u) + 3 + bank + away * relief;
}

TownPlan::Place TownPlan::placeAt(double u, double v) const {
    using Zone = Place::Zone;
    const Street& uStreet = across_[nearest(across_, u)];
    const Street& vStreet = along_[nearest(along_, v)];
    double du = std::abs(u - uStreet.centre), dv = std::abs(v - vStreet.centre);
    double riverDistance = std::abs(v - river_);
    if (riverDistance < riverHalf) {
        bool ramp = uStreet.centre == main_ && du < uStreet.halfWidth && riverDistance > riverHalf - 2;
        return {ramp ? Zone::road : Zone::river, u - uStreet.centre, v, false, true, 0};
    }
    double low = along_.front().centre, high = along_.back().centre;
    // Streets end at the last crossing.
    bool inU = du < uStreet.halfWidth && v > low - 4 && v < high + 4;
    bool inV = dv < vStreet.halfWidth && u > across_.front().centre - 4 && u < across_.back().centre + 4;
    if (inU && inV)
        return {Zone::road, 0, 0, true, false, 0};
    if (inU)
        return {Zone::road, u - uStreet.centre, v, false, uStreet.centre == main_, dv - vStreet.halfWidth};
    if (inV)
        return {Zone::road, v - vStreet.centre, u, false, false, du - uStreet.halfWidth};
    bool besideU = du < uStreet.halfWidth + pavement && v > low - 6 && v < high + 6;
    bool besideV =
        dv < vStreet.halfWidth + pavement && u > across_.front().centre - 6 && u < across_.back().centre + 6;
    if (besideU || besideV)
        return {Zone::pavement, 0, 0, false, false, 0};
    return {blockAt(u, v) ? Zone::block : Zone::open, 0, 0, false, false, 0};
}

const Block* TownPlan::blockAt(double u, double v) const {
    auto after = [](const std::vector<Street>& streets, double x) {
        std::ptrdiff_t i = std::upper_bound(streets.begin(), streets.end(), x,
                                            [](double value, const Street& s) { return value < s.centre; }) -
                           streets.begin() - 1;
        return i < 0 || i + 1 >= std::ssize(streets) ? std::ptrdiff_t{-1} : i;
    };
    std::ptrdiff_t i = after(across_, u), j = after(along_, v);
    if (i < 0 || j < 0 || rowOf_[static_cast<std::size_t>(j)] < 0)
        return nullptr;
    auto row = static_cast<std::size_t>(rowOf_[static_cast<std::size_t>(j)]);
    return &blocks_[row * (across_.size() - 1) + static_cast<std::size_t>(i)];
}

double TownPlan::raise(double u, double v) const {
    return placeAt(u, v).zone == Place::Zone::road ? 0 : kerb;
}

GroundLook TownPlan::roadLook(const Place& p, double u, double v) const {
    auto wear = static_cast<float>(fractalNoise(seed_ + 21, u / 1.7, v / 1.7, 2));
    bool patched = valueNoise(seed_ + 22, u / 9, v / 9) > 0.62;
    GroundLook asphalt{Rgb{0.30f, 0.30f, 0.31f} * (1 + 0.12f * wear + (patched ? -0.25f : 0.0f)), 0.18f,
                       classes::road};
    const GroundLook paint{Rgb{0.88f, 0.88f, 0.86f} * (1 + 0.1f * wear), 0.72f, classes::road};
    if (p.junction)
        return asphalt;
    double half = p.mainRoad ? 6 : 4;
    bool zebra = p.toJunction > 1.0 && p.toJunction < 4.0;
    if (zebra)
        return std::fmod(p.off + 20, 1.0) < 0.5 ? paint : asphalt;
    if (p.toJunction > 4.3 && p.toJunction < 4.6 && p.off > 0)
        return paint;
    if (p.toJunction > 5 && std::abs(p.off) < 0.08 && std::fmod(p.alongStreet, 6.0) < 3.0)
        return paint;
    if (p.mainRoad && std::abs(std::abs(p.off) - (half - 0.35)) < 0.07)
        return paint;
    double manhole = std::hypot(std::fmod(p.alongStreet, 27.0) - 13, p.off - 1.3);
    if (manhole < 0.33)
        return {Rgb{0.22f, 0.20f, 0.19f}, 0.30f, classes::road};
    return asphalt;
}

GroundLook TownPlan::look(double u, double v) const {
    Place p = placeAt(u, v);
    auto fine = static_cast<float>(fractalNoise(seed_ + 23, u / 0.6, v / 0.6, 2));
    auto broad = static_cast<float>(fractalNoise(seed_ + 24, u / 11, v / 11, 2));
    Rgb lawn = mix({0.30f, 0.44f, 0.17f}, {0.47f, 0.46f, 0.24f}, 0.5f + broad) * (1 + 0.3f * fine);
    GroundLook grass{lawn, 0.48f, classes::ground};
    switch (p.zone) {
    case Place::Zone::road:
        return roadLook(p, u, v);
    case Place::Zone::pavement: {
        bool joint = std::fmod(u, 0.5) < 0.03 || std::fmod(v, 0.5) < 0.03;
        return {Rgb{0.58f, 0.56f, 0.53f} * ((joint ? 0.8f : 1.0f) + 0.15f * fine), 0.36f, classes::ground};
    }
    case Place::Zone::river: {
        double d = std::abs(v - river_);
        if (d < 18 + static_cast<double>(broad))
            return {Rgb{0.52f, 0.49f, 0.42f} * (1 + 0.5f * fine), 0.32f, classes::ground};
        return grass;
    }
    case Place::Zone::block: {
        const Block* block = blockAt(u, v);
        for (const Rect& paved : block->paved)
            if (paved.contains(u, v)) {
                bool lots = block->use == Block::Use::market || block->use == Block::Use::towers;
                if (lots) {
                    bool line = std::fmod(u - paved.u0, 2.6) < 0.12 && std::fmod(v - paved.v0, 16.0) < 5.0;
                    return {Rgb{0.36f, 0.36f, 0.36f} * ((line ? 2.3f : 1.0f) + 0.12f * fine),
                            line ? 0.6f : 0.2f, classes::ground};
                }
                bool joint = std::fmod(u + v, 0.4) < 0.04;
                return {Rgb{0.60f, 0.53f, 0.46f} * ((joint ? 0.8f : 1.0f) + 0.2f * fine), 0.38f,
                        classes::ground};
            }
        if (block->use == Block::Use::houses && broad > 0.28f)
            return {Rgb{0.36f, 0.27f, 0.19f} * (1 + 0.5f * fine), 0.30f, classes::ground};
        return grass;
    }
    case Place::Zone::open:
        break;
    }
    return {mix(lawn, {0.55f, 0.52f, 0.27f}, 0.45f), 0.46f, classes::ground};
}

} // namespace stipple::synth
