#pragma once

namespace sphvv::solver {

template <int Dim>
struct Simulation;

/// Control of a body force by the mean velocity that it is to uphold.
struct FlowDriver {
    int direction = 0;         ///< of the force and of the velocity
    double bulk_velocity = 0;  ///< m/s, the mean of u over the fluid particles that is wanted
    double previous_error = 0; ///< m/s, that of the step before: state of a run
    bool started = false;      ///< whether there was a step before
};

/// Adds the stage that sets the driver's component of the body force: with e = Q - Q_ref, Q the mean velocity
/// (m/s) at the start of the step,
///
///   F^{n+1} = F^n - (2 e_n - e_{n-1})/(2 dt),
///
/// in place of Q from an inlet slab that of the whole fluid, whose noise is least. A step of a scheme with
/// two levels changes the mean velocity by dt (F - D), D the drag of the walls (m/s2). So e_{n+1} - 2 e_n +
/// e_{n-1} = dt (F^{n+1} - F^n) - dt (D^{n+1} - D^n), and for a drag that does not change
///
///   e_{n+1} = e_n - e_{n-1}/2,
///
/// with the roots (1 ± i)/2 of lambda^2 - lambda + 1/2: |lambda| = 0.707 whatever dt. A leap over two steps
/// would make it e_{n+1} = -e_n + 2 e_{n-1} - e_{n-2}, with a root at -2.15: unstable. In the first step
/// e_{n-1} = e_n, as after a rest. Source: Issa 2005 §7 (FD). To be put after the stage that chooses the time
/// step; does nothing in a scene without driver.
template <int Dim>
void add_flow_driver_stage(Simulation<Dim>& simulation);

/// Mean velocity of the fluid particles in a direction, m/s.
template <int Dim>
double mean_velocity(const Simulation<Dim>& simulation, int direction);

} // namespace sphvv::solver
