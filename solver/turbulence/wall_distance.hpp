#pragma once

#include "sphvv/solver/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sphvv::solver {

/// The nearest of the walls without slip to a point: an index, and the distance from the wall, m. The
/// distance is never less than `edge`, the height over the wall at which the fluid begins and which the
/// surface of the wall stands for. Without such a wall: -1, infinite.
struct NearestWall {
    int index = -1;
    double distance = std::numeric_limits<double>::infinity();
};

template <int Dim>
NearestWall nearest_wall(const std::vector<Wall<Dim>>& walls, const Vector<Dim>& x, double edge) {
    NearestWall nearest;
    for (std::size_t w = 0; w < walls.size(); ++w) {
        if (walls[w].slip == Slip::no_slip) {
            const double distance = std::max(0., walls[w].distance(x)) + edge;
            if (distance < nearest.distance) {
                nearest = {static_cast<int>(w), distance};
            }
        }
    }
    return nearest;
}

/// The height of the edge in a scene, m.
template <int Dim>
double edge_height(const Simulation<Dim>& s) {
    return s.wall_friction ? s.wall_friction->edge() : 0;
}

template <int Dim>
Vector<Dim> vector_at(const Field& field, int i) {
    Vector<Dim> v;
    for (int d = 0; d < Dim; ++d) {
        v[d] = field[d][i];
    }
    return v;
}

/// Adds the stage that writes the scratch field `wall_distance`, z (m), and with `logarithm` also
/// `log_wall_distance`, ln(z/1 m); images have those of their particle, as what lies behind a wall carries
/// the values at the edge.
template <int Dim>
void add_wall_distance_stage(Simulation<Dim>& s, bool logarithm) {
    Field& z = s.particles.field("wall_distance", 1, Lifetime::scratch, "wall_distance");
    Field* ln_z = logarithm
                      ? &s.particles.field("log_wall_distance", 1, Lifetime::scratch, "velocity_gradient")
                      : nullptr;
    s.add_stage("wall_distance", [&z, ln_z](Simulation<Dim>& sim) {
        const double edge = edge_height(sim);
        const int count = static_cast<int>(sim.particles.size());
#pragma omp parallel for schedule(static)
        for (int i = 0; i < count; ++i) {
            z[0][i] = nearest_wall(sim.walls, vector_at<Dim>(sim.particles.position, i), edge).distance;
        }
        sim.fill_walls(z, Parity::even);
        if (ln_z != nullptr) {
            std::transform(z.components[0].begin(), z.components[0].end(), ln_z->components[0].begin(),
                           [](double distance) { return std::log(distance); });
        }
    });
}

} // namespace sphvv::solver
