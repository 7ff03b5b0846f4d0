#include "sphvv/solver/schemes.hpp"

namespace sphvv::solver {

std::vector<Key> common_keys(std::string_view kernel, double h_over_dx) {
    std::vector<std::string> names;
    for (const Kernel* entry : kernels::all()) {
        names.emplace_back(entry->name);
    }
    return {Key::word("kernel", std::string(kernel), names, "smoothing kernel"),
            Key::number("h_over_dx", h_over_dx, 0.8, 5, "1", "smoothing length h over particle spacing dx"),
            Key::number("time_step", 0, 0, 1e6, "s", "fixed time step; 0 takes the scheme's own limits")};
}

std::vector<Key> joined(std::vector<Key> keys, const std::vector<Key>& more) {
    keys.insert(keys.end(), more.begin(), more.end());
    return keys;
}

namespace schemes {
const Scheme& find(std::string_view name) {
    return find_by_name(all(), name, "scheme");
}
} // namespace schemes

} // namespace sphvv::solver
