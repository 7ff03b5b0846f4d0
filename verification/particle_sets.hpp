#pragma once

#include "sphvv/solver/box.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace sphvv::verification {

/// How the particles of an operator study lie.
enum class Arrangement {
    square,      ///< square (cubic) lattice, periodic
    hexagonal,   ///< triangular (face-centred cubic) lattice, periodic
    jittered_5,  ///< square lattice, each coordinate displaced uniformly by up to 5 % of dx
    jittered_10, ///< 10 %
    jittered_20, ///< 20 %
    settled,     ///< a jittered tile relaxed by 200 shifts, repeated periodically
    polar,  ///< rings (cylinders of rings) of spacing dx with a random phase each; judged away from the rim
    random, ///< independent uniform positions, periodic
    edge,   ///< square lattice that ends at a plane; judged at one particle of its last row
    corner, ///< square lattice that ends at a corner; judged there
};

std::string_view to_string(Arrangement arrangement);
/// Every arrangement, in the order of the enumeration.
std::span<const Arrangement> all_arrangements();
/// Whether it depends on a seed.
bool is_random(Arrangement arrangement);
/// Whether every full support is its own mirror image.
bool is_lattice(Arrangement arrangement);
/// Whether supports are truncated where it is judged.
bool is_truncated(Arrangement arrangement);

/// Particles in a box of side 1 (hexagonal: slightly different sides).
template <int Dim>
struct ParticleSet {
    solver::Box<Dim> box;
    std::array<std::vector<double>, Dim> points; ///< m
    std::vector<double> volume;                  ///< m^dim
    std::vector<int> judged; ///< particles at which an operator is held against the exact result
    double dx;               ///< m

    int size() const { return static_cast<int>(volume.size()); }
};

/// n spacings along the side of the box. `margin` (m) is what the polar rings leave out at the rim: at least
/// the support. Throws std::invalid_argument for a settled arrangement whose n is no multiple of the tile
/// (settled_tile).
template <int Dim>
ParticleSet<Dim> particle_set(Arrangement arrangement, int n, double margin, std::uint64_t seed);

/// A part of such an arrangement whose size does not grow with n as that of the box does: for rings, as many
/// layers as leave three `margin` (m) away from both ends; for a square lattice, jittered, settled and random
/// sets a cube, in an open box of side 1, whose 8^2 or 12^3 judged spacings keep the margin from its surface,
/// where a wave sin(2 pi sum_d x_d + 0.3) has equal sine and cosine. Throws std::invalid_argument for other
/// arrangements, and where the cube leaves the box.
template <int Dim>
ParticleSet<Dim> particle_block(Arrangement arrangement, int n, double margin, std::uint64_t seed);

/// Particles along a side of the tile that a settled arrangement repeats.
template <int Dim>
constexpr int settled_tile = Dim == 2 ? 20 : 10;

} // namespace sphvv::verification
