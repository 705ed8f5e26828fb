#include "converter/synth/furniture.hpp"
#include "converter/synth/scenes.hpp"
#include "converter/synth/tree.hpp"

#include <cmath>

namespace stipple::synth {

namespace {

constexpr double buildingX = 48, buildingY = 16, storeyHeight = 3.3, slab = 0.3, outerWall = 0.36,
                 innerWall = 0.14;
constexpr double corridorFrom = 6.7, corridorTo = 9.3, bay = 6;
constexpr int storeys = 3, bays = 8, stairBay = 7;

class IndoorBuilder {
  public:
    explicit IndoorBuilder(std::uint64_t seed)
        : random_(seed ^ 0x696e646f), scene_(SceneKind::indoor, seed, 0) {}

    std::unique_ptr<const Scene> build() {
        makeModels();
        scene_.placeOnce(shell(), {Rgb{0.86f, 0.83f, 0.76f}, Rgb{0.4f, 0.4f, 0.4f}});
        for (int storey = 0; storey < storeys; ++storey) {
            for (int i = 0; i < bays; ++i)
                for (bool north : {false, true})
                    if (!(north && i == stairBay))
                        furnish(storey, i, north);
            furnishCorridor(storey);
        }
        addOutdoors();
        return scene_.finish();
    }

  private:
    static constexpr Vec2d stairHoleMin{bay * stairBay + 1.0, corridorTo + 1.6};
    static constexpr Vec2d stairHoleMax{bay * stairBay + 5.0, corridorTo + 4.4};

    void makeModels() {
        desk_ = scene_.addMesh(makeDesk());
        chair_ = scene_.addMesh(makeChair());
        table_ = scene_.addMesh(makeTable(1.4, 0.7, 0.74));
        meeting_ = scene_.addMesh(makeDiningSet(8));
        sofa_ = scene_.addMesh(makeSofa());
        lowTable_ = scene_.addMesh(makeTable(1.1, 0.6, 0.42));
        kitchen_ = scene_.addMesh(makeKitchen(3.2));
        cupboard_ = scene_.addMesh(makeCupboard(1.0, 1.9));
        lamp_ = scene_.addMesh(makeTubeLamp(1.4));
        pendant_ = scene_.addMesh(makePendantLamp(0.6));
        for (std::uint64_t i = 0; i < 4; ++i) {
            shelves_.push_back(
                scene_.addMesh(makeShelf(1.2 + 0.3 * static_cast<double>(i), 2.1, random_.child(i))));
            plants_.push_back(scene_.addMesh(makePottedPlant(random_.child(20 + i))));
        }
        Model board;
        board.box({-1.4, -0.02, 0.9}, {1.4, 0.02, 2.1}, Material::whiteBoard);
        board_ = scene_.addMesh(std::move(board));
    }

    Model shell();
    void addStorey(Model& m, int storey);
    void furnish(int storey, int index, bool north);
    void furnishCorridor(int storey);
    void addOutdoors();

    // In a room's own frame: x 0..bay, y from the corridor wall (0) to the windows (about 6.2).
    void put(std::uint32_t mesh, double x, double y, double turn) {
        double jitter = random_.uniform(-0.06, 0.06);
        Vec3d at{roomX_ + x, roomNorth_ ? corridorTo + innerWall + y : corridorFrom - innerWall - y, floor_};
        scene_.place({mesh, at, (roomNorth_ ? turn : turn + pi) + jitter, 1, {Rgb{0.24f, 0.42f, 0.16f}}});
    }
    void putLamp(std::uint32_t mesh, double x, double y, double turn) {
        scene_.place({mesh, {x, y, floor_ + storeyHeight - slab}, turn, 1, {}});
    }
    std::uint32_t anyOf(const std::vector<std::uint32_t>& meshes) {
        return meshes[random_.bits() % meshes.size()];
    }

