#include "sphvv/verification/surface_shapes.hpp"

#include "sphvv/solver/settings.hpp"

namespace sphvv::verification {

std::string SurfaceShape::title(double at_size) const {
    return size.empty() ? std::string(name)
                        : std::string(name) + " " + solver::shortest(at_size) +
                              std::string(size.substr(size.find(' ')));
}

namespace surface_shapes {
const SurfaceShape& find(std::string_view name) {
    return solver::find_by_name(all(), name, "shape");
}
} // namespace surface_shapes

} // namespace sphvv::verification
