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
    fixed
};

/// The pressure gradient normal to a wall.
enum class WallPressure {
    /// rho f.n, which holds the fluid up against the body force f: images have the pressure of their particle
    /// and
    /// rho f.(distance to it), and the share dt f of a velocity is not reflected.
    hydrostatic,
    /// 0, as published: the reflected share of the velocity makes the pressure, but its gradient at the first
    /// row
    /// is half of it. Source: Xu 2009 §3.5.
    even
};

/// A wall that is at rest.
template <int Dim>
Vector<Dim> at_rest(const Vector<Dim>& /*x*/, double /*t*/) {
    return Vector<Dim>::Zero();
}

} // namespace sphvv::solver
