#include "sphvv/verification/tensile_instability.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace sphvv::verification {
namespace {

/// f''(q), by a central difference: every kernel here has a continuous f'.
double second_derivative(const solver::Kernel& kernel, double q) {
    constexpr double step = 1e-6;
    return (kernel.derivative(q + step) - kernel.derivative(q - step)) / (2 * step);
}

/// V gradW and V grad grad W of a lattice neighbour, lengths in units of dx.
struct Neighbour {
    std::array<double, 2> r;
    std::array<double, 2> slope;
    double xx, xy, yy;
};

std::vector<Neighbour> lattice_neighbours(const solver::Kernel& kernel, double h) {
    std::vector<Neighbour> neighbours;
    const int reach = static_cast<int>(kernel.support * h);
    for (int a = -reach; a <= reach; ++a) {
        for (int b = -reach; b <= reach; ++b) {
            const double r = std::hypot(a, b);
            if (r == 0 || r >= kernel.support * h) {
                continue;
            }
            const double x = a / r;
            const double y = b / r;
            const double along = kernel.normalisation[2] / std::pow(h, 4) * second_derivative(kernel, r / h);
            const double across = kernel.normalisation[2] / std::pow(h, 3) * kernel.derivative(r / h) / r;
            neighbours.push_back({{double(a), double(b)},
                                  {across * a, across * b},
                                  along * x * x + across * y * y,
                                  (along - across) * x * y,
                                  along * y * y + across * x * x});
        }
    }
    return neighbours;
}

/// Smallest xi.K xi over the unit vectors xi with xi.g = 0; over all of them where g vanishes.
double smallest_stiffness(const std::vector<Neighbour>& neighbours, double kx, double ky) {
    double xx = 0;
    double xy = 0;
    double yy = 0;
    std::array<double, 2> g{};
    for (const Neighbour& j : neighbours) {
        const double phase = kx * j.r[0] + ky * j.r[1];
        const double factor = 2 * (1 - std::cos(phase));
        xx += factor * j.xx;
        xy += factor * j.xy;
        yy += factor * j.yy;
        for (int d = 0; d < 2; ++d) {
            g[d] += std::sin(phase) * j.slope[d];
        }
    }
    const double size = std::hypot(g[0], g[1]);
    if (size > 1e-9) {
        const double x = -g[1] / size;
        const double y = g[0] / size;
        return xx * x * x + 2 * xy * x * y + yy * y * y;
    }
    return (xx + yy) / 2 - std::hypot((xx - yy) / 2, xy);
}

} // namespace

double swegle_number(const solver::Kernel& kernel, double h_over_dx) {
    return second_derivative(kernel, 1 / h_over_dx);
}

double smallest_transform(const solver::Kernel& kernel, double h_over_dx) {
    constexpr int waves = 100;
    constexpr int intervals = 200; // of Simpson's rule: good to 1e-6 of the value at k = 0
    double smallest = 1;
    for (int wave = 1; wave <= waves; ++wave) {
        const double k = std::numbers::sqrt2 * std::numbers::pi * h_over_dx * wave / waves; // times h
        double integral = 0;
        for (int node = 0; node <= intervals; ++node) {
            const double q = kernel.support * node / intervals;
            const double weight = node == 0 || node == intervals ? 1 : node % 2 == 1 ? 4 : 2;
            integral += weight * kernel.f(q) * q * std::cyl_bessel_j(0., k * q);
        }
        integral *= kernel.support / intervals / 3;
        smallest = std::min(smallest, 2 * std::numbers::pi * kernel.normalisation[2] * integral);
    }
    constexpr double error = 1e-5; // of the quadrature, and of the Gaussian's edge
    return smallest < -error ? smallest : std::max(smallest, 0.);
}

double lattice_growth(const solver::Kernel& kernel, double h_over_dx) {
    constexpr int steps = 12;
    const std::vector<Neighbour> neighbours = lattice_neighbours(kernel, h_over_dx);
    double smallest = 0;
    for (int a = 0; a <= steps; ++a) {
        for (int b = 0; b <= a; ++b) {
            smallest = std::min(smallest, smallest_stiffness(neighbours, std::numbers::pi * a / steps,
                                                             std::numbers::pi * b / steps));
        }
    }
    constexpr double round_off = 1e-6; // of the difference quotients
    return smallest < -round_off ? -smallest : 0;
}

} // namespace sphvv::verification
