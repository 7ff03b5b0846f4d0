#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sphvv::solver {

/// Whether a field carries the solution from one step to the next (it is sorted with the particles and
/// written to snapshots) or is formed anew within each step.
enum class Lifetime { state, scratch };

/// One named quantity on all particles, stored component by component.
struct Field {
    std::string name;
    Lifetime lifetime;
    std::vector<std::string> asked_by;
    std::size_t particles; ///< the values behind theirs are those of images
    std::vector<std::vector<double>> components;

    double* operator[](int component) { return components[component].data(); }
    const double* operator[](int component) const { return components[component].data(); }
    std::size_t bytes_per_particle() const { return components.size() * sizeof(double); }
};

/// target += scale * increment, component by component, at the particles (not at their images).
template <int Components>
void add_scaled(Field& target, double scale, const Field& increment) {
    const int count = static_cast<int>(target.particles);
    for (int c = 0; c < Components; ++c) {
        double* to = target[c];
        const double* from = increment[c];
#pragma omp parallel for simd schedule(static)
        for (int i = 0; i < count; ++i) {
            to[i] += scale * from[i];
        }
    }
}

/// Largest Euclidean norm of a vector field; 0 where every component is not a number.
template <int Dim>
double largest_norm(const Field& field) {
    const int count = static_cast<int>(field.particles);
    double squared_maximum = 0;
#pragma omp parallel for schedule(static) reduction(max : squared_maximum)
    for (int i = 0; i < count; ++i) {
        double squared = 0;
        for (int d = 0; d < Dim; ++d) {
            squared += field[d][i] * field[d][i];
        }
        squared_maximum = std::max(squared_maximum, squared);
    }
    return std::sqrt(squared_maximum);
}

/// The particles of a scene as a structure of arrays. It starts with position and velocity only; every other
/// field exists because a stage asked for it.
template <int Dim>
class Particles {
public:
    /// Of `count` particles, the last `wall` are part of walls.
    explicit Particles(std::size_t count, std::size_t wall = 0);
    // Moving keeps every field where it is, so references to fields survive; a copy would refer to the
    // original's.
    Particles(Particles&&) noexcept = default;
    Particles(const Particles&) = delete;
    Particles& operator=(const Particles&) = delete;
    Particles& operator=(Particles&&) = delete;
    ~Particles() = default;

    std::size_t size() const { return id.size(); }
    /// Particles of the fluid; those behind them are part of walls.
    std::size_t fluid_size() const { return size() - wall_; }
    /// Particles and their images beyond walls: the length of every component of a field.
    std::size_t with_images() const { return size() + images_; }
    /// Makes room for that many images, behind the particles, in every field.
    void set_images(std::size_t count);

    /// The field of that name, allocated (zero) when first asked for. A field that anyone wants as state is
    /// state.
    Field& field(std::string_view name, int components, Lifetime lifetime, std::string_view asked_by);
    /// The field of that name, or nullptr.
    const Field* find(std::string_view name) const;

    const std::deque<Field>& fields() const { return fields_; }
    std::deque<Field>& fields() { return fields_; }

    /// Bytes of all fields and the identity, per particle.
    std::size_t bytes_per_particle() const;

    /// Reorders identity and state fields: particle k becomes what was particle order[k]; the order must keep
    /// wall particles behind those of the fluid. Images are dropped.
    void permute(std::span<const int> order);

    std::vector<int> id; ///< rank at the start of the run

private:
    std::deque<Field> fields_; // a deque, so that references that stages hold stay valid
    std::vector<double> permuted_;
    std::size_t wall_;
    std::size_t images_ = 0;

public:
    Field& position; ///< m
    Field& velocity; ///< m/s
};

} // namespace sphvv::solver
