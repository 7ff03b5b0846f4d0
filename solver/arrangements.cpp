#include "sphvv/solver/arrangements.hpp"

#include "sphvv/solver/settings.hpp"

#include <cmath>
#include <random>

namespace sphvv::solver {

template <int Dim>
std::array<std::vector<double>, Dim> lattice(const Box<Dim>& box, double dx) {
    std::array<long, Dim> along;
    long count = 1;
    for (int d = 0; d < Dim; ++d) {
        const double spacings = box.length(d) / dx;
        along[d] = std::lround(spacings);
        if (along[d] < 1 || std::abs(spacings - static_cast<double>(along[d])) > 1e-9 * spacings) {
            throw UserError("a lattice of spacing " + shortest(dx) + " does not fill a side of length " +
                            shortest(box.length(d)));
        }
        count *= along[d];
    }
    std::array<std::vector<double>, Dim> points;
    for (int d = 0; d < Dim; ++d) {
        points[d].reserve(count);
    }
    for (long k = 0; k < count; ++k) {
        long rest = k;
        for (int d = 0; d < Dim; ++d) {
            const auto step = static_cast<double>(rest % along[d]);
            points[d].push_back(box.low[d] + (step + 0.5) * box.length(d) / static_cast<double>(along[d]));
            rest /= along[d];
        }
    }
    return points;
}

template <int Dim>
void jitter(std::array<std::vector<double>, Dim>& points, double amplitude, std::uint64_t seed) {
    std::mt19937_64 generator(seed);
    for (std::size_t i = 0; i < points[0].size(); ++i) {
        for (int d = 0; d < Dim; ++d) {
            // The upper 53 bits as a number in [0, 1): std::uniform_real_distribution is not the same
            // everywhere.
            const double uniform = static_cast<double>(generator() >> 11U) * 0x1.0p-53;
            points[d][i] += amplitude * (2 * uniform - 1);
        }
    }
}

template std::array<std::vector<double>, 2> lattice<2>(const Box<2>&, double);
template std::array<std::vector<double>, 3> lattice<3>(const Box<3>&, double);
template void jitter<2>(std::array<std::vector<double>, 2>&, double, std::uint64_t);
template void jitter<3>(std::array<std::vector<double>, 3>&, double, std::uint64_t);

} // namespace sphvv::solver
