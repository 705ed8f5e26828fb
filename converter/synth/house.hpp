// Houses with walls of thickness, rooms, stairs and furniture. x runs along the street, the front looks
// towards -y, z = 0 is the ground floor; the plinth reaches below to meet sloping ground.
#pragma once

#include "converter/synth/model.hpp"
#include "converter/synth/random.hpp"

namespace stipple::synth {

struct HouseModel {
    Model model;
    double width = 0, depth = 0; // outer walls, x and y
    Vec3d livingRoom;            // a place for a station inside
};

enum class RoofKind { gable, hip, flat };

struct HouseOptions {
    double width = 10, depth = 8;
    int storeys = 2;
    RoofKind roof = RoofKind::gable;
    double pitch = 0.75; // rise per run
    bool interior = true;
    bool balconies = false;
    Material wall = Material::wall;
};

HouseModel makeHouse(const HouseOptions& options, Random random);
// One of the varied one-family houses.
HouseOptions randomHouse(Random random);

Model makeChurch(); // nave along y, tower at -y
Model makeTowerBlock(int storeys, double width, double depth);
Model makeHall(double width, double depth, double height); // shop or workshop, flat roof
Model makeShed();

} // namespace stipple::synth
