#include "sphvv/verification/particle_sets.hpp"

#include "sphvv/solver/arrangements.hpp"
#include "sphvv/solver/operators/shifting_vector.hpp"

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>

namespace sphvv::verification {
namespace {

constexpr std::array arrangements{
    Arrangement::square,      Arrangement::hexagonal, Arrangement::jittered_5, Arrangement::jittered_10,
    Arrangement::jittered_20, Arrangement::settled,   Arrangement::polar,      Arrangement::random,
    Arrangement::edge,        Arrangement::corner,
};

template <int Dim>
solver::Box<Dim> unit_box(bool periodic) {
    solver::Box<Dim> box;
    box.high.fill(1);
    box.periodic.fill(periodic);
    return box;
}

/// Where sine and cosine of a wave sin(2 pi sum_d x_d + 0.3) are equal: no term of an error happens to
/// vanish.
template <int Dim>
constexpr std::array<double, 3> slope_equals_value =
    Dim == 2 ? std::array{0.4, 0.6773, 0.} : std::array{0.3, 0.4, 0.3773};

/// Coordinates into the box: a shift or a jitter may have taken them out.
template <int Dim>
void wrap(ParticleSet<Dim>& set) {
    for (int d = 0; d < Dim; ++d) {
        const double side = set.box.length(d);
        for (double& x : set.points[d]) {
            x -= side * std::floor((x - set.box.low[d]) / side);
            x = x < set.box.high[d] ? x : set.box.low[d];
        }
    }
}

/// A set whose particles share the box evenly, all of them judged.
template <int Dim>
ParticleSet<Dim> even(const solver::Box<Dim>& box, std::array<std::vector<double>, Dim> points, double dx) {
    ParticleSet<Dim> set{box, std::move(points), {}, {}, dx};
    const std::size_t count = set.points[0].size();
    set.volume.assign(count, box.volume() / static_cast<double>(count));
    set.judged.resize(count);
    std::iota(set.judged.begin(), set.judged.end(), 0);
    wrap(set);
    return set;
}

template <int Dim>
ParticleSet<Dim> jittered(int n, double share, std::uint64_t seed) {
    const double dx = 1.0 / n;
    auto points = solver::lattice<Dim>(unit_box<Dim>(true), dx);
    solver::jitter<Dim>(points, share * dx, seed);
    return even<Dim>(unit_box<Dim>(true), std::move(points), dx);
}

/// Rows of a lattice repeated with a basis of points per cell.
template <int Dim>
ParticleSet<Dim> hexagonal(int n) {
    // A cell of the triangular lattice is dx by sqrt(3) dx with two points; of the face-centred cubic one, a
    // cube of side 2^(2/3) dx with four, which keeps the volume of a point at dx^3.
    const double dx = 1.0 / n;
    std::array<double, Dim> cell;
    std::vector<std::array<double, Dim>> basis;
    if constexpr (Dim == 2) {
        const double spacing = dx * std::sqrt(2 / std::sqrt(3.0)); // the volume of a point is dx^2
        cell = {spacing, std::sqrt(3.0) * spacing};
        basis = {{0.25, 0.25}, {0.75, 0.75}};
    } else {
        cell.fill(std::cbrt(4.0) * dx);
        basis = {{0.25, 0.25, 0.25}, {0.75, 0.75, 0.25}, {0.75, 0.25, 0.75}, {0.25, 0.75, 0.75}};
    }
    std::array<long, Dim> cells;
    solver::Box<Dim> box = unit_box<Dim>(true);
    long count = 1;
    for (int d = 0; d < Dim; ++d) {
        cells[d] = std::max(1L, std::lround(1 / cell[d]));
        box.high[d] = static_cast<double>(cells[d]) * cell[d];
        count *= cells[d];
    }
    std::array<std::vector<double>, Dim> points;
    for (long k = 0; k < count; ++k) {
        for (const std::array<double, Dim>& offset : basis) {
            long rest = k;
            for (int d = 0; d < Dim; ++d) {
                points[d].push_back(cell[d] * (static_cast<double>(rest % cells[d]) + offset[d]));
                rest /= cells[d];
            }
        }
    }
    return even<Dim>(box, std::move(points), dx);
}

/// Relaxed by r <- r + 0.02 dx R, the particles' own shifting vector: forces that fall off with distance, as
/// in a repulsive gas that is cooled.
template <int Dim>
ParticleSet<Dim> settled_tile_set(std::uint64_t seed) {
    constexpr int shifts = 200;
    constexpr double share = 0.02;
    ParticleSet<Dim> tile = jittered<Dim>(settled_tile<Dim>, 0.2, seed);
    const solver::Kernel& kernel = solver::kernels::find("quintic_spline");
    const double h = 1.3 * tile.dx;
    std::array<std::vector<double>, Dim> moved = tile.points;
    for (int shift = 0; shift < shifts; ++shift) {
        solver::NeighbourList<Dim> list;
        std::array<const double*, Dim> position;
        for (int d = 0; d < Dim; ++d) {
            position[d] = tile.points[d].data();
        }
        list.build(tile.box, kernel, h, 0, position, tile.size());
        for (int i = 0; i < tile.size(); ++i) {
            const solver::Vector<Dim> R = solver::shifting_vector<Dim>(list.row(i), list.support_radius());
            for (int d = 0; d < Dim; ++d) {
                moved[d][i] = tile.points[d][i] + share * tile.dx * R[d];
            }
        }
        tile.points = moved;
        wrap(tile);
        for (std::vector<double>& column : tile.points) {
            for (double& x : column) {
                x = std::round(x * 0x1p20) * 0x1p-20; // shifts amplify round-off; this keeps compilers agreed
            }
        }
        wrap(tile);
    }
    return tile;
}

template <int Dim>
ParticleSet<Dim> settled(int n, std::uint64_t seed) {
    if (n % settled_tile<Dim> != 0) {
        throw std::invalid_argument("a settled arrangement of " + std::to_string(n) +
                                    " spacings; accepted: multiples of " + std::to_string(settled_tile<Dim>));
    }
    const ParticleSet<Dim> tile = settled_tile_set<Dim>(seed);
    const int repeats = n / settled_tile<Dim>;
    std::array<std::vector<double>, Dim> points;
    const int copies = static_cast<int>(std::lround(std::pow(repeats, Dim)));
    for (int copy = 0; copy < copies; ++copy) {
        for (int i = 0; i < tile.size(); ++i) {
            int rest = copy;
            for (int d = 0; d < Dim; ++d) {
                points[d].push_back((tile.points[d][i] + rest % repeats) / repeats);
                rest /= repeats;
            }
        }
    }
    return even<Dim>(unit_box<Dim>(true), std::move(points), 1.0 / n);
}

/// Rings of radius 0, dx, 2 dx, … about the middle of the box; in three dimensions repeated in layers of dx
/// along the last direction: n of them, periodic, or, for a `slice`, as many that three are `margin` from
/// both ends.
template <int Dim>
ParticleSet<Dim> polar(int n, double margin, bool slice, std::uint64_t seed) {
    constexpr double pi = std::numbers::pi;
    constexpr int judged_layers = 3;
    const double dx = 1.0 / n;
    ParticleSet<Dim> set{unit_box<Dim>(false), {}, {}, {}, dx};
    const int beyond = slice ? static_cast<int>(std::ceil(margin / dx)) : 0;
    const int layers = Dim == 2 ? 1 : slice ? judged_layers + 2 * beyond : n;
    if constexpr (Dim == 3) {
        set.box.periodic[2] = !slice;
    }
    std::mt19937_64 generator(seed);
    const int rings = n / 2; // the last ring ends half a spacing inside the box
    for (int layer = 0; layer < layers; ++layer) {
        const bool deep = layer >= beyond && layer < layers - beyond;
        for (int ring = 0; ring < rings; ++ring) {
            const int along = ring == 0 ? 1 : static_cast<int>(std::lround(2 * pi * ring));
            const double area = ring == 0 ? pi / 4 : 2 * pi * ring; // over dx^2
            const double phase = static_cast<double>(generator() >> 11U) * 0x1.0p-53;
            for (int k = 0; k < along; ++k) {
                const double angle = 2 * pi * (k + phase) / along;
                set.points[0].push_back(0.5 + ring * dx * std::cos(angle));
                set.points[1].push_back(0.5 + ring * dx * std::sin(angle));
                if constexpr (Dim == 3) {
                    set.points[2].push_back(0.5 + (layer + 0.5 - 0.5 * layers) * dx);
                }
                if (deep && (rings - 0.5 - ring) * dx > margin) {
                    set.judged.push_back(set.size());
                }
                set.volume.push_back(area / along * std::pow(dx, Dim));
            }
        }
    }
    return set;
}

template <int Dim>
ParticleSet<Dim> random(int n, std::uint64_t seed) {
    const auto count = static_cast<std::size_t>(std::lround(std::pow(n, Dim)));
    std::array<std::vector<double>, Dim> points;
    for (int d = 0; d < Dim; ++d) {
        points[d].assign(count, 0.5);
    }
    solver::jitter<Dim>(points, 0.5, seed);
    return even<Dim>(unit_box<Dim>(true), std::move(points), 1.0 / n);
}

/// A block of lattice, deep enough for any support, in an open box; judged at the particle in its corner, or
/// in the middle of one side, which lies at the same place of the box for every n.
template <int Dim>
ParticleSet<Dim> truncated(int n, bool corner) {
    constexpr int depth = 16; // two supports at h/dx = 2.6
    constexpr int width = 2 * depth + 1;
    constexpr std::array<double, 3> place = slope_equals_value<Dim>;
    ParticleSet<Dim> set{unit_box<Dim>(false), {}, {}, {}, 1.0 / n};
    if (place[0] + depth * set.dx > 1 || place[1] + depth * set.dx > 1) {
        throw std::invalid_argument("a truncated block of " + std::to_string(n) +
                                    " spacings leaves its box; accepted: 40 and more");
    }
    std::array<int, Dim> along;
    along.fill(corner ? depth : width);
    along[0] = depth;
    std::array<int, Dim> at{};
    for (bool more = true; more;) {
        bool here = at[0] == 0;
        for (int d = 1; d < Dim; ++d) {
            here = here && at[d] == (corner ? 0 : depth);
        }
        if (here) {
            set.judged.push_back(set.size());
        }
        for (int d = 0; d < Dim; ++d) {
            const int from_judged = at[d] - (corner || d == 0 ? 0 : depth);
            set.points[d].push_back(place[d] + from_judged * set.dx);
        }
        set.volume.push_back(std::pow(set.dx, Dim));
        more = false;
        for (int d = 0; d < Dim && !more; ++d) {
            more = ++at[d] < along[d];
            at[d] = more ? at[d] : 0;
        }
    }
    return set;
}

} // namespace

std::string_view to_string(Arrangement arrangement) {
    constexpr std::array<std::string_view, arrangements.size()> names{
        "square",  "hexagonal", "jittered 5 %", "jittered 10 %", "jittered 20 %",
        "settled", "polar",     "random",       "edge",          "corner"};
    return names[static_cast<std::size_t>(arrangement)];
}

std::span<const Arrangement> all_arrangements() {
    return arrangements;
}

bool is_random(Arrangement arrangement) {
    return !is_lattice(arrangement) && !is_truncated(arrangement);
}

bool is_lattice(Arrangement arrangement) {
    return arrangement == Arrangement::square || arrangement == Arrangement::hexagonal;
}

bool is_truncated(Arrangement arrangement) {
    return arrangement == Arrangement::edge || arrangement == Arrangement::corner;
}

template <int Dim>
ParticleSet<Dim> particle_set(Arrangement arrangement, int n, double margin, std::uint64_t seed) {
    switch (arrangement) {
    case Arrangement::square:
        return jittered<Dim>(n, 0, 0);
    case Arrangement::hexagonal:
        return hexagonal<Dim>(n);
    case Arrangement::jittered_5:
        return jittered<Dim>(n, 0.05, seed);
    case Arrangement::jittered_10:
        return jittered<Dim>(n, 0.10, seed);
    case Arrangement::jittered_20:
        return jittered<Dim>(n, 0.20, seed);
    case Arrangement::settled:
        return settled<Dim>(n, seed);
    case Arrangement::polar:
        return polar<Dim>(n, margin, false, seed);
    case Arrangement::random:
        return random<Dim>(n, seed);
    case Arrangement::edge:
        return truncated<Dim>(n, false);
    case Arrangement::corner:
        return truncated<Dim>(n, true);
    }
    throw std::invalid_argument("no such arrangement");
}

template <int Dim>
ParticleSet<Dim> particle_block(Arrangement arrangement, int n, double margin, std::uint64_t seed) {
    if (arrangement == Arrangement::polar) {
        return polar<Dim>(n, margin, true, seed);
    }
    if (is_truncated(arrangement) || arrangement == Arrangement::hexagonal) {
        throw std::invalid_argument("a block of a " + std::string(to_string(arrangement)) + " arrangement");
    }
    constexpr int judged_across = Dim == 2 ? 8 : 12; // 64 or 1728 particles enter a norm
    const double dx = 1.0 / n;
    int across = judged_across + 2 * static_cast<int>(std::ceil(margin / dx));
    if (arrangement == Arrangement::settled) {
        across = settled_tile<Dim> * ((across + settled_tile<Dim> - 1) / settled_tile<Dim>);
    }
    if (across > n) {
        throw std::invalid_argument("a block of " + std::to_string(across) +
                                    " spacings leaves its box; accepted: " + std::to_string(across) +
                                    " and more along the box");
    }
    ParticleSet<Dim> set = particle_set<Dim>(arrangement, across, margin, seed);
    std::vector<char> inside(set.size(), 1);
    for (int d = 0; d < Dim; ++d) {
        const double centre = slope_equals_value<Dim>[d];
        set.box.low[d] = centre - 0.5;
        set.box.high[d] = centre + 0.5;
        set.box.periodic[d] = false;
        for (int i = 0; i < set.size(); ++i) {
            const double from_centre = (set.points[d][i] - 0.5) * across * dx;
            set.points[d][i] = centre + from_centre;
            inside[i] = inside[i] && std::abs(from_centre) < 0.5 * across * dx - margin;
        }
    }
    std::erase_if(set.judged, [&](int i) { return !inside[i]; });
    set.volume.assign(set.size(), std::pow(dx, Dim));
    set.dx = dx;
    return set;
}

template ParticleSet<2> particle_block<2>(Arrangement, int, double, std::uint64_t);
template ParticleSet<3> particle_block<3>(Arrangement, int, double, std::uint64_t);
template ParticleSet<2> particle_set<2>(Arrangement, int, double, std::uint64_t);
template ParticleSet<3> particle_set<3>(Arrangement, int, double, std::uint64_t);

} // namespace sphvv::verification
