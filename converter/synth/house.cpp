#include "converter/synth/house.hpp"

#include "converter/synth/furniture.hpp"

#include <algorithm>
#include <cmath>

namespace stipple::synth {

namespace {

constexpr double storeyHeight = 2.75, slabThickness = 0.22, wallThickness = 0.32, plinthDepth = 3.0;

std::vector<Opening> windowRow(double size, double floor, int count, Random& random, bool door) {
    std::vector<Opening> openings;
    double step = size / count;
    int doorAt = door ? random.integer(0, count - 1) : -1;
    for (int i = 0; i < count; ++i) {
        double middle = (i + 0.5) * step;
        if (i == doorAt) {
            openings.push_back({middle - 0.5, middle + 0.5, floor + 0.01, floor + 2.1, Opening::Kind::door});
            continue;
        }
        double half = std::min(step * 0.3, random.chance(0.3) ? 0.9 : 0.6);
        bool tall = random.chance(0.12);
        openings.push_back({middle - half, middle + half, floor + (tall ? 0.1 : 0.9), floor + 2.2,
                            random.chance(0.25) ? Opening::Kind::openWindow : Opening::Kind::window});
    }
    return openings;
}

void addOuterWalls(Model& m, const HouseOptions& o, Random& random) {
    double x = o.width / 2, y = o.depth / 2, top = o.storeys * storeyHeight;
    Vec2d corners[4] = {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
    for (int side = 0; side < 4; ++side) {
        double size = side % 2 == 0 ? o.width : o.depth;
        Wall wall{corners[side], corners[(side + 1) % 4], 0, top, wallThickness,
                  o.wall,        Material::wallInside,    {}};
        int count = std::max(1, static_cast<int>(size / (side % 2 == 0 ? 2.8 : 3.6)));
        for (int storey = 0; storey < o.storeys; ++storey) {
            auto row = windowRow(size, storey * storeyHeight, count, random, side == 0 && storey == 0);
            wall.openings.insert(wall.openings.end(), row.begin(), row.end());
        }
        addWall(m, wall);
    }
    // Four faces of the plinth, 3 cm proud of nothing: flush with the wall, its own material.
    for (int side = 0; side < 4; ++side) {
        Vec2d p = corners[side], q = corners[(side + 1) % 4];
        m.quad({p.x, p.y, -plinthDepth}, {q.x, q.y, -plinthDepth}, {q.x, q.y, 0}, {p.x, p.y, 0},
               Material::concrete);
    }
}

void addGableRoof(Model& m, const HouseOptions& o) {
    constexpr double eaves = 0.45, thick = 0.18;
    double top = o.storeys * storeyHeight, y = o.depth / 2, x = o.width / 2;
    double ridge = top + y * o.pitch, low = top - eaves * o.pitch;
    bool hip = o.roof == RoofKind::hip;
    double ridgeX = hip ? std::max(0.3, x - y) : x + 0.3, endX = hip ? x + eaves : x + 0.3;
    for (double lift : {0.0, thick})
        for (double s : {-1.0, 1.0}) {
            Material material = lift > 0 ? Material::roof : Material::timber;
            m.quad({-endX, s * (y + eaves), low + lift}, {endX, s * (y + eaves), low + lift},
                   {ridgeX, 0, ridge + lift}, {-ridgeX, 0, ridge + lift}, material);
            if (hip)
                m.triangle({s * endX, -(y + eaves), low + lift}, {s * endX, y + eaves, low + lift},
                           {s * ridgeX, 0, ridge + lift}, material);
        }
    for (double s : {-1.0, 1.0}) {
        m.quad({-endX, s * (y + eaves), low}, {endX, s * (y + eaves), low},
               {endX, s * (y + eaves), low + thick}, {-endX, s * (y + eaves), low + thick}, Material::gutter);
        m.cylinder({-endX, s * (y + eaves + 0.07), low + 0.08}, {endX, s * (y + eaves + 0.07), low + 0.08},
                   0.07, Material::gutter);
        m.cylinder({s * (x - 0.15), -(y + 0.08), 0}, {s * (x - 0.15), -(y + 0.08), low + 0.05}, 0.05,
                   Material::gutter);
        if (hip)
            continue;
        for (double depth : {0.0, wallThickness})
            m.triangle({s * (x - depth), -y, top}, {s * (x - depth), y, top}, {s * (x - depth), 0, ridge},
                       depth > 0 ? Material::wallInside : o.wall);
        for (double t : {-1.0, 1.0})
            m.quad({s * endX, t * (y + eaves), low}, {s * endX, 0, ridge}, {s * endX, 0, ridge + thick},
                   {s * endX, t * (y + eaves), low + thick}, Material::timber);
    }
}

void addRoofThings(Model& m, const HouseOptions& o, Random& random) {
    double top = o.storeys * storeyHeight, y = o.depth / 2, x = o.width / 2;
    if (o.roof == RoofKind::flat) {
        addSlab(m, {{-x, -y}, {x, y}, top, top + 0.25, Material::roofFlat, Material::ceiling, o.wall});
        for (double s : {-1.0, 1.0}) {
            m.box({-x, s * y - 0.12, top + 0.25}, {x, s * y + 0.12, top + 0.75}, o.wall);
            m.box({s * x - 0.12, -y, top + 0.25}, {s * x + 0.12, y, top + 0.75}, o.wall);
        }
        m.box({-0.6, -0.5, top + 0.25}, {0.6, 0.5, top + 1.25}, Material::gutter);
        m.cylinder({x * 0.5, 0, top + 0.25}, {x * 0.5, 0, top + 1.4}, 0.12, Material::gutter);
        return;
    }
    double cx = random.uniform(-x * 0.5, x * 0.5), cy = random.uniform(-y * 0.3, y * 0.3);
    double under = top + (y - std::abs(cy)) * o.pitch;
    m.box({cx - 0.35, cy - 0.3, under - 0.8}, {cx + 0.35, cy + 0.3, top + y * o.pitch + 0.9},
          Material::chimney);
    m.box({cx - 0.42, cy - 0.37, top + y * o.pitch + 0.9}, {cx + 0.42, cy + 0.37, top + y * o.pitch + 1.0},
          Material::concrete);
    double side = random.chance(0.5) ? 1 : -1;
    auto onRoof = [&](double px, double away, double lift) {
        double py = side * away;
        return Vec3d{px, py, top + (y - away) * o.pitch + 0.18 + lift};
    };
    auto panel = [&](double x0, double x1, double a0, double a1, double lift, Material material) {
        m.quad(onRoof(x0, a0, lift), onRoof(x1, a0, lift), onRoof(x1, a1, lift), onRoof(x0, a1, lift),
               material);
    };
    double reach = o.roof == RoofKind::hip ? std::max(1.0, x - y) : x - 1;
    if (random.chance(0.35))
        for (double px = -reach; px + 1.0 < reach; px += 1.05)
            for (double a : {y * 0.2, y * 0.2 + 1.7})
                panel(px, px + 1.0, a, a + 1.65, 0.10, Material::solarPanel);
    side = -side;
    if (o.roof == RoofKind::gable && random.chance(0.45)) {
        // A dormer: a small gabled box that breaks the roof.
        double dx = random.uniform(-x * 0.4, x * 0.4), front = side * y * 0.78,
               base = top + y * 0.22 * o.pitch;
        double head = base + 1.5, back = side * y * 0.15;
        m.quad({dx - 0.8, front, base}, {dx + 0.8, front, base}, {dx + 0.8, front, head},
               {dx - 0.8, front, head}, o.wall);
        m.triangle({dx - 0.8, front, head}, {dx + 0.8, front, head}, {dx, front, head + 0.6}, o.wall);
        m.quad({dx - 0.5, front + side * 0.02, base + 0.5}, {dx + 0.5, front + side * 0.02, base + 0.5},
               {dx + 0.5, front + side * 0.02, head - 0.1}, {dx - 0.5, front + side * 0.02, head - 0.1},
               Material::solarPanel);
        for (double s : {-1.0, 1.0}) {
            m.quad({dx + s * 0.8, front, base}, {dx + s * 0.8, front, head}, {dx + s * 0.8, back, head},
                   {dx + s * 0.8, back, base}, o.wall);
            m.quad({dx + s * 1.0, front + side * 0.2, head - 0.15}, {dx, front + side * 0.2, head + 0.65},
                   {dx, back, head + 0.65}, {dx + s * 1.0, back, head - 0.15}, Material::roof);
        }
    } else if (random.chance(0.5)) {
        for (double px : {-reach * 0.5, reach * 0.3})
            panel(px, px + 0.8, y * 0.4, y * 0.4 + 1.0, 0.06, Material::solarPanel);
    }
}

// Two rooms a storey, a cross wall with a door, stairs along the back wall.
void addInterior(Model& m, const HouseOptions& o, Random& random) {
    double x = o.width / 2 - wallThickness, y = o.depth / 2 - wallThickness;
    double cross = random.uniform(-0.15, 0.15) * o.width;
    constexpr double stairRun = 3.4, stairWidth = 0.95;
    Vec2d holeMin{cross + 0.3, y - stairWidth - 0.05}, holeMax{cross + 0.3 + stairRun, y};
    bool stairs = o.storeys > 1 && holeMax.x < x;
    for (int storey = 0; storey <= o.storeys; ++storey) {
        bool attic = storey == o.storeys;
        if (attic && o.roof == RoofKind::flat)
            break;
        double floor = storey * storeyHeight;
        addSlab(m, {{-x, -y},
                    {x, y},
                    floor - slabThickness,
                    floor,
                    attic ? Material::timber : Material::floorWood,
                    Material::ceiling,
                    Material::wallInside,
                    stairs && storey > 0 && !attic,
                    holeMin,
                    holeMax});
        if (attic)
            break;
        Wall inner{
            {cross, -y},          {cross, y},           floor, floor + storeyHeight - slabThickness, 0.12,
            Material::wallInside, Material::wallInside, {}};
        inner.openings.push_back({y * 0.8, y * 0.8 + 0.9, floor, floor + 2.05, Opening::Kind::hole});
        addWall(m, inner);
        if (stairs && storey + 1 < o.storeys)
            addStairs(m, {holeMin.x, y - stairWidth / 2 - 0.02, floor}, 0, stairWidth, stairRun, storeyHeight,
                      15, Material::stairs);
        double left = (cross - x) / 2, right = (cross + x) / 2;
        if (storey == 0) {
            m.append(makeDiningSet(4), {left, -y * 0.35, floor}, 0.05);
            m.append(makeKitchen(std::min(2.6, cross + x - 0.6)), {left, y - 0.32, floor});
            m.append(makeSofa(), {right, -y + 1.9, floor}, pi);
            m.append(makeTable(1.0, 0.6, 0.42), {right, -y + 0.9, floor});
            m.append(makeShelf(1.6, 2.0, random.child(1)), {x - 0.18, 0.2, floor}, -pi / 2);
        } else {
            m.append(makeBed(), {left, y - 1.25, floor});
            m.append(makeCupboard(1.4, 2.0), {-x + 0.32, -y * 0.4, floor}, pi / 2);
            m.append(makeDesk(), {right, -y + 0.6, floor}, pi);
            m.append(makeChair(), {right, -y + 1.25, floor}, 0.3);
        }
        for (double px : {left, right})
            m.append(makePendantLamp(0.45), {px, -y * 0.35, floor + storeyHeight - slabThickness});
    }
}

void addSteps(Model& m, const HouseOptions& o) {
    // A landing along the door's facade with steps to either side, down to below any slope.
    m.box({-1.2, -o.depth / 2 - 1.4, -plinthDepth}, {1.2, -o.depth / 2, -0.05}, Material::concrete);
    for (int i = 0; i < 5; ++i)
        m.box({-1.2, -o.depth / 2 - 1.7 - 0.3 * i, -plinthDepth},
              {1.2, -o.depth / 2 - 1.4 - 0.3 * i, -0.22 - 0.17 * i}, Material::concrete);
}

void addBalconies(Model& m, const HouseOptions& o) {
    for (int storey = 1; storey < o.storeys; ++storey)
        for (double x = -o.width / 2 + 3; x < o.width / 2 - 2; x += 6) {
            double z = storey * storeyHeight, y = o.depth / 2;
            m.box({x - 1.5, y, z - 0.16}, {x + 1.5, y + 1.4, z}, Material::concrete);
            for (double h : {0.35, 0.7, 1.05}) {
                m.cylinder({x - 1.5, y + 1.38, z + h}, {x + 1.5, y + 1.38, z + h}, 0.02, Material::gutter);
                for (double s : {-1.5, 1.5})
                    m.cylinder({x + s, y, z + h}, {x + s, y + 1.38, z + h}, 0.02, Material::gutter);
            }
        }
}

} // namespace

HouseOptions randomHouse(Random random) {
    HouseOptions o;
    o.width = 0.5 * random.integer(18, 26);
    o.depth = 0.5 * random.integer(15, 19);
    o.storeys = random.chance(0.35) ? 1 : 2;
    double kind = random.uniform();
    o.roof = kind < 0.6 ? RoofKind::gable : kind < 0.85 ? RoofKind::hip : RoofKind::flat;
    o.pitch = random.uniform(0.55, 0.95);
    if (random.chance(0.2))
        o.wall = Material::brick;
    return o;
}

HouseModel makeHouse(const HouseOptions& o, Random random) {
    HouseModel house;
    house.width = o.width;
    house.depth = o.depth;
    house.livingRoom = {o.width * 0.22, 0.6, 1.6};
    Model& m = house.model;
    addOuterWalls(m, o, random);
    if (o.roof != RoofKind::flat)
        addGableRoof(m, o);
    addRoofThings(m, o, random);
    if (o.interior)
        addInterior(m, o, random);
    else
        for (int storey = 0; storey < o.storeys; ++storey)
            addSlab(m, {{-o.width / 2 + wallThickness, -o.depth / 2 + wallThickness},
                        {o.width / 2 - wallThickness, o.depth / 2 - wallThickness},
                        storey * storeyHeight - slabThickness,
                        storey * storeyHeight,
                        Material::floorTile,
                        Material::ceiling,
                        Material::concrete});
    addSteps(m, o);
    if (o.balconies)
        addBalconies(m, o);
    return house;
}

Model makeChurch() {
    Model m;
    constexpr double halfWidth = 6, naveSize = 26, eaves = 9, ridge = 16;
    double y0 = -naveSize / 2, y1 = naveSize / 2;
    Vec2d corners[4] = {{-halfWidth, y0}, {halfWidth, y0}, {halfWidth, y1}, {-halfWidth, y1}};
    for (int side = 0; side < 4; ++side) {
        double size = side % 2 == 0 ? 2 * halfWidth : naveSize;
        Wall wall{corners[side],   corners[(side + 1) % 4], 0, eaves, 0.8,
                  Material::stone, Material::wallInside,    {}};
        if (side % 2 == 1)
            for (double x = 3; x < size - 2; x += 4.6)
                wall.openings.push_back({x - 0.7, x + 0.7, 2.5, 7.2, Opening::Kind::window});
        addWall(m, wall);
        // Buttresses between the windows.
        if (side % 2 == 1)
            for (double y = y0 + 0.7; y < y1; y += 4.6)
                m.box({side == 1 ? halfWidth : -halfWidth - 0.9, y - 0.4, -3},
                      {side == 1 ? halfWidth + 0.9 : -halfWidth, y + 0.4, 6.5}, Material::stone);
    }
    m.box({-halfWidth, y0, -3}, {halfWidth, y1, 0.02}, Material::stone);
    for (double s : {-1.0, 1.0}) {
        m.quad({s * (halfWidth + 0.5), y0 - 0.3, eaves - 0.5}, {s * (halfWidth + 0.5), y1 + 0.3, eaves - 0.5},
               {0, y1 + 0.3, ridge}, {0, y0 - 0.3, ridge}, Material::roof);
        m.triangle({-halfWidth, s * y1, eaves}, {halfWidth, s * y1, eaves}, {0, s * y1, ridge},
                   Material::stone);
    }
    for (double y = y0 + 5; y < y1 - 3; y += 1.6)
        for (double x : {-3.2, 0.6})
            m.box({x, y, 0}, {x + 2.6, y + 0.45, 0.9}, Material::wood);
    // The tower with its open belfry and spire.
    constexpr double half = 3.2, towerTop = 26, spire = 44;
    double ty = y0 - half;
    Vec2d t[4] = {{-half, ty - half}, {half, ty - half}, {half, ty + half}, {-half, ty + half}};
    for (int side = 0; side < 4; ++side) {
        Wall wall{t[side], t[(side + 1) % 4], -3, towerTop, 0.9, Material::stone, Material::stone, {}};
        wall.openings.push_back({half - 0.8, half + 0.8, 19, 23.5, Opening::Kind::hole});
        if (side == 0)
            wall.openings.push_back({half - 1.0, half + 1.0, 0, 3.4, Opening::Kind::door});
        addWall(m, wall);
        Vec2d p = t[side], q = t[(side + 1) % 4];
        Vec2d middle{0, ty};
        auto wide = [&](Vec2d c) { return middle + (c - middle) * 1.08; };
        m.triangle({wide(p).x, wide(p).y, towerTop}, {wide(q).x, wide(q).y, towerTop}, {0, ty, spire},
                   Material::roof);
    }
    m.box({-half, ty - half, 18.6}, {half, ty + half, 18.9}, Material::timber);
    m.cylinder({0, ty, spire - 0.3}, {0, ty, spire + 1.6}, 0.06, Material::gutter);
    m.cylinder({-0.5, ty, spire + 1.0}, {0.5, ty, spire + 1.0}, 0.05, Material::gutter);
    m.frustum({0, ty, 20}, {0, ty, 21.2}, 0.7, 0.3, Material::gutter);
    return m;
}

Model makeTowerBlock(int storeys, double width, double depth) {
    HouseOptions o;
    o.width = width;
    o.depth = depth;
    o.storeys = storeys;
    o.roof = RoofKind::flat;
    o.interior = false;
    o.balconies = true;
    return makeHouse(o,
                     Random(static_cast<std::uint64_t>(storeys * 1000) + static_cast<std::uint64_t>(width)))
        .model;
}

Model makeHall(double width, double depth, double height) {
    Model m;
    double x = width / 2, y = depth / 2;
    Vec2d corners[4] = {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
    for (int side = 0; side < 4; ++side) {
        Wall wall{corners[side],  corners[(side + 1) % 4], 0, height, 0.25,
                  Material::wall, Material::wallInside,    {}};
        if (side == 0) {
            for (double a = 2; a + 4 < width; a += 5)
                wall.openings.push_back({a, a + 4, 0.1, 3.0, Opening::Kind::window});
        } else if (side == 2) {
            wall.openings.push_back({2, 6, 0, 4, Opening::Kind::hole});
        }
        addWall(m, wall);
        Vec2d p = corners[side], q = corners[(side + 1) % 4];
        m.quad({p.x, p.y, -plinthDepth}, {q.x, q.y, -plinthDepth}, {q.x, q.y, 0}, {p.x, p.y, 0},
               Material::concrete);
    }
    addSlab(m, {{-x, -y}, {x, y}, -0.2, 0, Material::floorTile, Material::concrete, Material::concrete});
    addSlab(m, {{-x - 0.2, -y - 0.2},
                {x + 0.2, y + 0.2},
                height,
                height + 0.4,
                Material::roofFlat,
                Material::ceiling,
                Material::gutter});
    for (double a = -x + 4; a < x - 3; a += 7)
        for (double b = -y + 4; b < y - 2; b += 6) {
            m.box({a, b, height + 0.4}, {a + 2.2, b + 1.4, height + 0.9}, Material::solarPanel);
            m.append(makeShelf(2.4, 2.0, Random(7)), {a, b, 0}, pi / 2);
        }
    m.box({x - 6, y - 5, height + 0.4}, {x - 2, y - 2, height + 2.0}, Material::gutter);
    return m;
}

Model makeShed() {
    Model m;
    m.box({-1.4, -1.1, -1}, {1.4, 1.1, 2.0}, Material::timber);
    for (double s : {-1.0, 1.0}) {
        m.quad({-1.6, s * 1.35, 1.9}, {1.6, s * 1.35, 1.9}, {1.6, 0, 2.8}, {-1.6, 0, 2.8},
               Material::roofFlat);
        m.triangle({s * 1.4, -1.1, 2.0}, {s * 1.4, 1.1, 2.0}, {s * 1.4, 0, 2.75}, Material::timber);
    }
    return m;
}

} // namespace stipple::synth