    Random random_;
    SceneBuilder scene_;
    std::uint32_t desk_ = 0, chair_ = 0, table_ = 0, meeting_ = 0, sofa_ = 0, lowTable_ = 0, kitchen_ = 0;
    std::uint32_t cupboard_ = 0, lamp_ = 0, pendant_ = 0, board_ = 0;
    std::vector<std::uint32_t> shelves_, plants_;
    double roomX_ = 0, floor_ = 0;
    bool roomNorth_ = false;
};

Model IndoorBuilder::shell() {
    Model m;
    for (int storey = 0; storey < storeys; ++storey)
        addStorey(m, storey);
    double top = storeys * storeyHeight;
    addSlab(m, {{0, 0},
                {buildingX, buildingY},
                top - slab,
                top,
                Material::roofFlat,
                Material::ceiling,
                Material::wall});
    for (double y : {0.0, buildingY - 0.3})
        m.box({0, y, top}, {buildingX, y + 0.3, top + 0.8}, Material::wall);
    for (double x : {0.0, buildingX - 0.3})
        m.box({x, 0, top}, {x + 0.3, buildingY, top + 0.8}, Material::wall);
    return m;
}

void IndoorBuilder::addStorey(Model& m, int storey) {
    double floor = storey * storeyHeight, head = floor + storeyHeight - slab;
    addSlab(m, {{outerWall, outerWall},
                {buildingX - outerWall, buildingY - outerWall},
                floor - slab,
                floor,
                storey == 0 ? Material::floorTile : Material::carpet,
                Material::ceiling,
                Material::concrete,
                storey > 0,
                stairHoleMin,
                stairHoleMax});
    // Facades: two windows a bay along the length, one at each end of the corridor.
    Vec2d corners[4] = {{0, 0}, {buildingX, 0}, {buildingX, buildingY}, {0, buildingY}};
    for (int side = 0; side < 4; ++side) {
        Wall wall{corners[side], corners[(side + 1) % 4], floor - slab,         head,
                  outerWall,     Material::wall,          Material::wallInside, {}};
        if (side % 2 == 0) {
            for (int i = 0; i < bays; ++i)
                for (double x : {1.0, 3.4})
                    wall.openings.push_back(
                        {i * bay + x, i * bay + x + 1.7, floor + 0.9, floor + 2.5,
                         random_.chance(0.15) ? Opening::Kind::openWindow : Opening::Kind::window});
        } else {
            bool entrance = storey == 0 && side == 3;
            double middle = buildingY / 2;
            wall.openings.push_back({middle - 0.9, middle + 0.9, floor + (entrance ? 0.0 : 0.9), floor + 2.4,
                                     entrance ? Opening::Kind::hole : Opening::Kind::window});
        }
        addWall(m, wall);
    }
    // Corridor walls with a door a bay; the stairwell is open to the corridor.
    for (bool north : {false, true}) {
        double y = north ? corridorTo : corridorFrom;
        Wall wall{{outerWall, y},       {buildingX - outerWall, y}, floor, head, innerWall,
                  Material::wallInside, Material::wallInside,       {}};
        if (!north) // the outer face looks into the corridor on either side
            std::swap(wall.a, wall.b);
        for (int i = 0; i < bays; ++i) {
            double from = i * bay + 0.5 - outerWall;
            bool open = north && i == stairBay;
            double to = from + (open ? 4.5 : 0.95);
            if (!north) {
                double size = buildingX - 2 * outerWall;
                wall.openings.push_back({size - to, size - from, floor, floor + 2.1, Opening::Kind::door});
            } else {
                wall.openings.push_back({from, to, floor, floor + (open ? 2.6 : 2.1),
                                         open ? Opening::Kind::hole : Opening::Kind::door});
            }
        }
        addWall(m, wall);
        for (int i = 1; i < bays; ++i) {
            double y0 = north ? corridorTo + innerWall : outerWall;
            double y1 = north ? buildingY - outerWall : corridorFrom - innerWall;
            Wall between{{i * bay, y0},        {i * bay, y1},        floor, head, innerWall,
                         Material::wallInside, Material::wallInside, {}};
            if (random_.chance(0.2) && !(north && i == stairBay))
                between.openings.push_back({2.0, 3.0, floor, floor + 2.1, Opening::Kind::hole});
            addWall(m, between);
        }
    }
    // A flight along the window side up to a landing's height, one back: two straight flights side by side.
    if (storey + 1 < storeys) {
        double half = storeyHeight / 2, y0 = stairHoleMin.y + 0.7, y1 = stairHoleMax.y - 0.7;
        addStairs(m, {stairHoleMin.x, y0, floor}, 0, 1.25, 2.8, half, 10, Material::stairs);
        m.box({stairHoleMin.x + 2.8, stairHoleMin.y, floor + half - 0.16},
              {stairHoleMax.x, stairHoleMax.y, floor + half}, Material::stairs);
        addStairs(m, {stairHoleMin.x + 2.8, y1, floor + half}, pi, 1.25, 2.8, half, 10, Material::stairs);
        for (double z : {0.5, 1.0})
            m.cylinder({stairHoleMin.x, (y0 + y1) / 2, floor + z},
                       {stairHoleMin.x + 2.8, (y0 + y1) / 2, floor + z + half}, 0.025, Material::railing);
    }
    if (storey > 0)
        for (double z : {0.5, 1.0})
            m.cylinder({stairHoleMin.x, stairHoleMin.y - 0.05, floor + z},
                       {stairHoleMax.x, stairHoleMin.y - 0.05, floor + z}, 0.025, Material::railing);
}

void IndoorBuilder::furnish(int storey, int index, bool north) {
    roomX_ = index * bay;
    roomNorth_ = north;
    floor_ = storey * storeyHeight;
    double middleY = north ? corridorTo + 3.3 : corridorFrom - 3.3;
    for (double dx : {-1.4, 1.4})
        for (double dy : {-1.3, 1.3})
            putLamp(lamp_, roomX_ + bay / 2 + dx, middleY + dy, 0);
    // x grows to the left when the room faces south: mirrored rooms look as varied as they should.
    switch (random_.integer(0, 4)) {
    case 0: // office for three or four
        for (double x : {1.4, 4.4})
            for (double y : {2.2, 4.6})
                if (random_.chance(0.9)) {
                    put(desk_, x, y, 0);
                    put(chair_, x, y - 0.75, random_.uniform(2.6, 3.7));
                }
        put(anyOf(shelves_), 3.6, 0.2, pi);
        break;
    case 1: // meeting room
        put(meeting_, 3.0, 3.2, 0);
        put(board_, 3.0, 6.0, 0);
        put(cupboard_, 4.6, 0.35, pi);
        break;
    case 2: // classroom
        for (double x : {1.3, 3.0, 4.7})
            for (double y : {1.9, 3.3, 4.7}) {
                put(table_, x, y, 0);
                put(chair_, x - 0.35, y - 0.6, pi + random_.uniform(-0.3, 0.3));
                put(chair_, x + 0.35, y - 0.6, pi + random_.uniform(-0.3, 0.3));
            }
        put(board_, 3.6, 0.06, pi);
        break;
    case 3: // library
        for (double y : {1.6, 3.0, 4.4}) {
            put(shelves_[3], 2.3, y, 0);
            put(shelves_[3], 4.3, y, 0);
            put(shelves_[2], 2.3, y + 0.32, pi);
        }
        put(table_, 3.0, 5.6, 0);
        // The shelves hide one half of the room from the other.
        scene_.station({Vec3d{roomX_ + 3.0, north ? corridorTo + 0.9 : corridorFrom - 0.9, floor_ + 1.62}});
        break;
    default: // lounge with a kitchen
        put(kitchen_, 3.6, 0.36, pi);
        put(sofa_, 1.3, 3.8, pi / 2);
        put(lowTable_, 2.6, 3.8, pi / 2);
        put(sofa_, 3.9, 3.8, -pi / 2);
        put(meeting_, 3.4, 5.5, 0);
        putLamp(pendant_, roomX_ + 3.4, middleY, 0);
        break;
    }
    put(anyOf(plants_), 0.5, 5.8, random_.uniform(0, 6));
    double eye = floor_ + 1.62;
    // Near the middle, where nothing stands.
    double side = north ? 1 : -1;
    std::vector<Vec3d> wish;
    for (double dy : {-0.4, -1.7, 1.2, 1.9, -2.3})
        for (double dx : {-0.1, 0.8, -0.9, 2.0})
            wish.push_back({roomX_ + bay / 2 + dx, middleY + side * dy, eye});
    scene_.station(std::move(wish));
}

void IndoorBuilder::furnishCorridor(int storey) {
    floor_ = storey * storeyHeight;
    roomNorth_ = true;
    for (double x = 3; x < buildingX; x += 4.5)
        putLamp(lamp_, x, (corridorFrom + corridorTo) / 2, 0);
    for (double x = 9; x < buildingX - 4; x += 12) {
        scene_.place(
            {anyOf(plants_), {x - 0.6, corridorFrom + 0.35, floor_}, 0, 1, {Rgb{0.24f, 0.42f, 0.16f}}});
        scene_.place({cupboard_, {x + 2.6, corridorTo - 0.32, floor_}, 0, 1, {}});
    }
    for (double x = 4; x < buildingX; x += 10)
        scene_.station({Vec3d{x, (corridorFrom + corridorTo) / 2, floor_ + 1.65}});
    scene_.station({Vec3d{bay * stairBay + 0.6, corridorTo + 0.9, floor_ + 1.65}});
}

void IndoorBuilder::addOutdoors() {
    Model lawn;
    lawn.quad({-60, -60, -0.35}, {buildingX + 60, -60, -0.35}, {buildingX + 60, buildingY + 60, -0.35},
              {-60, buildingY + 60, -0.35}, Material::ground);
    scene_.placeOnce(std::move(lawn));
    std::vector<std::uint32_t> trees;
    for (std::uint64_t i = 0; i < 3; ++i)
        trees.push_back(scene_.addMesh(makeBroadleaf(random_.child(50 + i))));
    for (double x = -6; x < buildingX + 12; x += 9)
        for (double y : {-9.0, buildingY + 9.0})
            scene_.place({anyOf(trees),
                          {x + random_.uniform(-2, 2), y + random_.uniform(-2, 2), -0.35},
                          random_.uniform(0, 6),
                          random_.uniform(0.7, 1.1),
                          {Rgb{0.26f, 0.43f, 0.15f}}});
}

} // namespace

std::unique_ptr<const Scene> makeIndoor(std::uint64_t seed) {
    return IndoorBuilder(seed).build();
}

} // namespace stipple::synth
