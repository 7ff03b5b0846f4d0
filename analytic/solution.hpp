#pragma once

#include <array>
#include <functional>
#include <map>
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

/// What a solution says at one point and instant.
struct State {
    Vector velocity{};   ///< m/s
    double pressure = 0; ///< Pa
};

/// Exact solution with its parameters bound: the state at a point (m) and a time (s).
using Evaluator = std::function<State(const Vector& x, double t)>;

/// The constants of the medium and the scales that a bound solution implies.
struct Medium {
    double density;             ///< kg/m3
    double kinematic_viscosity; ///< m2/s
    double maximum_speed;       ///< m/s, over the domain and all t >= 0
};

/// Declaration of an exact solution of the incompressible Navier–Stokes equations. One file in
/// analytic/solutions/ defines one, and nothing else has to be edited.
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
    /// Volume mean of |u|^2/2 (m2/s2) at time t, exact.
    double (*kinetic_energy)(const Values&, double t);
};

/// All parameters of a solution: the given values, and the declared ones for the rest.
/// Throws std::invalid_argument naming the key, its accepted interval, or the accepted keys.
Values resolve(const Solution& solution, const Values& given);

} // namespace sphvv::analytic
