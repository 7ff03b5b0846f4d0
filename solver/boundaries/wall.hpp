#pragma once

#include "sphvv/solver/operators/row.hpp"

#include <functional>
#include <string>

namespace sphvv::solver {

/// What a wall does to the velocity along it.
enum class Slip {
    no_slip,  ///< the fluid at the wall moves with it
    free_slip ///< only the velocity normal to the wall is the wall's: a smooth wall, or a plane of symmetry
};

/// When walls are looked at: where they are, and which step their velocity is the end of.
struct WallTimes {
    double place; ///< s
    double begin; ///< s, of the step
    double end;   ///< s
};

/// A wall as the zero of a signed distance. A shape is a function that returns one of these, in a file of
/// solver/boundaries/shapes/.
template <int Dim>
struct Wall {
    std::string name;
    Slip slip = Slip::no_slip;
    /// m, positive in the fluid, with |grad distance| = 1 within a kernel support of the wall.
    std::function<double(const Vector<Dim>& x)> distance;
    /// grad distance: unit vector, into the fluid.
    std::function<Vector<Dim>(const Vector<Dim>& x)> normal;
    /// Of the wall's material at its point x, m/s.
    std::function<Vector<Dim>(const Vector<Dim>& x, double t)> velocity;
    /// By how much the whole shape has moved since t = 0, m; none: it stays, and moves along itself at most.
    std::function<Vector<Dim>(double t)> displacement{};

    /// Where the shape was at t = 0, seen from a point x at the time t.
    Vector<Dim> at_start(const Vector<Dim>& x, double t) const {
        return displacement ? Vector<Dim>(x - displacement(t)) : x;
    }

    /// Mean over a step, m/s2. A wall that is set going at once has the velocity 0 at that instant.
    Vector<Dim> acceleration(const Vector<Dim>& x, const WallTimes& times) const {
        return times.end > times.begin ? Vector<Dim>((velocity(x, times.end) - velocity(x, times.begin)) /
                                                     (times.end - times.begin))
                                       : Vector<Dim>(Vector<Dim>::Zero());
    }
};

/// A particle that is part of a wall: it stays at its place on the wall and has the wall's velocity there.
/// Every other quantity of it evolves as that of a fluid particle does.
template <int Dim>
struct WallParticle {
    int wall;             ///< index of the wall
    Vector<Dim> position; ///< m, at t = 0
};

/// What fills the support of a particle beyond a wall.
enum class WallMethod {
    /// Reflections of the fluid particles, anew at every search for neighbours. Wall particles, if there are
    /// any, lie on the wall. Source: Xu 2009 §2.1.3, §3.5; Morris et al. 1997 (velocity).
    mirror,
    /// Layers behind each wall particle, dx apart along the normal, with its velocity and its pressure.
    /// Source: Lee 2008 §1.3; Xu 2009 §3.5.
    dummy,
    /// Wall particles alone: a row on the wall and more behind it, whose density evolves by that of the
    /// fluid,
    /// as only a compressible scheme's does. Source: Issa 2005 §2.7 (fixed mirror particles).
    fixed,
    /// Nothing. Points on the wall, which are no particles, push the fluid away (repulsion.hpp). Source:
    /// Monaghan 1994; Issa 2005 §2.7.
    repulsive
};

/// The force between a particle and a point on a wall.
enum class RepulsiveForm {
    radial,        ///< of powers of the distance, along the line that joins them
    lennard_jones, ///< the same, steeper, with a tail
    normal         ///< along the normal of the wall, shared among neighbouring points
};

/// The pressure gradient normal to a wall.
enum class WallPressure {
    /// rho (f - a).n, which holds the fluid up against the body force f and pushes it ahead of a wall of
    /// acceleration a: images have the pressure of their particle and rho (f - a).(distance to it), and the
    /// share dt (f - a) of a velocity is not reflected. From the momentum equation at the wall without
    /// viscosity.
    inertial,
    /// 0, as published: the reflected share of the velocity makes the pressure, but its gradient at the first
    /// row is half of what it should be. Source: Xu 2009 §3.5.
    even
};

/// A wall that is at rest.
template <int Dim>
Vector<Dim> at_rest(const Vector<Dim>& /*x*/, double /*t*/) {
    return Vector<Dim>::Zero();
}

} // namespace sphvv::solver
