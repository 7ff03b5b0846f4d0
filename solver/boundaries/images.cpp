#include "sphvv/solver/boundaries/images.hpp"

#include "sphvv/solver/operators/symmetric_matrix.hpp"

#include <cmath>

namespace sphvv::solver {
namespace {

template <int Dim>
Vector<Dim> vector_at(const Field& field, std::size_t i) {
    Vector<Dim> v;
    for (int d = 0; d < Dim; ++d) {
        v[d] = field.components[d][i];
    }
    return v;
}

template <int Dim>
void set_vector(Field& field, std::size_t i, const Vector<Dim>& v) {
    for (int d = 0; d < Dim; ++d) {
        field.components[d][i] = v[d];
    }
}

template <int Dim>
Vector<Dim> reflected(const Vector<Dim>& v, const Vector<Dim>& normal) {
    return v - 2 * v.dot(normal) * normal;
}

} // namespace

template <int Dim>
void Images<Dim>::clear(const Particles<Dim>& particles) {
    source_.clear();
    particle_.clear();
    reflection_.clear();
    first_ = particles.size();
    symmetric_ = particles.fluid_size() == particles.size();
}

template <int Dim>
void Images<Dim>::add(int source, int particle, const Reflection& reflection) {
    source_.push_back(source);
    particle_.push_back(particle);
    reflection_.push_back(reflection);
}

template <int Dim>
void Images<Dim>::place(const std::vector<Vector<Dim>>& positions, Particles<Dim>& particles) {
    particles.set_images(size());
    for (std::size_t k = 0; k < size(); ++k) {
        set_vector<Dim>(particles.position, first_ + k, positions[k]);
    }
}

template <int Dim>
void Images<Dim>::mirror(std::span<const Wall<Dim>> walls, double radius, const WallTimes& times,
                         Particles<Dim>& particles) {
    clear(particles);
    std::vector<Vector<Dim>> positions;
    for (const Wall<Dim>& wall : walls) {
        const auto reflect = [&](int source, int particle, const Vector<Dim>& x) {
            const Vector<Dim> start = wall.at_start(x, times.place);
            const double d = wall.distance(start);
            if (std::abs(d) < radius) {
                const Vector<Dim> n = wall.normal(start);
                const Vector<Dim> foot = x - d * n;
                positions.push_back(foot - d * n);
                add(source, particle,
                    {n, wall.velocity(foot, times.end), wall.acceleration(foot, times), wall.slip});
            }
        };
        // Images in the walls before are reflected, too: that fills the corners.
        const std::size_t earlier = size();
        for (std::size_t i = 0; i < particles.fluid_size(); ++i) {
            reflect(static_cast<int>(i), static_cast<int>(i), vector_at<Dim>(particles.position, i));
        }
        for (std::size_t k = 0; k < earlier; ++k) {
            reflect(static_cast<int>(first_ + k), particle_[k], positions[k]);
        }
    }
    place(positions, particles);
}

template <int Dim>
void Images<Dim>::stack(std::span<const Wall<Dim>> walls, std::span<const WallParticle<Dim>> of, double dx,
                        double radius, const WallTimes& times, Particles<Dim>& particles) {
    clear(particles);
    std::vector<Vector<Dim>> positions;
    const auto fluid = static_cast<int>(particles.fluid_size());
    for (int i = fluid; i < static_cast<int>(first_); ++i) {
        const Wall<Dim>& wall = walls[of[particles.id[i] - fluid].wall];
        const auto at = vector_at<Dim>(particles.position, i);
        const Vector<Dim> n = wall.normal(wall.at_start(at, times.place));
        for (int layer = 1; layer * dx < radius; ++layer) {
            positions.push_back(at - layer * dx * n);
            add(i, i, {n, wall.velocity(at, times.end), wall.acceleration(at, times), wall.slip, true});
        }
    }
    place(positions, particles);
}

template <int Dim>
void Images<Dim>::fill(Field& field, Parity parity, const Vector<Dim>& body_share, double dt) const {
    for (std::size_t k = 0; k < size(); ++k) {
        const std::size_t from = source_[k];
        const std::size_t to = first_ + k;
        const auto& [normal, wall_velocity, wall_acceleration, slip, carried] = reflection_[k];
        switch (parity) {
        case Parity::even:
            for (auto& component : field.components) {
                component[to] = component[from];
            }
            break;
        case Parity::displacement:
            set_vector<Dim>(field, to, reflected<Dim>(vector_at<Dim>(field, from), normal));
            break;
        case Parity::velocity: {
            const Vector<Dim> common = body_share - dt * wall_acceleration;
            const Vector<Dim> relative = vector_at<Dim>(field, from) - common - wall_velocity;
            const Vector<Dim> image = carried                 ? relative
                                      : slip == Slip::no_slip ? Vector<Dim>(-relative)
                                                              : reflected<Dim>(relative, normal);
            set_vector<Dim>(field, to, common + wall_velocity + image);
            break;
        }
        case Parity::tensor: {
            Matrix<Dim> T;
            for (int a = 0; a < Dim; ++a) {
                for (int b = 0; b < Dim; ++b) {
                    T(a, b) = field.components[symmetric_component<Dim>(a, b)][from];
                }
            }
            const Matrix<Dim> R = Matrix<Dim>::Identity() - 2 * normal * normal.transpose();
            const Matrix<Dim> image = R * T * R;
            for (int a = 0; a < Dim; ++a) {
                for (int b = a; b < Dim; ++b) {
                    field.components[symmetric_component<Dim>(a, b)][to] = image(a, b);
                }
            }
            break;
        }
        }
    }
}

template <int Dim>
std::vector<double> Images<Dim>::differences(const Vector<Dim>& f, double rho, const Field& position) const {
    std::vector<double> result(size());
    for (std::size_t k = 0; k < size(); ++k) {
        // An image of an image has the difference of that, and its own wall's on top.
        const auto from = static_cast<std::size_t>(source_[k]);
        const Vector<Dim> way = vector_at<Dim>(position, first_ + k) - vector_at<Dim>(position, from);
        result[k] = (from < first_ ? 0 : result[from - first_]) +
                    rho * (f - reflection_[k].wall_acceleration).dot(way);
    }
    return result;
}

template <int Dim>
void Images<Dim>::fill(double* values, int first) const {
    for (std::size_t k = 0; k < size(); ++k) {
        values[first + k] = values[particle_[k]];
    }
}

template class Images<2>;
template class Images<3>;

} // namespace sphvv::solver
