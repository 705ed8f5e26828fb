#include "converter/synth/model.hpp"

#include <algorithm>
#include <cmath>

namespace stipple::synth {

void Model::triangle(Vec3d a, Vec3d b, Vec3d c, Material material, std::uint32_t tag) {
    Primitive p;
    p.material = material;
    p.tag = tag;
    p.a = toFloat(a);
    p.b = toFloat(b);
    p.c = toFloat(c);
    primitives.push_back(p);
}

void Model::quad(Vec3d a, Vec3d b, Vec3d c, Vec3d d, Material material, std::uint32_t tag) {
    triangle(a, b, c, material, tag);
    triangle(a, c, d, material, tag);
}

void Model::box(Vec3d lo, Vec3d hi, Material material) {
    standingBox({(lo.x + hi.x) / 2, (lo.y + hi.y) / 2, lo.z}, hi - lo, 0, material);
}

void Model::standingBox(Vec3d at, Vec3d size, double yaw, Material material) {
    double c = std::cos(yaw), s = std::sin(yaw);
    auto corner = [&](double sx, double sy, double z) {
        double x = sx * size.x / 2, y = sy * size.y / 2;
        return Vec3d{at.x + c * x - s * y, at.y + s * x + c * y, at.z + z};
    };
    constexpr int around[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (int i = 0; i < 4; ++i) {
        const int* p = around[i];
        const int* q = around[(i + 1) % 4];
        quad(corner(p[0], p[1], 0), corner(q[0], q[1], 0), corner(q[0], q[1], size.z),
             corner(p[0], p[1], size.z), material);
    }
    for (double z : {0.0, size.z})
        quad(corner(-1, -1, z), corner(1, -1, z), corner(1, 1, z), corner(-1, 1, z), material);
}

void Model::frustum(Vec3d from, Vec3d to, double radius, double radiusEnd, Material material) {
    Primitive p;
    p.shape = Primitive::Shape::frustum;
    p.material = material;
    p.a = toFloat(from);
    p.b = toFloat(to);
    p.radius = static_cast<float>(radius);
    p.radiusEnd = static_cast<float>(radiusEnd);
    primitives.push_back(p);
}

void Model::disc(Vec3d centre, Vec3d normal, double radius, Material material) {
    Primitive p;
    p.shape = Primitive::Shape::disc;
    p.material = material;
    p.a = toFloat(centre);
    p.b = toFloat(normalized(normal));
    p.radius = static_cast<float>(radius);
    primitives.push_back(p);
}

void Model::sphere(Vec3d centre, double radius, Material material) {
    Primitive p;
    p.shape = Primitive::Shape::sphere;
    p.material = material;
    p.a = toFloat(centre);
    p.radius = static_cast<float>(radius);
    primitives.push_back(p);
}

void Model::wire(Vec3d from, Vec3d to, double sag, int segments, double radius, Material material) {
    auto at = [&](int i) {
        double t = static_cast<double>(i) / segments;
        Vec3d p = from + (to - from) * t;
        p.z -= 4 * sag * t * (1 - t);
        return p;
    };
    for (int i = 0; i < segments; ++i)
        cylinder(at(i), at(i + 1), radius, material);
}

void Model::append(const Model& part, Vec3d at, double yaw) {
    double c = std::cos(yaw), s = std::sin(yaw);
    auto turn = [&](Vec3f v) { return Vec3d{c * v.x - s * v.y, s * v.x + c * v.y, v.z}; };
    for (Primitive p : part.primitives) {
        bool isDisc = p.shape == Primitive::Shape::disc;
        p.a = toFloat(turn(p.a) + at);
        p.b = isDisc ? toFloat(normalized(turn(p.b))) : toFloat(turn(p.b) + at);
        p.c = toFloat(turn(p.c) + at);
        primitives.push_back(p);
    }
}

namespace {

// A wall's frame: along it, up, and out of it (0 at the outer face, negative inside).
struct WallFrame {
    Vec2d origin, along, out;
    Vec3d at(double x, double z, double depth) const {
        Vec2d p = origin + along * x - out * depth;
        return {p.x, p.y, z};
    }
};

std::vector<double> cuts(double from, double to, const std::vector<Opening>& openings, bool horizontal) {
    std::vector<double> at{from, to};
    for (const Opening& o : openings) {
        at.push_back(horizontal ? o.from : o.sill);
        at.push_back(horizontal ? o.to : o.head);
    }
    std::sort(at.begin(), at.end());
    at.erase(std::unique(at.begin(), at.end()), at.end());
    return at;
}

void addFrame(Model& model, const WallFrame& f, const Opening& o, double depth) {
    constexpr double w = 0.06, half = 0.03;
    auto bar = [&](double x0, double x1, double z0, double z1) {
        for (double d : {depth - half, depth + half})
            model.quad(f.at(x0, z0, d), f.at(x1, z0, d), f.at(x1, z1, d), f.at(x0, z1, d),
                       Material::windowFrame);
    };
    bar(o.from, o.from + w, o.sill, o.head);
    bar(o.to - w, o.to, o.sill, o.head);
    bar(o.from + w, o.to - w, o.sill, o.sill + w);
    bar(o.from + w, o.to - w, o.head - w, o.head);
    if (o.to - o.from > 1.1) {
        double middle = (o.from + o.to) / 2;
        bar(middle - half, middle + half, o.sill + w, o.head - w);
    }
}

void addOpening(Model& model, const WallFrame& f, const Wall& wall, const Opening& o) {
    auto reveal = [&](double x0, double z0, double x1, double z1) {
        model.quad(f.at(x0, z0, 0), f.at(x1, z1, 0), f.at(x1, z1, wall.thickness),
                   f.at(x0, z0, wall.thickness), wall.outer);
    };
    reveal(o.from, o.sill, o.from, o.head);
    reveal(o.to, o.sill, o.to, o.head);
    reveal(o.from, o.head, o.to, o.head);
    reveal(o.from, o.sill, o.to, o.sill);
    double depth = wall.thickness * 0.6;
    switch (o.kind) {
    case Opening::Kind::window:
        model.quad(f.at(o.from, o.sill, depth), f.at(o.to, o.sill, depth), f.at(o.to, o.head, depth),
                   f.at(o.from, o.head, depth), Material::glass);
        addFrame(model, f, o, depth);
        break;
    case Opening::Kind::openWindow:
        addFrame(model, f, o, depth);
        break;
    case Opening::Kind::door: {
        // Ajar: hinged at `from`, turned inwards.
        Vec3d hinge = f.at(o.from + 0.02, o.sill, wall.thickness);
        constexpr double angle = 1.2;
        Vec2d leaf = f.along * std::cos(angle) - f.out * std::sin(angle);
        double half = (o.to - o.from - 0.04) / 2;
        model.standingBox({hinge.x + leaf.x * half, hinge.y + leaf.y * half, o.sill},
                          {half * 2, 0.05, o.head - o.sill}, std::atan2(leaf.y, leaf.x), Material::door);
        break;
    }
    case Opening::Kind::hole:
        break;
    }
}

} // namespace

void addWall(Model& model, const Wall& wall) {
    Vec2d d = wall.b - wall.a;
    double size = std::hypot(d.x, d.y);
    Vec2d along = d * (1 / size);
    WallFrame f{wall.a, along, {along.y, -along.x}};
    std::vector<double> xs = cuts(0, size, wall.openings, true);
    std::vector<double> zs = cuts(wall.bottom, wall.top, wall.openings, false);
    for (std::size_t j = 0; j + 1 < zs.size(); ++j)
        for (std::size_t i = 0; i + 1 < xs.size(); ++i) {
            double x = (xs[i] + xs[i + 1]) / 2, z = (zs[j] + zs[j + 1]) / 2;
            bool open = std::any_of(wall.openings.begin(), wall.openings.end(), [&](const Opening& o) {
                return x > o.from && x < o.to && z > o.sill && z < o.head;
            });
            if (open)
                continue;
            for (bool inside : {false, true}) {
                double depth = inside ? wall.thickness : 0;
                model.quad(f.at(xs[i], zs[j], depth), f.at(xs[i + 1], zs[j], depth),
                           f.at(xs[i + 1], zs[j + 1], depth), f.at(xs[i], zs[j + 1], depth),
                           inside ? wall.inner : wall.outer);
            }
        }
    for (const Opening& o : wall.openings)
        addOpening(model, f, wall, o);
}

void addSlab(Model& model, const Slab& slab) {
    auto sheet = [&](Vec2d lo, Vec2d hi) {
        if (hi.x <= lo.x || hi.y <= lo.y)
            return;
        model.quad({lo.x, lo.y, slab.top}, {hi.x, lo.y, slab.top}, {hi.x, hi.y, slab.top},
                   {lo.x, hi.y, slab.top}, slab.above);
        model.quad({lo.x, lo.y, slab.bottom}, {hi.x, lo.y, slab.bottom}, {hi.x, hi.y, slab.bottom},
                   {lo.x, hi.y, slab.bottom}, slab.below);
    };
    auto rim = [&](Vec2d lo, Vec2d hi) {
        Vec2d corners[4] = {lo, {hi.x, lo.y}, hi, {lo.x, hi.y}};
        for (int i = 0; i < 4; ++i) {
            Vec2d p = corners[i], q = corners[(i + 1) % 4];
            model.quad({p.x, p.y, slab.bottom}, {q.x, q.y, slab.bottom}, {q.x, q.y, slab.top},
                       {p.x, p.y, slab.top}, slab.edge);
        }
    };
    rim(slab.min, slab.max);
    if (!slab.hasHole) {
        sheet(slab.min, slab.max);
        return;
    }
    rim(slab.holeMin, slab.holeMax);
    sheet(slab.min, {slab.max.x, slab.holeMin.y});
    sheet({slab.min.x, slab.holeMax.y}, slab.max);
    sheet({slab.min.x, slab.holeMin.y}, {slab.holeMin.x, slab.holeMax.y});
    sheet({slab.holeMax.x, slab.holeMin.y}, {slab.max.x, slab.holeMax.y});
}

void addStairs(Model& model, Vec3d foot, double yaw, double width, double run, double rise, int steps,
               Material material) {
    double depth = run / steps, height = rise / steps;
    for (int i = 0; i < steps; ++i) {
        double along = (i + 0.5) * depth;
        // Each step is a tread with a nosing, 4 cm deep below: from under the stairs one sees saw teeth.
        model.standingBox({foot.x + std::cos(yaw) * along, foot.y + std::sin(yaw) * along,
                           foot.z + (i == 0 ? 0 : i * height - 0.04)},
                          {depth, width, i == 0 ? height : height + 0.04}, yaw, material);
    }
}

} // namespace stipple::synth
