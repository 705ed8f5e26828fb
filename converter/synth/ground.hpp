// The ground: a plan in its own coordinates (u, v), cut into square cells, bent into place and
// triangulated. The triangles are the exact surface; the plan also says what lies where.
#pragma once

#include "converter/synth/model.hpp"

#include <memory>

namespace stipple::synth {

struct GroundLook {
    Rgb colour;
    float reflectance = 0.4f;
    std::uint8_t classification = classes::ground;
};

// What a landscape is, as functions of plan coordinates, 0..side each.
class GroundPlan {
  public:
    virtual ~GroundPlan() = default;
    // Where plan position (u, v) lies in the scene.
    virtual Vec2d place(double u, double v) const = 0;
    virtual double height(double u, double v) const = 0;
    // How far the cell around (u, v) is raised above height(): pavements. Constant within a cell.
    virtual double raise(double u, double v) const = 0;
    virtual GroundLook look(double u, double v) const = 0;
};

class Ground {
  public:
    // `side` is a multiple of `cell`; both metres.
    Ground(std::unique_ptr<const GroundPlan> plan, double side, double cell);

    // The surface: two triangles a cell, tagged by cell, and kerbs between cells of different raise.
    Model model() const;

    const GroundPlan& plan() const { return *plan_; }
    // Scene position of a plan position, on the surface (its triangles, not the plan's function).
    Vec3d at(double u, double v) const;
    // Direction of growing u in the scene at (u, v), as an angle.
    double yawAt(double u, double v) const;
    // Plan position of scene position (x, y) in the triangle with this tag.
    Vec2d uvAt(std::uint32_t tag, double x, double y) const;

  private:
    struct Cell {
        Vec3d corners[4]; // (u, v), (u+1, v), (u+1, v+1), (u, v+1), raised
    };
    Cell cell(std::size_t i, std::size_t j) const;
    const Vec3f& vertex(std::size_t i, std::size_t j) const { return vertices_[j * (count_ + 1) + i]; }

    std::unique_ptr<const GroundPlan> plan_;
    double cellSize_;
    std::size_t count_; // cells a side
    std::vector<Vec3f> vertices_;
    std::vector<float> raise_;
};

// Tag of a kerb: no cell.
inline constexpr std::uint32_t kerbTag = 0xffffffff;

} // namespace stipple::synth
