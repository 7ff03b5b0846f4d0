#include "sphvv/solver/boundaries/repulsion.hpp"

#include <algorithm>
#include <cmath>

namespace sphvv::solver {
namespace {

/// (1/x)^12 - (1/x)^6
constexpr double twelve_six(double x) {
    const double sixth = 1 / (x * x * x * x * x * x);
    return sixth * sixth - sixth;
}

constexpr double slope_of_twelve_six(double x) {
    const double sixth = 1 / (x * x * x * x * x * x);
    return (6 * sixth - 12 * sixth * sixth) / x;
}

/// In units of D/r0 and r0.
constexpr RepulsionTail lennard_jones_tail = RepulsionTail::after(
    twelve_six(lennard_jones_cut), slope_of_twelve_six(lennard_jones_cut), 1 - lennard_jones_cut);

/// How far from a particle the points lie that push it. Of the normal form, distance and every tangent count
/// by themselves.
template <int Dim>
double search_radius(const RepulsiveLaw& law) {
    return law.form == RepulsiveForm::normal ? std::sqrt(Dim) * law.range : law.range;
}

} // namespace

double power_law_repulsion(double r, double strength, double range) {
    if (r >= range) {
        return 0;
    }
    const double square = (range / r) * (range / r);
    return strength * (square * square - square) / r;
}

double lennard_jones_repulsion(double r, double strength, double range) {
    const double x = r / range;
    if (x >= 1) {
        return 0;
    }
    const double s = 1 - x;
    return strength / range *
           (x < lennard_jones_cut ? twelve_six(x)
                                  : (lennard_jones_tail.square * s + lennard_jones_tail.linear) * s);
}

template <int Dim>
Repulsion<Dim>::Repulsion(const RepulsiveLaw& law, std::span<const WallParticle<Dim>> points,
                          const Box<Dim>& box)
    : law_(law), share_(1 / std::pow(law.points_per_dx, Dim - 1)), box_(box) {
    std::vector<std::vector<Vector<Dim>>> of_walls;
    for (const WallParticle<Dim>& point : points) {
        of_walls.resize(std::max<std::size_t>(of_walls.size(), point.wall + 1));
        of_walls[point.wall].push_back(wrapped(point.position));
    }
    rows_.reserve(of_walls.size());
    for (const auto& of_one : of_walls) {
        rows_.push_back(row_of(of_one));
    }
}

template <int Dim>
typename Repulsion<Dim>::Row Repulsion<Dim>::row_of(const std::vector<Vector<Dim>>& points) const {
    Row row;
    if (points.empty()) {
        return row;
    }
    const double radius = search_radius<Dim>(law_);
    Box<Dim> around = box_; // and no more of it than the points reach
    std::array<std::vector<double>, Dim> position;
    std::array<const double*, Dim> arrays;
    for (int d = 0; d < Dim; ++d) {
        position[d].reserve(points.size());
        for (const Vector<Dim>& point : points) {
            position[d].push_back(point[d]);
        }
        arrays[d] = position[d].data();
        if (!box_.periodic[d]) {
            const auto [low, high] = std::minmax_element(position[d].begin(), position[d].end());
            around.low[d] = *low - radius;
            around.high[d] = *high + radius;
        }
    }
    row.grid.bin(around, radius, arrays, static_cast<int>(points.size()));
    row.points.reserve(points.size());
    for (const int k : row.grid.order()) {
        row.points.push_back(points[k]);
    }
    return row;
}

template <int Dim>
Vector<Dim> Repulsion<Dim>::wrapped(Vector<Dim> x) const {
    for (int d = 0; d < Dim; ++d) {
        if (box_.periodic[d]) {
            x[d] -= box_.length(d) * std::floor((x[d] - box_.low[d]) / box_.length(d));
        }
    }
    return x;
}

template <int Dim>
Vector<Dim> Repulsion<Dim>::along_normal(const Vector<Dim>& separation, const Vector<Dim>& normal) const {
    const double away = normal.dot(separation);
    const Vector<Dim> along = separation - away * normal;
    double share = 1;
    if constexpr (Dim == 2) {
        share = std::max(0., 1 - along.norm() / law_.range);
    } else {
        for (int d = 0; d < Dim; ++d) { // one of them is the normal, along which there is nothing
            share *= std::max(0., 1 - std::abs(along[d]) / law_.range);
        }
    }
    return share > 0 ? Vector<Dim>(share * power_law_repulsion(away, law_.strength, law_.range) * normal)
                     : Vector<Dim>(Vector<Dim>::Zero());
}

template <int Dim>
Vector<Dim> Repulsion<Dim>::of_wall(const Row& row, const Wall<Dim>& wall, const Vector<Dim>& x,
                                    Stretches& stretches) const {
    const Vector<Dim> at = wrapped(x);
    const Vector<Dim> normal = wall.normal(at);
    std::array<double, Dim> place;
    std::copy_n(at.data(), Dim, place.begin());
    row.grid.stretches_around(row.grid.cell_at(place), stretches);
    const auto sum_of = [&](const auto& push) {
        Vector<Dim> total = Vector<Dim>::Zero();
        for (const auto& stretch : stretches) {
            const Vector<Dim> from = at - Eigen::Map<const Vector<Dim>>(stretch.shift.data());
            for (int k = stretch.begin; k < stretch.end; ++k) {
                total += push(Vector<Dim>(from - row.points[k]));
            }
        }
        return Vector<Dim>(share_ * total);
    };
    const auto sum_along_pairs = [&](const auto& force) {
        return sum_of([&](const Vector<Dim>& separation) -> Vector<Dim> {
            const double r = separation.norm();
            return force(r, law_.strength, law_.range) / r * separation;
        });
    };
    switch (law_.form) {
    case RepulsiveForm::normal:
        return sum_of([&](const Vector<Dim>& separation) { return along_normal(separation, normal); });
    case RepulsiveForm::lennard_jones:
        return sum_along_pairs(lennard_jones_repulsion);
    case RepulsiveForm::radial:
        break;
    }
    return sum_along_pairs(power_law_repulsion);
}

template <int Dim>
Vector<Dim> Repulsion<Dim>::of_walls(std::span<const Wall<Dim>> walls, const Vector<Dim>& x, double t,
                                     Stretches& stretches) const {
    Vector<Dim> total = Vector<Dim>::Zero();
    for (std::size_t w = 0; w < rows_.size(); ++w) {
        const Vector<Dim> at = walls[w].at_start(x, t);
        if (!rows_[w].points.empty() && walls[w].distance(at) < law_.range) {
            total += of_wall(rows_[w], walls[w], at, stretches);
        }
    }
    return total;
}

template <int Dim>
Vector<Dim> Repulsion<Dim>::acceleration(std::span<const Wall<Dim>> walls, const Vector<Dim>& x,
                                         double t) const {
    Stretches stretches;
    return of_walls(walls, x, t, stretches);
}

template <int Dim>
void Repulsion<Dim>::add_to(Field& acceleration, std::span<const Wall<Dim>> walls,
                            const Particles<Dim>& particles, double t) const {
    const int count = static_cast<int>(particles.fluid_size());
#pragma omp parallel
    {
        Stretches stretches;
#pragma omp for schedule(static)
        for (int i = 0; i < count; ++i) {
            Vector<Dim> x;
            for (int d = 0; d < Dim; ++d) {
                x[d] = particles.position[d][i];
            }
            const Vector<Dim> push = of_walls(walls, x, t, stretches);
            for (int d = 0; d < Dim; ++d) {
                acceleration[d][i] += push[d];
            }
        }
    }
}

template class Repulsion<2>;
template class Repulsion<3>;

} // namespace sphvv::solver
