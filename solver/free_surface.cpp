#include "sphvv/solver/free_surface.hpp"

#include <cmath>

namespace sphvv::solver {

Key Detector::threshold_key(int dim, double radius) const {
    std::string about(key_summary);
    for (const PublishedThreshold& print : published) {
        if (print.dimension == dim) {
            about += "; published: " + shortest(print.value) + " (" + std::string(print.source) + ")";
        }
    }
    return Key::number(std::string(key), threshold(dim, radius), 0, highest_threshold, "1", about);
}

int lattice_neighbours(int dim, double radius, int rows) {
    const int reach = static_cast<int>(std::ceil(radius));
    int found = -1; // itself
    for (int z = -reach; z <= std::min(rows, reach); ++z) {
        for (int y = -reach; y <= reach; ++y) {
            for (int x = dim == 3 ? -reach : 0; x <= (dim == 3 ? reach : 0); ++x) {
                found += x * x + y * y + z * z < radius * radius ? 1 : 0;
            }
        }
    }
    return found;
}

namespace free_surface {
const Detector& find(std::string_view name) {
    return find_by_name(all(), name, "free-surface detector");
}
} // namespace free_surface

} // namespace sphvv::solver
