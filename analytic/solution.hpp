#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sphvv::analytic {

/// A point or a vector; two-dimensional solutions leave the third component zero.
using Vector = std::array<double, 3>;

/// A named number that a solution depends on, with the closed interval in which it makes sense.
struct Parameter {
    std::string_view name;
    std::string_view unit; ///< SI unit, or "1" for a pure number
    std::string_view summary;
    double value; ///< used where the caller names none
    double low;
    double high;
};

/// Parameter values by name.
using Values = std::map<std::string, double, std::less<>>;

/// The region in which a solution holds: a box, each direction periodic or not.
struct Domain {
    Vector low{};
    Vector high{};
    std::array<bool, 3> periodic{};
};

/// The equations that the fields of a solution satisfy.
enum class Equations {
    navier_stokes,     ///< ∂u/∂t + (u·∇)u = −∇p/ρ + ν∇²u + g, ∇·u = 0
    reynolds_averaged, ///< the same for mean fields with ∇·[(ν + ν_T)(∇u + ∇uᵀ)], ν_T the quantity
                       ///< eddy_viscosity
    hydrostatic, ///< rest: u = 0, ∇p = ρg with the density of the state and the body force g of the time
    impulsive, ///< u = ∇φ, ∇²φ = 0 just after an impulse: quantities potential φ and impulse ∫p dt = −ρφ
};

std::string_view to_string(Equations equations);

/// What holds on a part of the boundary; n is its normal into the fluid, u_w its velocity.
enum class BoundaryKind {
    no_slip,      ///< u = u_w
    impermeable,  ///< u·n = u_w·n
    free_surface, ///< p = 0 and no shear stress; in an impulsive flow ∫p dt = 0
};

/// A side of the domain's box.
struct Face {
    int direction;
    bool high; ///< at domain.high[direction], else at domain.low[direction]
};

/// A part of the boundary: a side of the domain's box, or a curve or surface within the box.
struct Boundary {
    std::string_view name;
    BoundaryKind kind;
    /// Signed distance (m), positive in the fluid; its gradient is the normal into the fluid.
    std::function<double(const Vector& x)> distance;
    /// Velocity of the boundary (m/s) at a point of it and a time t > 0, after any impulse at t = 0.
    std::function<Vector(const Vector& x, double t)> velocity;
    std::optional<Face> face{}; ///< none where it is no side of the box
};

/// The side of a domain's box as a boundary that moves with a constant velocity (m/s) in its own plane, or
/// that has just been set going along its normal.
Boundary flat_boundary(std::string_view name, BoundaryKind kind, const Domain& domain, Face face,
                       const Vector& velocity = {});

/// What a solution says at one point and instant.
struct State {
    Vector velocity{};   ///< m/s
    double pressure = 0; ///< Pa; not a number in an impulsive flow, of which only ∫p dt is known
    std::optional<double> density{}; ///< kg/m3; none where it is the medium's everywhere
};

/// Exact solution with its parameters bound: the state at a point (m) and a time (s).
using Evaluator = std::function<State(const Vector& x, double t)>;

/// A quantity with its parameters bound, at a point (m) and a time (s).
using Scalar = std::function<double(const Vector& x, double t)>;

/// A further number or field that a solution gives in closed form. It reads no more of point and time than
/// its summary says.
struct Quantity {
    std::string_view name;
    std::string_view unit; ///< SI unit, or "1" for a pure number
    std::string_view summary;
    Scalar (*bind)(const Values&);
};

/// The constants of the medium and the scales that a bound solution implies.
struct Medium {
    double density;             ///< kg/m3; of a compressible medium, where p = 0
    double kinematic_viscosity; ///< m2/s, that of the equations
    double maximum_speed;       ///< m/s, over the domain and all t >= 0; infinite where a corner is singular
    Vector body_force{};        ///< m/s2, uniform; where it changes with time, at t = 0
};

/// Declaration of an exact solution. One file in analytic/solutions/ defines one, and nothing else has to be
/// edited. What has a default may be left out.
struct Solution {
    std::string_view name;
    std::string_view summary;
    std::string_view formula;
    std::string_view source;
    int dimension;
    std::vector<Parameter> parameters;
    Domain (*domain)(const Values&);
    Medium (*medium)(const Values&);
    Evaluator (*bind)(const Values&);
    /// Volume mean of |u|^2/2 (m2/s2) over the fluid at time t, exact; none where there is no motion.
    double (*kinetic_energy)(const Values&, double t) = nullptr;
    Equations equations = Equations::navier_stokes;
    /// The boundaries of the fluid; none where every direction is periodic.
    std::vector<Boundary> (*boundaries)(const Values&) = nullptr;
    std::vector<Quantity> quantities{};
    /// Body force (m/s2) at a time; none where it is the medium's at all times.
    Vector (*body_force)(const Values&, double t) = nullptr;
};

/// All parameters of a solution: the given values, and the declared ones for the rest.
/// Throws std::invalid_argument naming the key, its accepted interval, or the accepted keys.
Values resolve(const Solution& solution, const Values& given);

/// The boundaries of a solution with its parameters bound, none where it declares none.
std::vector<Boundary> boundaries(const Solution& solution, const Values& values);

/// Whether a solution declares a quantity of that name.
bool has_quantity(const Solution& solution, std::string_view name);

/// A quantity by its name, bound. Throws std::invalid_argument naming the accepted ones.
Scalar quantity(const Solution& solution, std::string_view name, const Values& values);

/// The body force (m/s2) of a solution at a time (s): its own where it changes, else the medium's.
Vector body_force(const Solution& solution, const Values& values, double t);

/// The density of a state: its own where it has one, else the medium's.
double density(const State& state, const Medium& medium);

} // namespace sphvv::analytic
