#include "sphvv/solver/flow_driver.hpp"

#include "sphvv/solver/simulation.hpp"

namespace sphvv::solver {

template <int Dim>
double mean_velocity(const Simulation<Dim>& s, int direction) {
    const double* u = s.particles.velocity[direction];
    const int count = static_cast<int>(s.particles.fluid_size());
    return deterministic_sum(count, [u](int i) { return u[i]; }) / count;
}

template <int Dim>
void add_flow_driver_stage(Simulation<Dim>& s) {
    if (!s.flow_driver) {
        return;
    }
    s.add_stage("flow_driver", [](Simulation<Dim>& sim) {
        FlowDriver& driver = *sim.flow_driver;
        const double error = mean_velocity(sim, driver.direction) - driver.bulk_velocity;
        const double before = driver.started ? driver.previous_error : error;
        sim.body_force[driver.direction] -= (2 * error - before) / (2 * sim.time_step);
        driver.previous_error = error;
        driver.started = true;
    });
}

template void add_flow_driver_stage(Simulation<2>&);
template void add_flow_driver_stage(Simulation<3>&);
template double mean_velocity(const Simulation<2>&, int);
template double mean_velocity(const Simulation<3>&, int);

} // namespace sphvv::solver
