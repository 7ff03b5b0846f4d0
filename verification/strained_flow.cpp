#include "sphvv/verification/strained_flow.hpp"

#include "sphvv/verification/lattice_scene.hpp"

#include <cmath>
#include <numbers>

namespace sphvv::verification {
using std::numbers::pi;

double fold_step(const StrainedFlow& flow) {
    return 1 / (2 * flow.n * std::sin(pi / flow.n));
}

bool keeps_arrangement(const StrainedFlow& flow, double dt) {
    const LatticeScene scene{.scheme = flow.scheme, .n = flow.n};
    solver::Simulation<2> s = lattice_simulation(scene, dt);
    const double U = dt / scene.dx(); // in units of dx and dt
    for (std::size_t k = 0; k < s.particles.size(); ++k) {
        const double X = 2 * pi * s.particles.position[0][k] / flow.n;
        const double Y = 2 * pi * s.particles.position[1][k] / flow.n;
        s.particles.velocity[0][k] = -U * std::cos(X) * std::sin(Y);
        s.particles.velocity[1][k] = U * std::sin(X) * std::cos(Y);
    }
    s.survival.kinetic_energy = 1.1 * kinetic_energy(s);
    s.survival.kinetic_energy_reason = "1.1 of the start";
    s.survival.minimum_spacing = least_spacing;
    s.survival.minimum_spacing_reason = "of the lattice";
    try {
        const double duration = 1 / (2 * pi);
        for (double t = 0; t < duration + dt * (1 - 1e-9); t += dt) {
            advance(s);
        }
    } catch (const solver::Diverged&) {
        return false;
    }
    return true;
}

} // namespace sphvv::verification
