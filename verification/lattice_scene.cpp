#include "sphvv/verification/lattice_scene.hpp"

#include "sphvv/solver/arrangements.hpp"
#include "sphvv/solver/schemes.hpp"
#include "sphvv/verification/scene.hpp"

#include <algorithm>

namespace sphvv::verification {

solver::Settings settings_of(const LatticeScene& scene) {
    const Variant variant = variant_of(scene.scheme);
    solver::Assignments given = variant.settings;
    given.insert_or_assign("time_step", "1");
    if (variant.scheme->compressible) {
        given.insert_or_assign("c0_over_u", solver::shortest(scene.sound_speed)); // U = 1 m/s
        if (scene.pressure) {
            given.insert_or_assign("gamma", "1"); // the sound speed is that of every density
            given.insert_or_assign("background_pressure", "0");
        }
    } else {
        given.insert_or_assign("pressure_tolerance", "1e-10");
    }
    return {variant.scheme->keys, given};
}

double smoothing_length(const LatticeScene& scene) {
    return settings_of(scene).number("h_over_dx") * scene.dx();
}

solver::Simulation<2> lattice_simulation(const LatticeScene& scene, double dt) {
    solver::Box<2> box;
    box.low.fill(0);
    box.high.fill(scene.n);
    box.periodic.fill(true);
    const double speed_unit = scene.dx() / dt; // m/s
    const double pressure = scene.pressure.value_or(0);
    solver::Simulation<2> s(box, static_cast<std::size_t>(scene.n) * scene.n);
    s.settings = settings_of(scene);
    s.kernel = &solver::kernels::find(s.settings.word("kernel"));
    s.particle_spacing = 1;
    s.smoothing_length = s.settings.number("h_over_dx");
    s.density = 1;
    s.kinematic_viscosity = scene.viscosity / (scene.dx() * speed_unit);
    s.reference_speed = 1 / speed_unit;
    s.body_force = {0, -scene.body_force * dt / speed_unit};
    s.particle_mass = 1 + pressure / (scene.sound_speed * scene.sound_speed); // as gamma is 1
    s.end_time = 1e12;
    solver::Field& p = s.particles.field("pressure", 1, solver::Lifetime::state, "scene");
    std::ranges::fill(p.components[0], pressure / (speed_unit * speed_unit));
    const auto points = solver::lattice<2>(box, 1);
    const std::array<double, 2> direction{0.8, 0.6};
    for (int d = 0; d < 2; ++d) {
        s.particles.position.components[d] = points[d];
        std::ranges::fill(s.particles.velocity.components[d], direction[d] * scene.speed / speed_unit);
    }
    variant_of(scene.scheme).scheme->assemble(s);
    return s;
}

} // namespace sphvv::verification
