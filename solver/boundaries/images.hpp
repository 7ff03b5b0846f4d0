#pragma once

#include "sphvv/solver/boundaries/wall.hpp"
#include "sphvv/solver/particles.hpp"

#include <span>
#include <vector>

namespace sphvv::solver {

/// How the value of an image follows from that of what it is an image of.
enum class Parity {
    even,         ///< the same: a quantity without gradient normal to the wall
    velocity,     ///< 2w - u at a wall without slip, u - 2n(u - w).n at one with free slip; w: of the wall
    displacement, ///< d - 2n(d.n): what moves the image with its particle
    tensor        ///< (1 - 2nn) T (1 - 2nn), T symmetric, stored by its upper triangle
};

/// Images of particles beyond walls. They are neighbours like any other: they have positions and values in
/// every field, behind those of the particles, but no row of their own and no equation. Corners have images
/// of images. A scene without walls has none, and nothing is done for them.
///
/// Mirror method: every particle closer to a wall than the kernel's support is reflected in the wall's
/// tangent plane at its foot point, r - 2 d n, anew whenever neighbours are searched for. Source: Xu 2009
/// §2.1.3; Morris et al. 1997 (velocity).
template <int Dim>
class Images {
public:
    std::size_t size() const { return source_.size(); }
    bool empty() const { return source_.empty(); }

    /// Makes the images of all particles within `radius` (m) of each wall, at the time t (s): positions, and
    /// room in every other field.
    void mirror(std::span<const Wall<Dim>> walls, double radius, double t, Particles<Dim>& particles);

    /// Values of a field at the images, from those at the particles.
    void fill(Field& field, Parity parity) const;
    void fill(double* values, int first) const; ///< the same for one even array with images from `first` on

    /// The particle, itself no image, behind the image k; and what its value is of.
    int particle(std::size_t k) const { return particle_[k]; }

private:
    struct Reflection {
        Vector<Dim> normal;
        Vector<Dim> wall_velocity;
        Slip slip;
    };

    std::vector<int> source_; // a particle or an earlier image
    std::vector<int> particle_;
    std::vector<Reflection> reflection_;
    std::size_t first_ = 0; // place of the first image in a field
};

} // namespace sphvv::solver
