#include "sphvv/solver/kernels.hpp"

#include "sphvv/solver/settings.hpp"

#include <cmath>

namespace sphvv::solver {

double Kernel::value_scale(int dim, double h) const {
    return normalisation[dim] / std::pow(h, dim);
}

double Kernel::slope_scale(int dim, double h) const {
    return normalisation[dim] / std::pow(h, dim + 2);
}

double Kernel::value(int dim, double r, double h) const {
    return value_scale(dim, h) * f(r / h);
}

double Kernel::slope(int dim, double r, double h) const {
    const double squared = r * r;
    double result = 0;
    slopes({&squared, 1}, h, slope_scale(dim, h), &result);
    return result;
}

namespace kernels {
const Kernel& find(std::string_view name) {
    return find_by_name(all(), name, "kernel");
}
} // namespace kernels

} // namespace sphvv::solver
