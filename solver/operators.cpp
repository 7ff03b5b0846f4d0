#include "sphvv/solver/operators.hpp"

#include "sphvv/solver/settings.hpp"

namespace sphvv::solver {

std::string_view to_string(Approximates kind) {
    switch (kind) {
    case Approximates::gradient:
        return "gradient";
    case Approximates::divergence:
        return "divergence";
    case Approximates::laplacian:
        return "laplacian";
    case Approximates::vector_laplacian:
        return "vector laplacian";
    case Approximates::viscous:
        return "viscous";
    case Approximates::vector_gradient:
        return "vector gradient";
    case Approximates::strain_rate:
        return "strain rate";
    case Approximates::unity:
        return "unity";
    case Approximates::dimension:
        return "dimension";
    case Approximates::nothing:
        break;
    }
    return "nothing";
}

int field_components(Approximates kind, int dim) {
    switch (kind) {
    case Approximates::gradient:
    case Approximates::laplacian:
        return 1;
    case Approximates::unity:
    case Approximates::dimension:
        return 0;
    default:
        return dim;
    }
}

int result_components(Approximates kind, int dim) {
    switch (kind) {
    case Approximates::divergence:
    case Approximates::laplacian:
    case Approximates::unity:
    case Approximates::dimension:
        return 1;
    case Approximates::vector_gradient:
    case Approximates::strain_rate:
        return dim * dim;
    default:
        return dim;
    }
}

namespace operators {
const Operator& find(std::string_view name) {
    return find_by_name(all(), name, "operator");
}
} // namespace operators

} // namespace sphvv::solver
