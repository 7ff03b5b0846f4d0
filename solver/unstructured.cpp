#include "sphvv/solver/unstructured.hpp"

#include "sphvv/solver/error.hpp"
#include "sphvv/solver/operators/summation_density.hpp"
#include "sphvv/solver/settings.hpp"
#include "sphvv/solver/simulation.hpp"

#include <cmath>
#include <random>

namespace sphvv::solver {
namespace {

template <int Dim>
using Points = std::array<std::vector<double>, Dim>;

constexpr double h_over_dx = 1.3;

template <int Dim>
Points<Dim> independent(const Box<Dim>& box, std::size_t count, std::uint64_t seed) {
    std::mt19937_64 generator(seed);
    Points<Dim> points;
    for (int d = 0; d < Dim; ++d) {
        points[d].resize(count);
    }
    for (std::size_t i = 0; i < count; ++i) {
        for (int d = 0; d < Dim; ++d) {
            // as in jitter()
            points[d][i] = box.low[d] + box.length(d) * static_cast<double>(generator() >> 11U) * 0x1.0p-53;
        }
    }
    return points;
}

/// Points and, behind them, what they are reflected to beyond sides that are not periodic; corners have
/// images of images.
template <int Dim>
struct Mirrored {
    Points<Dim> points;
    std::vector<int> source; ///< the point that each is, or is an image of
    Box<Dim> box;            ///< with room for the images

    Mirrored(const Box<Dim>& inner, const Points<Dim>& inside, double radius)
        : points(inside), source(inside[0].size()), box(inner) {
        for (std::size_t i = 0; i < source.size(); ++i) {
            source[i] = static_cast<int>(i);
        }
        for (int d = 0; d < Dim; ++d) {
            if (inner.periodic[d]) {
                continue;
            }
            box.low[d] -= radius;
            box.high[d] += radius;
            const std::size_t count = source.size();
            for (std::size_t i = 0; i < count; ++i) {
                for (const double side : {inner.low[d], inner.high[d]}) {
                    if (std::abs(points[d][i] - side) < radius) {
                        add(i, d, 2 * side - points[d][i]);
                    }
                }
            }
        }
    }

private:
    void add(std::size_t of, int direction, double coordinate) {
        for (int d = 0; d < Dim; ++d) {
            points[d].push_back(d == direction ? coordinate : points[d][of]);
        }
        source.push_back(source[of]);
    }
};

/// Back into the box: through a periodic side in at the opposite one, from any other reflected. The last
/// digits are dropped, as iterations amplify round-off: this keeps compilers agreed.
double inside(double x, double low, double high, bool periodic, double grain) {
    const double length = high - low;
    double share = (std::round((x - low) / grain) * grain) / length;
    share -= (periodic ? 1 : 2) * std::floor(share / (periodic ? 1 : 2));
    if (!periodic && share > 1) {
        share = 2 - share;
    }
    return periodic && share >= 1 ? low : low + share * length;
}

template <int Dim>
void settle(const Box<Dim>& box, Points<Dim>& points, double dx) {
    const Kernel& kernel = kernels::find("cubic_spline");
    const double h = h_over_dx * dx;
    const double volume = std::pow(dx, Dim);
    const int count = static_cast<int>(points[0].size());
    const Mirrored<Dim> all(box, points, kernel.support * h);
    std::array<const double*, Dim> position;
    for (int d = 0; d < Dim; ++d) {
        position[d] = all.points[d].data();
    }
    NeighbourList<Dim> list;
    list.build(all.box, kernel, h, 0, position, count, static_cast<int>(all.source.size()));
    std::vector<double> density(count); // over its mean
    for_each_row(list, [&](int i, const Row<Dim>& row) {
        density[i] = summation_density<Dim>(row, kernel, h, UniformVolume{volume}, volume);
    });
    for_each_row(list, [&](int i, const Row<Dim>& row) {
        Vector<Dim> total = Vector<Dim>::Zero();
        for (int k = 0; k < row.count; ++k) {
            Vector<Dim> apart;
            for (int d = 0; d < Dim; ++d) {
                apart[d] = row.separation[d][k];
            }
            const double r = apart.norm();
            if (r > 0) { // two at one place have no direction to part in
                total += density[all.source[row.index[k]]] * kernel.value(Dim, r, h) / r * apart;
            }
        }
        for (int d = 0; d < Dim; ++d) {
            points[d][i] = inside(points[d][i] + h * volume * total[d], box.low[d], box.high[d],
                                  box.periodic[d], 0x1p-20 * dx);
        }
    });
}

} // namespace

template <int Dim>
std::array<std::vector<double>, Dim> unstructured(const Box<Dim>& box, std::size_t count, std::uint64_t seed,
                                                  int iterations) {
    const double dx = std::pow(box.volume() / static_cast<double>(count), 1. / Dim);
    const double support = kernels::find("cubic_spline").support * h_over_dx * dx;
    for (int d = 0; d < Dim; ++d) {
        if (box.length(d) < (box.periodic[d] ? 2 : 1) * support) {
            throw UserError("unstructured points " + shortest(dx) +
                            " m apart do not settle in a box with a " + (box.periodic[d] ? "periodic " : "") +
                            "side of " + shortest(box.length(d)) + " m, less than " +
                            (box.periodic[d] ? "two supports of " : "a support of ") + shortest(support) +
                            " m; give more of them");
        }
    }
    Points<Dim> points = independent(box, count, seed);
    for (int iteration = 0; iteration < iterations; ++iteration) {
        settle<Dim>(box, points, dx);
    }
    return points;
}

template std::array<std::vector<double>, 2> unstructured<2>(const Box<2>&, std::size_t, std::uint64_t, int);
template std::array<std::vector<double>, 3> unstructured<3>(const Box<3>&, std::size_t, std::uint64_t, int);

} // namespace sphvv::solver
