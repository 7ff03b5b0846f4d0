#pragma once

#include "sphvv/solver/linear/pressure_poisson.hpp"
#include "sphvv/solver/operators/row.hpp"
#include "sphvv/solver/schemes.hpp"

#include <memory>
#include <optional>

/// What pressure-projection schemes are made of. A scheme's stages are these acts in the order that its
/// publication gives; two schemes that share a whole list of stages share a file of this folder.
namespace sphvv::solver::projection {

/// What a scheme takes unless it is told otherwise.
struct Defaults {
    std::string_view kernel = "quintic_spline";
    double h_over_dx = 1.3;
    std::string_view gradient = "normalised";
    double advective_limit = 0.2;
    double viscous_limit = 0.2;
};

/// The keys of a pressure-projection scheme.
std::vector<Key> keys(const Defaults& defaults = {});

/// Size of the round-off in a sum over neighbours, against the size of its terms: machine accuracy times the
/// hundreds of spacings in a box, because the distance of two particles is a difference of their coordinates.
constexpr double sum_round_off = 1e-12;

enum class Gradient { normalised, plain, symmetric };
enum class Viscosity { morris, schwaiger, monaghan_cleary };

/// Fields and choices that the stages of one step share.
template <int Dim>
struct Projection {
    Field& pressure;        ///< Pa
    Field& velocity_next;   ///< u* (m/s), while velocity still holds the one before
    Field* renormalisation; ///< L_i, row by row; none where nothing needs it, or the density is summed
    Field* density;         ///< summation density (kg/m^dim); where there is none, it is rho_0
    Gradient gradient;
    Viscosity viscosity;
    bool schwaiger; ///< LS of the pressure, else LM
    double eta_squared;
    UniformVolume volume; ///< m/rho_0
    PressurePoisson<Dim> poisson;
    std::optional<PressurePoisson<Dim>> implicit_viscosity; ///< (1 - dt nu Laplacian) u* = u + dt f
};

template <int Dim>
using SharedProjection = std::shared_ptr<Projection<Dim>>;

/// The density in div(grad p/rho): rho_0, or summed over the neighbours.
enum class Density { constant, summed };

/// The fields and choices that the settings ask for. A scheme of constant density has one list of neighbours
/// in a step: viscosity forms L_i, and the Poisson equation and the projection read it. A scheme of summed
/// density moves its particles in between, so that an L_i would be read once or twice only: each sweep forms
/// its own.
template <int Dim>
SharedProjection<Dim> make_projection(Simulation<Dim>& simulation, Density density);

/// nu_d = u_max dx/Pe_max (m2/s) of the particles near a free surface; 0 where the scene does not damp.
/// Source: Xu 2009 §6.3.
template <int Dim>
double damping_viscosity(const Simulation<Dim>& simulation);

/// dt = min(advective_limit h/u_max, viscous_limit h^2/nu), of an implicit viscous step
/// implicit_viscous_limit h^2/nu, and, for a scheme that has the key, force_limit
/// sqrt(h/|a|) with the largest acceleration of the last step. Source: Xu 2009 §3.4; Lee 2008 §1.3.
template <int Dim>
void choose_time_step(Simulation<Dim>& simulation);

/// r += dt u.
template <int Dim>
void drift(Simulation<Dim>& simulation);

/// u* = u + dt (nu Laplacian u + f), f the body force, on the current neighbours, at the density rho_0;
/// writes L_i where it is kept. An inviscid fluid has no sweep over neighbours here: u* = u + dt f, and L_i
/// is left to form_renormalisation().
///
/// An implicit viscous step is backward Euler, u* - dt nu Laplacian u* = u + dt f, one linear problem for
/// each component, started from u; it throws Diverged where the solver stops short of its tolerance. At a
/// wall without slip u* is the velocity of the wall, but for what the pressure of the wall takes off again,
/// n.(f - a) `forced` along the normal: f has acted for the time `forced` on u*. Where f or a pressure
/// gradient along such a wall balance, the slip that they leave is O(dt), as of every projection that does
/// not carry the old pressure (Guermond, Minev & Shen 2006 §3.1).
template <int Dim>
void form_forced_velocity(Simulation<Dim>& simulation, Projection<Dim>& projection, double dt, double forced);

/// What the stage of form_forced_velocity() is called: "viscosity", or "body_force" of an inviscid fluid.
template <int Dim>
std::string forces_name(const Simulation<Dim>& simulation);

/// L_i with V = m/rho_0 on the current neighbours.
template <int Dim>
void form_renormalisation(Simulation<Dim>& simulation, Projection<Dim>& projection);

/// Adds the stage of form_forced_velocity(), before it for an inviscid fluid that of L_i where it is kept.
template <int Dim>
void add_forces_stages(Simulation<Dim>& simulation, const SharedProjection<Dim>& projection);

/// rho_i = m sum_j W_ij, i included, on the current neighbours. Source: Shao & Lo 2003; Hu & Adams 2007 (m
/// sigma_i); Asai 2012.
template <int Dim>
void sum_density(Simulation<Dim>& simulation, Field& density);

/// Writes the equations div(grad p/rho) = div u*/dt, for a constant density Laplacian p = (rho_0/dt) div u*.
template <int Dim>
void write_divergence_equations(Simulation<Dim>& simulation, Projection<Dim>& projection);

/// The density (kg/m^dim) that a source rho_0 - rho is to take the summation density to: rho_0 under a free
/// surface. Without one it is the mean of the summation density: a constant is out of reach of the Poisson
/// equation, and its solver projects it out. On a lattice it is nearly all there is; taken off before, it
/// leaves no round-off of its own size.
template <int Dim>
double target_density(const Simulation<Dim>& simulation, const Field& density);

/// Writes the equations div(grad p/rho) = (rho_0 - rho)/(rho_0 tau^2) with the summation density rho: the
/// motion -tau^2 grad p/rho takes the particles to the density rho_0.
template <int Dim>
void write_density_equations(Simulation<Dim>& simulation, Projection<Dim>& projection, double tau_squared);

/// Pressures and viscous forces are antisymmetric with the symmetric gradient and any viscosity but
/// Schwaiger's; they lie along the line of the pair with Monaghan-Cleary's. Energy: a projection takes some.
Conserves conserves(const Settings& settings);

/// Order in time of u^{n+1} = u^n + dt (...)(r* = r^n + dt u^n): one.
TimeOrder euler_order(const Settings& settings);

/// Equation i becomes p_i + depth n.grad p = 0 with the normalised gradient, normal and depth those that the
/// free surface has for particle i: a pressure that is linear next to the surface vanishes on it. Where no
/// normal or gradient can be told, p_i = 0.
template <int Dim>
void set_zero_on_surface(Simulation<Dim>& simulation, PressurePoisson<Dim>& poisson, int i);

/// Solves the problem whose weights and sources are written, with the pressure 0 at a free surface, from the
/// pressure as first guess; books the iterations and the matrix entries. Throws Diverged where the solver
/// stops short of its tolerance.
template <int Dim>
void solve_poisson(Simulation<Dim>& simulation, PressurePoisson<Dim>& poisson, Field& pressure);

/// target -= scale grad p/rho: of the velocity with scale = dt, of the position with tau^2.
template <int Dim>
void subtract_pressure_gradient(Simulation<Dim>& simulation, const Projection<Dim>& projection,
                                Field& pressure, double scale, Field& target);

} // namespace sphvv::solver::projection
