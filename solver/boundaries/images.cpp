#include "sphvv/solver/boundaries/images.hpp"

#include "sphvv/solver/operators/symmetric_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

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

/// Of dx: nearer, two points are one.
constexpr double same_place = 0.25;

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
    means_.clear();
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
    bool convex = false;
    const auto fluid = static_cast<int>(particles.fluid_size());
    for (int i = fluid; i < static_cast<int>(first_); ++i) {
        const Wall<Dim>& wall = walls[of[particles.id[i] - fluid].wall];
        const auto at = vector_at<Dim>(particles.position, i);
        const Vector<Dim> n = wall.normal(wall.at_start(at, times.place));
        std::vector<Vector<Dim>> ways; // behind each of the walls on which the particle lies
        ways.push_back(n);
        for (const Wall<Dim>& other : walls) {
            const Vector<Dim> start = other.at_start(at, times.place);
            if (&other != &wall && std::abs(other.distance(start)) < same_place * dx) {
                ways.push_back(other.normal(start));
            }
        }
        std::vector<Vector<Dim>> places{at};
        for (const Vector<Dim>& way : ways) {
            const std::size_t before = places.size();
            for (int layer = 1; layer * dx < radius; ++layer) {
                for (std::size_t k = 0; k < before; ++k) {
                    places.push_back(places[k] - layer * dx * way);
                }
            }
        }
        for (std::size_t k = 1; k < places.size(); ++k) {
            // Behind one wall alone its depth is what the particle went; less, if another face is nearer.
            const double way = ways.size() == 1 ? (places[k] - at).norm() : 0;
            if (-wall.distance(wall.at_start(places[k], times.place)) < way - same_place * dx) {
                convex = true;
                continue;
            }
            positions.push_back(places[k]);
            add(i, i, {n, wall.velocity(at, times.end), wall.acceleration(at, times), wall.slip, true});
        }
    }
    if (convex) {
        merge_shared_places(dx, particles, positions);
    }
    place(positions, particles);
}

template <int Dim>
void Images<Dim>::merge_shared_places(double dx, const Particles<Dim>& particles,
                                      std::vector<Vector<Dim>>& positions) {
    const auto near = [](const Vector<Dim>& a, const Vector<Dim>& b, double low, double high) {
        const double squared = (a - b).squaredNorm();
        return low * low <= squared && squared <= high * high;
    };
    std::vector<int> sharers(positions.size(), 0); // images at the same place as an earlier one: -1
    std::vector<std::size_t> order(positions.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return positions[a][0] != positions[b][0] ? positions[a][0] < positions[b][0] : a < b;
    });
    const double close = same_place * dx;
    for (std::size_t a = 0; a < order.size(); ++a) {
        for (std::size_t b = a + 1;
             b < order.size() && positions[order[b]][0] - positions[order[a]][0] <= close; ++b) {
            if (near(positions[order[a]], positions[order[b]], 0, close)) {
                const auto [first, second] = std::minmax(order[a], order[b]);
                sharers[second] = -1;
                sharers[first] += sharers[first] < 0 ? 0 : 1;
            }
        }
    }
    std::size_t kept = 0;
    std::vector<std::size_t> shared;
    for (std::size_t k = 0; k < positions.size(); ++k) {
        if (sharers[k] >= 0) {
            if (sharers[k] > 0) {
                shared.push_back(kept);
            }
            positions[kept] = positions[k];
            source_[kept] = source_[k];
            particle_[kept] = particle_[k];
            reflection_[kept] = reflection_[k];
            ++kept;
        }
    }
    positions.resize(kept);
    source_.resize(kept);
    particle_.resize(kept);
    reflection_.resize(kept);
    for (const std::size_t k : shared) {
        Mean mean{k, {}};
        const auto is_next = [&](const Vector<Dim>& x) {
            return near(positions[k], x, dx - close, dx + close);
        };
        for (std::size_t i = particles.fluid_size(); i < first_; ++i) {
            if (is_next(vector_at<Dim>(particles.position, i))) {
                mean.of.push_back(i);
            }
        }
        for (std::size_t other = 0; other < kept; ++other) {
            if (is_next(positions[other]) && !std::binary_search(shared.begin(), shared.end(), other)) {
                mean.of.push_back(first_ + other);
            }
        }
        if (!mean.of.empty()) {
            means_.push_back(std::move(mean));
        }
    }
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
    for (auto& component : field.components) {
        take_means(component.data());
    }
}

template <int Dim>
typename Images<Dim>::Reflected Images<Dim>::reflected_component(int component, const Vector<Dim>& common,
                                                                 double dt) const {
    Reflected result{std::vector<double>(size()), std::vector<double>(size())};
    for (std::size_t k = 0; k < size(); ++k) {
        const Reflection& at = reflection_[k];
        const double n = at.normal[component];
        const bool sticks = at.slip == Slip::no_slip;
        const double sign = sticks ? -1 : 1 - 2 * n * n;
        const double of_wall = sticks ? at.wall_velocity[component] : at.wall_velocity.dot(at.normal) * n;
        const double share = (common - dt * at.wall_acceleration).dot(at.normal) * n;
        // An image of an image is reflected from that.
        const auto from = static_cast<std::size_t>(source_[k]);
        result.sign[k] = from < first_ ? sign : sign * result.sign[from - first_];
        result.offset[k] = 2 * (of_wall + share) + (from < first_ ? 0 : sign * result.offset[from - first_]);
    }
    return result;
}

template <int Dim>
void Images<Dim>::take_means(double* values) const {
    for (const Mean& mean : means_) {
        double total = 0;
        for (const std::size_t i : mean.of) {
            total += values[i];
        }
        values[first_ + mean.image] = total / static_cast<double>(mean.of.size());
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
    for (const Mean& mean : means_) {
        double total = 0;
        for (const std::size_t i : mean.of) {
            total += i < first_ ? 0 : result[i - first_];
        }
        result[mean.image] = total / static_cast<double>(mean.of.size());
    }
    return result;
}

template <int Dim>
void Images<Dim>::fill(double* values, int first) const {
    for (std::size_t k = 0; k < size(); ++k) {
        values[first + k] = values[particle_[k]];
    }
    take_means(values);
}

template class Images<2>;
template class Images<3>;

} // namespace sphvv::solver
