#pragma once

#include "sphvv/solver/operators/laplacian_morris.hpp"
#include "sphvv/solver/operators/symmetric_matrix.hpp"

#include <cmath>
#include <concepts>

/// The momentum equation of a weakly compressible fluid, particle by particle. What a pair of particles does
/// to i is a type that is made at i and called for eight neighbours at a time; the form of the pressure force
/// and that of the viscous force are template parameters, so that the loop over pairs asks nothing.
namespace sphvv::solver {

/// What a weakly compressible momentum equation reads of the particles. A form that does not read an array
/// leaves it null.
template <int Dim>
struct MomentumFields {
    std::array<const double*, Dim> u;                                       ///< m/s
    const double* pressure_over_squared_density;                            ///< p/rho^2, m5/(kg s2)
    const double* specific_volume;                                          ///< 1/rho, m3/kg
    const double* pressure = nullptr;                                       ///< p, Pa
    std::array<const double*, symmetric_components<Dim>> renormalisation{}; ///< L_i, with V_j = m/rho_j
    const double* lowest_eigenvalue = nullptr;                              ///< of L_i^-1
    const double* eddy_viscosity = nullptr;                                 ///< nu_T, m2/s
};

/// Lowest eigenvalue of L^-1 below which a particle is taken for one of the free surface. Source: Oger 2007.
constexpr double surface_eigenvalue = 0.97;

/// Eight pairs of a row, from entry k on.
template <int Dim>
struct Pairs {
    const Row<Dim>& row;
    int k;

    const int* j() const { return row.index + k; }
    Lanes slope() const { return load(row.slope + k); }
    Lanes separation(int d) const { return load(row.separation[d] + k); }
};

/// The forms of the pressure force, -(1/rho) grad p. Each makes, by at<Dim>(row, i, fields, m), what takes
/// eight pairs and returns their accelerations of i (m/s2), as a function of the component.
namespace pressure_forces {

/// weight_ij r_ij: a force along the line of the pair.
template <int Dim>
auto central(const Pairs<Dim>& pairs, Lanes weight) {
    return [pairs, weight](int d) { return weight * pairs.separation(d); };
}

/// -m (p_i/rho_i^2 + p_j/rho_j^2) gradW_ij. Source: Monaghan 1992; Issa P2; Oger 2007, sigma = 2; Lee 2008
/// §1.3.
struct Sigma2 {
    template <int Dim>
    static auto at(const Row<Dim>& /*row*/, int i, const MomentumFields<Dim>& fields, double m) {
        const double* P = fields.pressure_over_squared_density;
        return [P, P_i = P[i], m](const Pairs<Dim>& pairs) {
            return central<Dim>(pairs, -m * (P_i + gather(P, pairs.j())) * pairs.slope());
        };
    }
};

/// -m (p_j + own)/(rho_i rho_j) for eight neighbours, times F_ij: what is left is r_ij, or L_i r_ij.
template <int Dim>
struct ProductWeight {
    ProductWeight(int i, const MomentumFields<Dim>& fields, double m, double own_pressure)
        : p(fields.pressure), v(fields.specific_volume), own(own_pressure), scale(-m * v[i]) {}

    Lanes operator()(const Pairs<Dim>& pairs) const {
        return scale * gather(v, pairs.j()) * (gather(p, pairs.j()) + own) * pairs.slope();
    }

