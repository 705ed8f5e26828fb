// Furniture. Each stands on z = 0, centred, its front towards -y.
#pragma once

#include "converter/synth/model.hpp"
#include "converter/synth/random.hpp"

namespace stipple::synth {

Model makeTable(double width, double depth, double height);
Model makeChair();
Model makeDesk(); // with monitor and keyboard
Model makeSofa();
Model makeBed();
Model makeShelf(double width, double height, Random random); // against a wall behind it (+y)
Model makeCupboard(double width, double height);
Model makeKitchen(double width);    // units with sink, against a wall
Model makePendantLamp(double drop); // hangs from z = 0 downwards
Model makeTubeLamp(double size);    // flat under z = 0
Model makePottedPlant(Random random);
Model makeDiningSet(int chairs);

} // namespace stipple::synth
