#include "converter/synth/ground.hpp"

#include <algorithm>
#include <cmath>

namespace stipple::synth {

Ground::Ground(std::unique_ptr<const GroundPlan> plan, double side, double cell)
    : plan_(std::move(plan)), cellSize_(cell), count_(static_cast<std::size_t>(std::lround(side / cell))) {
    vertices_.reserve((count_ + 1) * (count_ + 1));
    for (std::size_t j = 0; j <= count_; ++j)
        for (std::size_t i = 0; i <= count_; ++i) {
            double u = static_cast<double>(i) * cell, v = static_cast<double>(j) * cell;
            Vec2d p = plan_->place(u, v);
            vertices_.push_back(toFloat({p.x, p.y, plan_->height(u, v)}));
        }
    raise_.reserve(count_ * count_);
    for (std::size_t j = 0; j < count_; ++j)
        for (std::size_t i = 0; i < count_; ++i)
            raise_.push_back(static_cast<float>(
                plan_->raise((static_cast<double>(i) + 0.5) * cell, (static_cast<double>(j) + 0.5) * cell)));
}

Ground::Cell Ground::cell(std::size_t i, std::size_t j) const {
    Cell cell{{toDouble(vertex(i, j)), toDouble(vertex(i + 1, j)), toDouble(vertex(i + 1, j + 1)),
               toDouble(vertex(i, j + 1))}};
    for (Vec3d& corner : cell.corners)
        corner.z += static_cast<double>(raise_[j * count_ + i]);
    return cell;
}

Model Ground::model() const {
    Model model;
    model.primitives.reserve(count_ * count_ * 2);
    // Between two cells of different raise: the wall over the corners p and q that they share.
    auto kerb = [&](const Cell& a, const Cell& b, int ap, int aq, int bp, int bq) {
        if (a.corners[ap].z != b.corners[bp].z)
            model.quad(a.corners[ap], a.corners[aq], b.corners[bq], b.corners[bp], Material::kerb, kerbTag);
    };
    for (std::size_t j = 0; j < count_; ++j)
        for (std::size_t i = 0; i < count_; ++i) {
            Cell here = cell(i, j);
            const Vec3d* c = here.corners;
            auto tag = static_cast<std::uint32_t>((j * count_ + i) * 2);
            model.triangle(c[0], c[1], c[2], Material::ground, tag);
            model.triangle(c[0], c[2], c[3], Material::ground, tag + 1);
            if (i + 1 < count_)
                kerb(here, cell(i + 1, j), 1, 2, 0, 3);
            if (j + 1 < count_)
                kerb(here, cell(i, j + 1), 3, 2, 0, 1);
        }
    return model;
}

Vec3d Ground::at(double u, double v) const {
    auto index = [&](double x) {
        return static_cast<std::size_t>(
            std::clamp(std::floor(x / cellSize_), 0.0, static_cast<double>(count_ - 1)));
    };
    std::size_t i = index(u), j = index(v);
    double s = u / cellSize_ - static_cast<double>(i), t = v / cellSize_ - static_cast<double>(j);
    Cell here = cell(i, j);
    const Vec3d* c = here.corners;
    if (s >= t)
        return c[0] + (c[1] - c[0]) * s + (c[2] - c[1]) * t;
    return c[0] + (c[2] - c[3]) * s + (c[3] - c[0]) * t;
}

double Ground::yawAt(double u, double v) const {
    Vec2d d = plan_->place(u + 1, v) - plan_->place(u - 1, v);
    return std::atan2(d.y, d.x);
}

Vec2d Ground::uvAt(std::uint32_t tag, double x, double y) const {
    std::size_t index = tag / 2, i = index % count_, j = index / count_;
    Cell here = cell(i, j);
    const Vec3d* c = here.corners;
    bool upper = tag % 2 == 1;
    Vec3d eu = upper ? c[2] - c[3] : c[1] - c[0], ev = upper ? c[3] - c[0] : c[2] - c[1];
    double dx = x - c[0].x, dy = y - c[0].y;
    double det = eu.x * ev.y - eu.y * ev.x;
    double s = (dx * ev.y - dy * ev.x) / det, t = (eu.x * dy - eu.y * dx) / det;
    return {(static_cast<double>(i) + s) * cellSize_, (static_cast<double>(j) + t) * cellSize_};
}

} // namespace stipple::synth