    const double* p;
    const double* v;
    double own;
    double scale;
};

template <int Dim>
auto product_force(int i, const MomentumFields<Dim>& fields, double m, double own_pressure) {
    return [weight = ProductWeight<Dim>(i, fields, m, own_pressure)](const Pairs<Dim>& pairs) {
        return central<Dim>(pairs, weight(pairs));
    };
}

/// -m (p_i + p_j)/(rho_i rho_j) gradW_ij. Source: Issa P1; Oger 2007, sigma = 1.
struct Sigma1 {
    template <int Dim>
    static auto at(const Row<Dim>& /*row*/, int i, const MomentumFields<Dim>& fields, double m) {
        return product_force<Dim>(i, fields, m, fields.pressure[i]);
    }
};

/// -m p_j/(rho_i rho_j) gradW_ij. Source: Issa G0; Xu 2009 §2.1.2.
struct Plain {
    template <int Dim>
    static auto at(const Row<Dim>& /*row*/, int i, const MomentumFields<Dim>& fields, double m) {
        return product_force<Dim>(i, fields, m, 0);
    }
};

/// -m (p_j - p_i)/(rho_i rho_j) gradW_ij. Source: Issa G1; Xu 2009 §2.1.2.
struct Difference {
    template <int Dim>
    static auto at(const Row<Dim>& /*row*/, int i, const MomentumFields<Dim>& fields, double m) {
        return product_force<Dim>(i, fields, m, -fields.pressure[i]);
    }
};

template <int Dim>
auto renormalised_force(int i, const MomentumFields<Dim>& fields, double m, double own_pressure) {
    return [weight = ProductWeight<Dim>(i, fields, m, own_pressure),
            L = read_symmetric<Dim>(fields.renormalisation, i)](const Pairs<Dim>& pairs) {
        return [w = weight(pairs), L, pairs](int d) {
            Lanes along{};
            for (int b = 0; b < Dim; ++b) {
                along += L(d, b) * pairs.separation(b);
            }
            return w * along;
        };
    };
}

/// -m (p_i + p_j)/(rho_i rho_j) L_i gradW_ij. Source: Oger 2007 (non-coherent renormalised).
struct Renormalised {
    template <int Dim>
    static auto at(const Row<Dim>& /*row*/, int i, const MomentumFields<Dim>& fields, double m) {
        return renormalised_force<Dim>(i, fields, m, fields.pressure[i]);
    }
};

/// -m (p_j - p_i)/(rho_i rho_j) L_i gradW_ij, exact for linear p. Source: Oger 2007 (Taylor-SPH).
struct Taylor {
    template <int Dim>
    static auto at(const Row<Dim>& /*row*/, int i, const MomentumFields<Dim>& fields, double m) {
        return renormalised_force<Dim>(i, fields, m, -fields.pressure[i]);
    }
};

/// Whether i or a particle that interacts with it, F_ij /= 0, lies at the free surface.
template <int Dim>
bool near_surface(const Row<Dim>& row, int i, const double* lowest_eigenvalue) {
    Lanes found{};
    for (int k = 0; k < row.padded; k += lane_count) {
        const auto surface =
            (gather(lowest_eigenvalue, row.index + k) < surface_eigenvalue) & (load(row.slope + k) != 0);
        found += select(surface, 1, 0);
    }
    return sum(found) > 0 || lowest_eigenvalue[i] < surface_eigenvalue;
}

/// Taylor, but Renormalised at the free surface, where the difference p_j - p_i does not see that p = 0
/// outside. Source: Oger 2007 (hybrid Taylor-SPH).
struct HybridTaylor {
    template <int Dim>
    static auto at(const Row<Dim>& row, int i, const MomentumFields<Dim>& fields, double m) {
        const double sign = near_surface<Dim>(row, i, fields.lowest_eigenvalue) ? 1 : -1;
        return renormalised_force<Dim>(i, fields, m, sign * fields.pressure[i]);
    }
};

/// -m/(rho_i rho_j) (p_i L_i + p_j L_j) gradW_ij: antisymmetric, but not along the line of the pair. Source:
/// Oger 2007 (coherent renormalised).
struct RenormalisedCoherent {
    template <int Dim>
    static auto at(const Row<Dim>& /*row*/, int i, const MomentumFields<Dim>& fields, double m) {
        const Matrix<Dim> own = fields.pressure[i] * read_symmetric<Dim>(fields.renormalisation, i);
        return [own, &fields, scale = -m * fields.specific_volume[i]](const Pairs<Dim>& pairs) {
            const Lanes weight = scale * gather(fields.specific_volume, pairs.j()) * pairs.slope();
            const Lanes p = gather(fields.pressure, pairs.j());
            std::array<Lanes, Dim> result{};
            for (int a = 0; a < Dim; ++a) {
                for (int b = a; b < Dim; ++b) {
                    const double* L = fields.renormalisation[symmetric_component<Dim>(a, b)];
                    const Lanes both = weight * (own(a, b) + p * gather(L, pairs.j()));
                    result[a] += both * pairs.separation(b);
                    if (a != b) {
                        result[b] += both * pairs.separation(a);
                    }
                }
            }
            return [result](int d) { return result[d]; };
        };
    }
};

} // namespace pressure_forces

/// The forms of the viscous force for a constant dynamic viscosity mu (kg/(m s)), and with an eddy viscosity
/// beside it, mu_i = mu + rho_i nu_T,i; made and called as the pressure forces are. Those that read F_ij take
/// it by a slope of laplacian_morris.hpp; the others take eta from it.
namespace viscous_forces {

/// Of an inviscid fluid: there is no such force, and no pair is asked for one.
struct None {
    static constexpr bool reads_slope = false;
};

/// 2 mu m/(rho_i rho_j) F_ij r^2/(r^2 + eta^2) (u_i - u_j). Source: Morris et al. 1997; Lee 2008 §1.3.
struct Morris {
    static constexpr bool reads_slope = true;
    template <int Dim>
    static auto at(int i, const MomentumFields<Dim>& fields, double m, double mu, const auto& slope) {
        return [&fields, i, scale = 2 * mu * m * fields.specific_volume[i], slope](const Pairs<Dim>& pairs) {
            const Lanes viscous =
                scale * gather(fields.specific_volume, pairs.j()) * slope(pairs.row, pairs.k);
            return [viscous, pairs, &fields, i](int d) {
                return viscous * (fields.u[d][i] - gather(fields.u[d], pairs.j()));
            };
        };
    }
};

/// 2(dim+2) mu m/(rho_i rho_j) (u_ij . r_ij)/(r^2 + eta^2) gradW_ij, along the line of the pair: angular
/// momentum is conserved, and div grad u + 2 grad div u is what it tends to. A coincident pair (r = 0) has no
/// direction and adds nothing. Source: Cleary & Monaghan 1999; Lee 2008 §1.3 with nu_i = mu/rho_i, which
/// makes (nu_i + nu_j)/(rho_i + rho_j) = mu/(rho_i rho_j); Issa §2 (8 in 2-D, 10 in 3-D).
struct MonaghanCleary {
    static constexpr bool reads_slope = false;
    template <int Dim>
    static auto at(int i, const MomentumFields<Dim>& fields, double m, double mu, const auto& slope) {
        return [&fields, i, scale = 2 * (Dim + 2) * mu * m * fields.specific_volume[i],
                eta_squared = slope.eta_squared](const Pairs<Dim>& pairs) {
            Lanes along{};
            for (int d = 0; d < Dim; ++d) {
                along += (fields.u[d][i] - gather(fields.u[d], pairs.j())) * pairs.separation(d);
            }
            const Lanes r2 = squared_separation<Dim>(pairs.row, pairs.k);
            const Lanes safe = select(r2 > 0, r2 + eta_squared, 1);
            return pressure_forces::central<Dim>(pairs, scale * gather(fields.specific_volume, pairs.j()) *
                                                            pairs.slope() * along / safe);
        };
    }
};

/// Twice the mean of two eddy viscosities, a + b. Source: Issa 2005 §5.1.
struct ArithmeticMean {
    static Lanes doubled(double a, Lanes b) { return a + b; }
};

/// Twice the logarithmic mean, 2 (a - b)/ln(a/b) = (a + b) x/artanh x with x = (a - b)/(a + b). Over a wall
/// nu_T grows in proportion to the distance z and u as ln z: this mean times the difference of u is that of
/// z, which a constant stress asks of every pair; the arithmetic mean is larger, by ln(z_j/z_i)/2 where z_i
/// is much the smaller.
struct LogarithmicMean {
    static Lanes doubled(double a, Lanes b) {
        return lanes_of([&](int l) {
            const double sum = a + b[l];
            const double difference = std::abs(a - b[l]);
            // x/artanh x = 1 - x^2/3 - 4 x^4/45 - …; 0 where one of the two is.
            return difference < 1e-3 * sum ? sum - difference * difference / (3 * sum)
                   : a > 0 && b[l] > 0     ? 2 * difference / std::abs(std::log(a / b[l]))
                                           : 0;
        });
    }
};

/// (mu_i + mu_j) m/(rho_i rho_j) F_ij r^2/(r^2 + eta^2) (u_i - u_j), div(nu grad u): Morris with an eddy
/// viscosity, mu = rho nu_T. Source: Morris et al. 1997; Issa 2005 §2.
template <class Mean>
struct MorrisEddy {
    static constexpr bool reads_slope = true;
    template <int Dim>
    static auto at(int i, const MomentumFields<Dim>& fields, double m, double mu, const auto& slope) {
        const double v_i = fields.specific_volume[i];
        return [&fields, i, m, mu, v_i, mu_t = fields.eddy_viscosity[i] / v_i,
                slope](const Pairs<Dim>& pairs) {
            const Lanes v_j = gather(fields.specific_volume, pairs.j());
            const Lanes both = 2 * mu + Mean::doubled(mu_t, gather(fields.eddy_viscosity, pairs.j()) / v_j);
            const Lanes viscous = m * v_i * v_j * both * slope(pairs.row, pairs.k);
            return [viscous, pairs, &fields, i](int d) {
                return viscous * (fields.u[d][i] - gather(fields.u[d], pairs.j()));
            };
        };
    }
};

/// 2(dim+2) m (nu_i + nu_j)/(rho_i + rho_j) (u_ij . r_ij)/(r^2 + eta^2) gradW_ij with nu_i = mu/rho_i +
/// nu_T,i: Monaghan-Cleary with an eddy viscosity. Source: Issa 2005 §5.1 (8 in 2-D).
template <class Mean>
struct MonaghanClearyEddy {
    static constexpr bool reads_slope = false;
    template <int Dim>
    static auto at(int i, const MomentumFields<Dim>& fields, double m, double mu, const auto& slope) {
        const double v_i = fields.specific_volume[i];
        return [&fields, i, scale = 2 * (Dim + 2) * m * v_i, v_i, nu_i = fields.eddy_viscosity[i], mu,
                eta_squared = slope.eta_squared](const Pairs<Dim>& pairs) {
            Lanes along{};
            for (int d = 0; d < Dim; ++d) {
                along += (fields.u[d][i] - gather(fields.u[d], pairs.j())) * pairs.separation(d);
            }
            const Lanes r2 = squared_separation<Dim>(pairs.row, pairs.k);
            const Lanes safe = select(r2 > 0, r2 + eta_squared, 1);
            const Lanes v_j = gather(fields.specific_volume, pairs.j());
            const Lanes both =
                mu + Mean::doubled(nu_i, gather(fields.eddy_viscosity, pairs.j())) / (v_i + v_j);
            return pressure_forces::central<Dim>(pairs, scale * v_j * both * pairs.slope() * along / safe);
        };
    }
};

} // namespace viscous_forces

/// Both forces together, to be called for eight pairs at a time.
template <int Dim, class PressureForce, class ViscousForce>
requires std::same_as<ViscousForce, viscous_forces::None>
auto pair_acceleration(const Row<Dim>& row, int i, const MomentumFields<Dim>& fields, double m, double /*mu*/,
                       const auto& /*slope*/) {
    return [pressure = PressureForce::template at<Dim>(row, i, fields, m)](const Pairs<Dim>& pairs) {
        const auto by_pressure = pressure(pairs);
        std::array<Lanes, Dim> result;
        for (int d = 0; d < Dim; ++d) {
            result[d] = by_pressure(d);
        }
        return result;
    };
}

template <int Dim, class PressureForce, class ViscousForce>
auto pair_acceleration(const Row<Dim>& row, int i, const MomentumFields<Dim>& fields, double m, double mu,
                       const auto& slope) {
    return [pressure = PressureForce::template at<Dim>(row, i, fields, m),
            viscosity = ViscousForce::template at<Dim>(i, fields, m, mu, slope)](const Pairs<Dim>& pairs) {
        const auto by_pressure = pressure(pairs);
        const auto by_viscosity = viscosity(pairs);
        std::array<Lanes, Dim> result;
        for (int d = 0; d < Dim; ++d) {
            result[d] = by_pressure(d) + by_viscosity(d);
        }
        return result;
    };
}

/// body(slope) with the slope that a viscous force takes.
template <int Dim, class ViscousForce, class Body>
auto with_slope_of(double eta_squared, const Body& body) {
    if constexpr (ViscousForce::reads_slope) {
        return with_slope<Dim>(eta_squared, body);
    } else {
        return body(RegularisedSlope<Dim>{eta_squared});
    }
}

/// Acceleration of particle i (m/s2) by pressure and viscosity. The default,
/// -sum_j m (p_i/rho_i^2 + p_j/rho_j^2) gradW_ij + sum_j m 2 mu/(rho_i rho_j) F_ij r^2/(r^2+eta^2) (u_i -
/// u_j), is pairwise antisymmetric, so that linear momentum is conserved exactly. Source: Lee 2008 §1.1, §1.3
/// (Morris viscosity).
template <int Dim, class PressureForce = pressure_forces::Sigma2, class ViscousForce = viscous_forces::Morris>
Vector<Dim> momentum_weakly_compressible(const Row<Dim>& row, int i, const MomentumFields<Dim>& fields,
                                         double m, double mu, double eta_squared) {
    return with_slope_of<Dim, ViscousForce>(eta_squared, [&](const auto& slope) {
        const auto by = pair_acceleration<Dim, PressureForce, ViscousForce>(row, i, fields, m, mu, slope);
        std::array<Lanes, Dim> total{};
        for (int k = 0; k < row.padded; k += lane_count) {
            const std::array<Lanes, Dim> a = by(Pairs<Dim>{row, k});
            for (int d = 0; d < Dim; ++d) {
                total[d] += a[d];
            }
        }
        return lane_sums<Dim>(total);
    });
}

/// Components of a torque: one in 2-D, three in 3-D.
template <int Dim>
inline constexpr int torque_components = Dim == 2 ? 1 : 3;

/// sum_j r_ij x a_ij (m2/s2) with a_ij the acceleration of i by j: half of its sum over all particles, times
/// m, is the torque of all pairs (N m). Zero where every force lies along the line of its pair.
template <int Dim, class PressureForce, class ViscousForce>
std::array<double, torque_components<Dim>>
torque_weakly_compressible(const Row<Dim>& row, int i, const MomentumFields<Dim>& fields, double m, double mu,
                           double eta_squared) {
    return with_slope_of<Dim, ViscousForce>(eta_squared, [&](const auto& slope) {
        const auto by = pair_acceleration<Dim, PressureForce, ViscousForce>(row, i, fields, m, mu, slope);
        std::array<Lanes, torque_components<Dim>> total{};
        for (int k = 0; k < row.padded; k += lane_count) {
            const Pairs<Dim> pairs{row, k};
            const std::array<Lanes, Dim> a = by(pairs);
            for (int c = 0; c < torque_components<Dim>; ++c) {
                const int first = Dim == 2 ? 0 : (c + 1) % Dim;
                const int second = Dim == 2 ? 1 : (c + 2) % Dim;
                total[c] += pairs.separation(first) * a[second] - pairs.separation(second) * a[first];
            }
        }
        std::array<double, torque_components<Dim>> result;
        for (int c = 0; c < torque_components<Dim>; ++c) {
            result[c] = sum(total[c]);
        }
        return result;
    });
}

} // namespace sphvv::solver
