#include "sphvv/solver/particles.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace sphvv::solver {

template <int Dim>
Particles<Dim>::Particles(std::size_t count, std::size_t wall)
    : id(count), wall_(wall), position(field("position", Dim, Lifetime::state, "scene")),
      velocity(field("velocity", Dim, Lifetime::state, "scene")) {
    std::iota(id.begin(), id.end(), 0);
}

template <int Dim>
Field& Particles<Dim>::field(std::string_view name, int components, Lifetime lifetime,
                             std::string_view asked_by) {
    auto found = std::find_if(fields_.begin(), fields_.end(), [&](const Field& f) { return f.name == name; });
    if (found == fields_.end()) {
        Field fresh{std::string(name), lifetime, {}, size(), {}};
        fresh.components.assign(components, std::vector<double>(with_images(), 0.0));
        fields_.push_back(std::move(fresh));
        found = fields_.end() - 1;
    }
    if (static_cast<int>(found->components.size()) != components) {
        throw std::logic_error("field '" + std::string(name) + "' is asked for with " +
                               std::to_string(components) + " components but has " +
                               std::to_string(found->components.size()));
    }
    if (lifetime == Lifetime::state) {
        found->lifetime = Lifetime::state;
    }
    if (std::find(found->asked_by.begin(), found->asked_by.end(), asked_by) == found->asked_by.end()) {
        found->asked_by.emplace_back(asked_by);
    }
    return *found;
}

template <int Dim>
const Field* Particles<Dim>::find(std::string_view name) const {
    const auto found =
        std::find_if(fields_.begin(), fields_.end(), [&](const Field& f) { return f.name == name; });
    return found == fields_.end() ? nullptr : &*found;
}

template <int Dim>
std::size_t Particles<Dim>::bytes_per_particle() const {
    std::size_t bytes = sizeof(int);
    for (const Field& field : fields_) {
        bytes += field.bytes_per_particle();
    }
    return bytes;
}

template <int Dim>
void Particles<Dim>::set_images(std::size_t count) {
    images_ = count;
    for (Field& field : fields_) {
        for (std::vector<double>& component : field.components) {
            component.resize(with_images());
        }
    }
}

template <int Dim>
void Particles<Dim>::permute(std::span<const int> order) {
    const int count = static_cast<int>(order.size());
    set_images(0);
    permuted_.resize(order.size());
    for (Field& field : fields_) {
        if (field.lifetime != Lifetime::state) {
            continue;
        }
        for (std::vector<double>& component : field.components) {
#pragma omp parallel for schedule(static)
            for (int k = 0; k < count; ++k) {
                permuted_[k] = component[order[k]];
            }
            component.swap(permuted_);
        }
    }
    std::vector<int> ids(order.size());
    std::transform(order.begin(), order.end(), ids.begin(), [&](int k) { return id[k]; });
    id.swap(ids);
}

template class Particles<2>;
template class Particles<3>;

} // namespace sphvv::solver
