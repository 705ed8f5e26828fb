// Where things are in the town: streets, river, blocks and lots, in plan coordinates (u, v), metres.
#pragma once

#include "converter/synth/ground.hpp"
#include "converter/synth/random.hpp"

#include <vector>

namespace stipple::synth {

struct Street {
    double centre;    // v of a street along u, u of one along v
    double halfWidth; // of the carriageway; pavements of 2 m lie beside it
};

struct Rect {
    double u0, v0, u1, v1;
    bool contains(double u, double v) const { return u >= u0 && u < u1 && v >= v0 && v < v1; }
};

struct Block {
    enum class Use { houses, flats, church, park, towers, market };
    Rect area; // inside the pavements
    Use use = Use::houses;
    std::vector<Rect> paved; // drives, paths, yards
};

class TownPlan : public GroundPlan {
  public:
    static constexpr double cell = 2, pavement = 2, kerb = 0.12, riverHalf = 22, waterHalf = 16.5;
    static constexpr double powerLineMargin = 26; // free strip at large v for the power line

    TownPlan(std::uint64_t seed, double side);

    Vec2d place(double u, double v) const override;
    double height(double u, double v) const override;
    double raise(double u, double v) const override;
    GroundLook look(double u, double v) const override;

    double side() const { return side_; }
    const std::vector<Street>& along() const { return along_; }   // run along u
    const std::vector<Street>& across() const { return across_; } // run along v
    std::vector<Block>& blocks() { return blocks_; }
    const std::vector<Block>& blocks() const { return blocks_; }
    double river() const { return river_; } // v of its middle
    double waterLevel(double u) const { return 2 - 0.002 * u; }
    double mainStreet() const { return main_; } // u; the one with the bridge

  private:
    struct Place {
        enum class Zone { river, road, pavement, block, open } zone;
        double off = 0, alongStreet = 0; // from the centre line, along it
        bool junction = false, mainRoad = false;
        double toJunction = 0; // from the nearest crossing street's edge
    };
    Place placeAt(double u, double v) const;
    const Block* blockAt(double u, double v) const;
    GroundLook roadLook(const Place& place, double u, double v) const;

    std::uint64_t seed_;
    double side_;
    std::vector<Street> along_, across_;
    std::vector<Block>
        blocks_; // row by row: across_.size() - 1 a row, rows between along_ (no row in the river)
    std::vector<int> rowOf_; // row of blocks after street along_[i], -1 for the river
    double river_ = 0, main_ = 0;
};

} // namespace stipple::synth
