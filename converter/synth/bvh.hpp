// A bounding volume hierarchy with four children a node, over any items that have boxes.
//
// Boxes are floats, padded by `padding`, so that a ray rounded to float never misses what the exact
// arithmetic on the item would hit. Built top-down by binned surface area heuristic (Wald 2007), then
// pairs of levels are folded into one of four (Dammertz, Hanika, Keller 2008).
#pragma once

#include "converter/synth/primitive.hpp"

#include <array>
#include <bit>
#include <span>
#include <vector>
#ifdef __SSE__
#include <xmmintrin.h>
#endif

namespace stipple::synth {

class Bvh {
  public:
    // Metres; larger than the rounding of a coordinate of 4 km to float (2.4e-4) twice over.
    static constexpr float padding = 1e-3f;

    Bvh() = default;
    // `order` receives the items' order: leaves refer to ranges of it, of at most `leafItems`.
    Bvh(std::span<const Box<float>> boxes, std::vector<std::uint32_t>& order, std::size_t leafItems = 4);

    const Box<float>& bounds() const { return bounds_; }

    // Calls leaf(first, count) for leaves whose box the ray enters before `limit`, about front to back.
    // The callback may lower `limit`.
    template <class Leaf>
    void traverse(const Ray& ray, double& limit, Leaf&& leaf) const;

    // Calls leaf(first, count) for leaves whose box is nearer to `point` than `limit`.
    template <class Leaf>
    void approach(Vec3d point, double& limit, Leaf&& leaf) const;

  private:
    using Float4 = float __attribute__((vector_size(16)));
    struct Node {
        std::array<Float4, 6> planes;       // min x, max x, min y, max y, min z, max z, of four children
        std::array<std::uint32_t, 4> child; // inner: node; leaf: first item
        std::array<std::uint32_t, 4> count; // items of a leaf; 0: inner; unused children are never entered
    };
    struct Entry {
        std::uint32_t child, count;
        float distance;
    };
    struct Build;

    static Float4 larger(Float4 a, Float4 b) { return a > b ? a : b; }
    static Float4 smaller(Float4 a, Float4 b) { return a < b ? a : b; }
    // Bit i: a[i] <= b[i].
    static unsigned lanes(Float4 a, Float4 b) {
#ifdef __SSE__
        return static_cast<unsigned>(_mm_movemask_ps(_mm_cmple_ps(a, b)));
#else
        unsigned bits = 0;
        for (unsigned i = 0; i < 4; ++i)
            bits |= a[i] <= b[i] ? 1u << i : 0u;
        return bits;
#endif
    }
    static Float4 all(float v) {
        return Float4{v, v, v, v};
    }

    std::vector<Node> nodes_;
    Box<float> bounds_;
};

template <class Leaf>
void Bvh::traverse(const Ray& ray, double& limit, Leaf&& leaf) const {
    if (nodes_.empty())
        return;
    Float4 origin[3], inverse[3];
    int nearPlane[3];
    for (int axis = 0; axis < 3; ++axis) {
        double d = ray.direction[axis];
        // A component of zero would make 0 × infinity; this small it changes no box test.
        if (std::abs(d) < 1e-12)
            d = d < 0 ? -1e-12 : 1e-12;
        origin[axis] = all(static_cast<float>(ray.origin[axis]));
        inverse[axis] = all(static_cast<float>(1 / d));
        nearPlane[axis] = axis * 2 + (d < 0 ? 1 : 0);
    }
    // At most 36 levels (see bvh.cpp), 3 waiting children each.
    std::array<Entry, 128> stack;
    std::size_t size = 0;
    stack[size++] = {0, 0, 0};
    while (size > 0) {
        Entry entry = stack[--size];
        if (entry.distance > limit)
            continue;
        if (entry.count > 0) {
            leaf(entry.child, entry.count);
            continue;
        }
        const Node& node = nodes_[entry.child];
        Float4 enter = all(0), leave = all(static_cast<float>(limit * (1 + 1e-6)));
        for (int axis = 0; axis < 3; ++axis) {
            Float4 n =
                (node.planes[static_cast<std::size_t>(nearPlane[axis])] - origin[axis]) * inverse[axis];
            Float4 f =
                (node.planes[static_cast<std::size_t>(nearPlane[axis] ^ 1)] - origin[axis]) * inverse[axis];
            enter = larger(enter, n);
            leave = smaller(leave, f);
        }
        std::size_t base = size;
        for (unsigned entered = lanes(enter, leave); entered != 0; entered &= entered - 1) {
            auto i = static_cast<std::size_t>(std::countr_zero(entered));
            Entry next{node.child[i], node.count[i], enter[i]};
            std::size_t at = size++;
            for (; at > base && stack[at - 1].distance < next.distance; --at)
                stack[at] = stack[at - 1];
            stack[at] = next;
        }
    }
}

template <class Leaf>
void Bvh::approach(Vec3d point, double& limit, Leaf&& leaf) const {
    if (nodes_.empty())
        return;
    std::array<Entry, 128> stack;
    std::size_t size = 0;
    stack[size++] = {0, 0, 0};
    Vec3f p = toFloat(point);
    while (size > 0) {
        Entry entry = stack[--size];
        if (entry.distance > limit)
            continue;
        if (entry.count > 0) {
            leaf(entry.child, entry.count);
            continue;
        }
        const Node& node = nodes_[entry.child];
        Float4 squared = all(0);
        for (int axis = 0; axis < 3; ++axis) {
            auto plane = static_cast<std::size_t>(axis) * 2;
            Float4 below = node.planes[plane] - all(p[axis]), above = all(p[axis]) - node.planes[plane + 1];
            Float4 outside = larger(larger(below, above), all(0));
            squared += outside * outside;
        }
        std::size_t base = size;
        for (std::size_t i = 0; i < 4; ++i) {
            float distance = std::sqrt(squared[i]);
            if (!(distance <= limit) || node.planes[0][i] > node.planes[1][i])
                continue;
            Entry next{node.child[i], node.count[i], distance};
            std::size_t at = size++;
            for (; at > base && stack[at - 1].distance < next.distance; --at)
                stack[at] = stack[at - 1];
            stack[at] = next;
        }
    }
}

} // namespace stipple::synth
