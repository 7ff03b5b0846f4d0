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
template <int Dim>
class Images {
public:
    std::size_t size() const { return source_.size(); }
    bool empty() const { return source_.empty(); }

    /// Makes images of the fluid particles within `radius` (m) of each wall, at the time t (s): positions,
    /// and room in every other field. The image lies at r - 2 d n, reflected in the tangent plane at the foot
    /// point.
    void mirror(std::span<const Wall<Dim>> walls, double radius, const WallTimes& times,
                Particles<Dim>& particles);

    /// Makes images of the wall particles (`of` holds them in the order of their identities) at r - k dx n, k
    /// = 1, 2, … while k dx < radius. Every place behind the walls has one image:
    ///  - a particle that lies on several walls (a corner of a cavity) has images behind all of them, at r -
    ///    dx (k n + l n' + …);
    ///  - where the layers of two faces of a convex body overlap, a place belongs to the nearer face, and one
    ///    as near to both has the mean of its neighbours.
    /// Source: Lee 2008 §1.3; Xu 2009 §3.5.
    void stack(std::span<const Wall<Dim>> walls, std::span<const WallParticle<Dim>> of, double dx,
               double radius, const WallTimes& times, Particles<Dim>& particles);

    /// Values of a field at the images, from those at the particles.
    void fill(Field& field, Parity parity) const { fill(field, parity, Vector<Dim>::Zero(), 0); }
    /// The same for a velocity of which common - dt a, a the acceleration of the wall, is what everything
    /// has, images alike: only the rest is reflected.
    void fill(Field& field, Parity parity, const Vector<Dim>& common, double dt) const;
    /// What a component of a velocity is at every image, from what it is at the particle of the image: sign u
    /// + offset (m/s).
    struct Reflected {
        std::vector<double> sign;
        std::vector<double> offset;
    };
    /// That of a velocity u* which the pressure has yet to act on. At a wall without slip it is that of the
    /// wall, at one with free slip its component along the normal is, but for the share (common - dt a).n,
    /// which the pressure takes off again. The components must not mix: the normal of a wall with free slip
    /// lies along an axis, and no image is a mean.
    Reflected reflected_component(int component, const Vector<Dim>& common, double dt) const;
    /// What a pressure with the gradient rho (f - a) next to a wall of acceleration a differs by at every
    /// image from that of its particle, Pa.
    std::vector<double> differences(const Vector<Dim>& f, double rho, const Field& position) const;
    void fill(double* values, int first) const; ///< the same for one even array with images from `first` on

    /// Whether a pair of particles sees of each other's images what it sees of the other's. Not so with wall
    /// particles: a wall particle sees the image of a fluid particle, which sees none of the wall particle
    /// (mirror) or several (dummy).
    bool symmetric() const { return symmetric_; }

    /// The particle, itself no image, behind the image k; of an image that is a mean, one of them.
    int particle(std::size_t k) const { return particle_[k]; }

private:
    struct Reflection {
        Vector<Dim> normal;
        Vector<Dim> wall_velocity;
        Vector<Dim> wall_acceleration;
        Slip slip;
        bool carried = false; ///< the velocity is that of the source, a wall particle
    };

    /// An image whose values are the mean of others, which have theirs before it.
    struct Mean {
        std::size_t image;
        std::vector<std::size_t> of; ///< places in a field
    };

    void clear(const Particles<Dim>& particles);
    /// Leaves one of the images that share a place, as the mean of those next to it.
    void merge_shared_places(double dx, const Particles<Dim>& particles, std::vector<Vector<Dim>>& positions);
    void add(int source, int particle, const Reflection& reflection);
    void take_means(double* values) const;
    void place(const std::vector<Vector<Dim>>& positions, Particles<Dim>& particles);

    std::vector<int> source_; // a particle or an earlier image
    std::vector<int> particle_;
    std::vector<Reflection> reflection_;
    std::vector<Mean> means_;
    bool symmetric_ = true;
    std::size_t first_ = 0; // place of the first image in a field
};

} // namespace sphvv::solver
