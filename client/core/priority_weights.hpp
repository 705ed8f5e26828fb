// How much a node matters besides its size: weights of its priority that favour the middle of the picture and
// what is near (UnityPIC, Wu et al. 2021, §4.1, eq. 1 and 2). They decide the order in which nodes are taken
// and loaded, and with it what the point budget leaves out; not which nodes are too small.
#pragma once

#include "client/core/frame_plan.hpp"

namespace stipple {

// The least weight in each direction, 0..1; 1: no weighting. The paper finds 0.5 good for both; with much
// less the border between levels shows.
struct PriorityWeights {
    double leastCentre = 1; // at the distance 1 from the picture's centre (the middle of a side), and beyond
    double leastDepth = 1;  // at view.far
    friend bool operator==(const PriorityWeights&, const PriorityWeights&) = default;
};

// For a node whose box has its middle at `centre` (world): 1 - (1 - leastCentre) (x² + y²) times 1 - (1 -
// leastDepth) z², x and y from -1 to 1 over the picture, z from 0 at view.near to 1 at view.far. 1 for what
// lies before view.near: its place in the picture says nothing.
double priorityWeight(const PriorityWeights& weights, const ViewTransform& view, Vec3d centre);

} // namespace stipple
