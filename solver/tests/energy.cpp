// Which forms of the weakly compressible equations conserve energy, momentum and angular momentum, exactly:
// by the balance of their rates, and in time.
//   solver_energy --gtest_filter='*Balance*'
//
// With e(rho), de/drho = p/rho^2, the energy of the particles is E = sum_i m (|u_i|^2/2 + e(rho_i)), and
//   dE/dt = sum_i m u_i.a_i + sum_i m (p_i/rho_i^2) drho_i/dt.
// For an antisymmetric force a_i = -sum_j m X_ij, X_ij = -X_ji, the first sum is -1/2 sum_ij m^2 u_ij.X_ij.
// The second one cancels it term by term where X_ij = Y_ij - Y_ji and p_i/rho_i^2 drho_i/dt = sum_j m
// u_ij.Y_ij:
//   continuity    p_i/rho_i^2 drho_i/dt = sum_j m u_ij . …           pressure_force X_ij
//   sigma_2       p_i/rho_i^2 gradW_ij                               sigma_2
//   sigma_1       p_i/(rho_i rho_j) gradW_ij                         sigma_1
//   renormalised  p_i/(rho_i rho_j) L_i gradW_ij                     renormalised_coherent
// Nothing else cancels: each force has one partner, and the forces that are not antisymmetric have none among
// the continuity equations (that of `plain` would be drho_i/dt = -rho_i sum V_j u_j.gradW_ij, that of
// `difference` drho_i/dt = -rho_i sum V_j (u_i + u_j).gradW_ij). Oger 2007 pairs like with like. Issa 2005
// pairs the rate S2 (sigma_2) with P1 (sigma_1), which is no partner, and the sum S1, rho_i = sum m W_ij,
// with P2 (sigma_2), which is one: the rate of S1 is S2.
//
// Torque. A virtual turn u = w x r does the work -dE_elastic/dt on a variational pair. The renormalised
// divergence is exact for linear u and div (w x r) = 0, so the torque of renormalised_coherent vanishes in
// sum, though not pair by pair (Bonet & Lok 1999).
#include "sphvv/solver/schemes.hpp"
#include "sphvv/solver/tests/scenes.hpp"
#include "sphvv/solver/weakly_compressible/tait.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <cstdio>
#include <map>
#include <set>

namespace sphvv::solver {
namespace {

using namespace scenes;

using Forms = std::pair<std::string, std::string>; // continuity, pressure_force

const std::set<Forms> variational{
    {"sigma_2", "sigma_2"}, {"sigma_1", "sigma_1"}, {"renormalised", "renormalised_coherent"}};
const std::set<std::string> antisymmetric{"sigma_2", "sigma_1", "renormalised_coherent"};
/// Without torque: along the line of the pair, or (head of this file) in sum.
const std::set<std::string> torque_free{"sigma_2", "sigma_1", "renormalised_coherent"};

const std::vector<std::string>& words(std::string_view key) {
    return std::ranges::find(schemes::find("wcsph").keys, key, &Key::name)->choices;
}

/// A smooth flow on particles displaced by up to a fifth of their spacing, with densities that differ by up
/// to 10 % and the pressures that go with them. The velocities of the isolated one fit no box.
template <int Dim>
Simulation<Dim> disordered_scene(Assignments given, double viscosity, bool isolated) {
    const Scheme& scheme = schemes::find("wcsph");
    given["time_step"] = "1e-30"; // a step that changes no bit: the rates are those of the state
    Simulation<Dim> scene = flowing_scene<Dim>(scheme, given, Dim == 2 ? 14 : 9, 0.2);
    scene.kinematic_viscosity = viscosity;
    scene.box.periodic.fill(!isolated);
    scheme.assemble(scene);
    Random random(7);
    for (double& rho : scene.particles.field("density", 1, Lifetime::state, "test").components[0]) {
        rho *= random.uniform(0.9, 1.1);
    }
    advance(scene); // pressures
    advance(scene); // rates
    return scene;
}

/// A sum of terms, and that of their sizes.
struct Sum {
    double value = 0;
    double size = 0;
    void add(double term) {
        value += term;
        size += std::abs(term);
    }
    double relative() const { return std::abs(value) / size; }
};

/// Rates of change of the sums over all particles.
template <int Dim>
struct Balance {
    Sum energy;
    std::array<Sum, Dim> momentum;
    std::array<Sum, 3> angular_momentum; ///< in 2-D only the last

    explicit Balance(const Simulation<Dim>& scene) {
        const auto& particles = scene.particles;
        const double m = scene.particle_mass;
        const Field& x = particles.position;
        const Field& u = particles.velocity;
        const Field& a = *particles.find("acceleration");
        const double* p = (*particles.find("pressure"))[0];
        const double* rho = (*particles.find("density"))[0];
        const double* rate = (*particles.find("density_rate"))[0];
        for (int i = 0; i < static_cast<int>(particles.size()); ++i) {
            for (int d = 0; d < Dim; ++d) {
                energy.add(m * u[d][i] * a[d][i]);
                momentum[d].add(m * a[d][i]);
            }
            energy.add(m * p[i] / (rho[i] * rho[i]) * rate[i]);
            for (int c = Dim == 2 ? 2 : 0; c < 3; ++c) {
                const int first = (c + 1) % 3;
                const int second = (c + 2) % 3;
                angular_momentum[c].add(m * (x[first][i] * a[second][i] - x[second][i] * a[first][i]));
            }
        }
    }

    double largest_momentum_rate() const {
        double result = 0;
        for (const Sum& component : momentum) {
            result = std::max(result, component.relative());
        }
        return result;
    }
    double torque() const {
        return std::hypot(angular_momentum[0].value, angular_momentum[1].value, angular_momentum[2].value);
    }
    double torque_size() const {
        return angular_momentum[0].size + angular_momentum[1].size + angular_momentum[2].size;
    }
};

/// A sum that is zero but for round-off, and one that clearly is not, relative to the size of its terms.
constexpr double round_off = 1e-13;
constexpr double clearly = 1e-5;

Conserves claims(const Assignments& given) {
    const Scheme& wcsph = schemes::find("wcsph");
    return wcsph.conserves(Settings(wcsph.keys, given));
}

TEST(Energy, BalanceHoldsForTheVariationalPairsAndNoOthers) {
    in_2d_and_3d([&](auto dimension) {
        constexpr int Dim = dimension;
        std::printf("%d-D: (sum m u.a + sum m p/rho^2 drho/dt) over the sum of the terms' sizes\n", Dim);
        for (const std::string& pressure_force : words("pressure_force")) {
            for (const std::string& continuity : words("continuity")) {
                SCOPED_TRACE(continuity + " " + pressure_force);
                const Balance<Dim> balance(disordered_scene<Dim>(
                    {{"continuity", continuity}, {"pressure_force", pressure_force}}, 0, false));
                const double rate = balance.energy.relative();
                std::printf("  %-22s %-13s %10.1e\n", pressure_force.c_str(), continuity.c_str(), rate);
                EXPECT_EQ(variational.contains({continuity, pressure_force}),
                          claims({{"continuity", continuity}, {"pressure_force", pressure_force}}).energy);
                if (variational.contains({continuity, pressure_force})) {
                    EXPECT_LT(rate, round_off);
                } else {
                    EXPECT_GT(rate, clearly);
                }
            }
        }
    });
}

TEST(Energy, BalanceHoldsForAnIsolatedBodyToo) {
    in_2d_and_3d([&](auto dimension) {
        constexpr int Dim = dimension;
        for (const auto& [continuity, pressure_force] : variational) {
            SCOPED_TRACE(continuity);
            const Balance<Dim> balance(disordered_scene<Dim>(
                {{"continuity", continuity}, {"pressure_force", pressure_force}}, 0, true));
            EXPECT_LT(balance.energy.relative(), round_off);
        }
    });
}

TEST(Energy, IsTakenByEitherViscosity) {
    in_2d_and_3d([&](auto dimension) {
        constexpr int Dim = dimension;
        for (const std::string& viscosity : words("viscosity")) {
            SCOPED_TRACE(viscosity);
            const Balance<Dim> balance(disordered_scene<Dim>({{"viscosity", viscosity}}, 0.05, false));
            EXPECT_LT(balance.energy.value, -clearly * balance.energy.size);
        }
    });
}

TEST(Momentum, IsConservedByAntisymmetricForcesAndNoOthers) {
    in_2d_and_3d([&](auto dimension) {
        constexpr int Dim = dimension;
        std::printf("%d-D: sum m a over the sum of the terms' sizes\n", Dim);
        for (const std::string& pressure_force : words("pressure_force")) {
            for (const std::string& viscosity : words("viscosity")) {
                SCOPED_TRACE(pressure_force + " " + viscosity);
                const Balance<Dim> balance(disordered_scene<Dim>(
                    {{"pressure_force", pressure_force}, {"viscosity", viscosity}}, 0.05, false));
                const double rate = balance.largest_momentum_rate();
                std::printf("  %-22s %-16s %10.1e\n", pressure_force.c_str(), viscosity.c_str(), rate);
                EXPECT_EQ(antisymmetric.contains(pressure_force),
                          claims({{"pressure_force", pressure_force}, {"viscosity", viscosity}}).momentum);
                if (antisymmetric.contains(pressure_force)) {
                    EXPECT_LT(rate, round_off);
                } else {
                    EXPECT_GT(rate, clearly);
                }
            }
        }
    });
}

// In a periodic box angular momentum has no meaning, so the body is isolated. Its rate is the sum over all
// pairs of r_ij x f_ij where forces are antisymmetric.
TEST(AngularMomentum, IsConservedByVariationalForcesAndViscosityAlongTheLineOfThePair) {
    in_2d_and_3d([&](auto dimension) {
        constexpr int Dim = dimension;
        std::printf("%d-D: sum r x m a over the sum of the terms' sizes\n", Dim);
        for (const std::string& pressure_force : words("pressure_force")) {
            for (const auto& [viscosity, nu] : {std::pair<std::string, double>{"no viscosity", 0},
                                                {"morris", 0.5},
                                                {"monaghan_cleary", 0.5}}) {
                SCOPED_TRACE(pressure_force + " " + viscosity);
                const Simulation<Dim> scene = disordered_scene<Dim>(
                    {{"pressure_force", pressure_force}, {"viscosity", nu == 0 ? "morris" : viscosity}}, nu,
                    true);
                const Balance<Dim> balance(scene);
                const double rate = balance.torque() / balance.torque_size();
                std::printf("  %-22s %-16s %10.1e\n", pressure_force.c_str(), viscosity.c_str(), rate);
                EXPECT_TRUE(nu == 0 || (rate < round_off) == claims({{"pressure_force", pressure_force},
                                                                     {"viscosity", viscosity}})
                                                                 .angular_momentum);
                if (torque_free.contains(pressure_force) && viscosity != "morris") {
                    EXPECT_LT(rate, round_off);
                } else {
                    EXPECT_GT(rate, clearly);
                }
                if (antisymmetric.contains(pressure_force)) {
                    EXPECT_NEAR(scene.internal_torque(scene), balance.torque(),
                                round_off * balance.torque_size());
                }
            }
        }
    });
}

// What a scheme offers.

TEST(ElasticEnergy, HasTheSlopeOfTheEquationOfState) {
    for (const double gamma : {1.0, 1.5, 7.0}) {
        for (const double background : {0.0, 2.0}) {
            const weakly_compressible::Tait tait{3, 20, gamma, background};
            EXPECT_EQ(tait.elastic_energy(3), 0);
            for (const double rho : {2.4, 2.999, 3.001, 3.6}) {
                const double step = 1e-4;
                // fourth order in the step
                const double slope =
                    (8 * (tait.elastic_energy(rho + step) - tait.elastic_energy(rho - step)) -
                     (tait.elastic_energy(rho + 2 * step) - tait.elastic_energy(rho - 2 * step))) /
                    (12 * step);
                EXPECT_NEAR(slope, tait.pressure(rho) / (rho * rho), 1e-9 * tait.stiffness());
            }
        }
    }
}

// e = (c0^2/2) (x - 1)^2 [1 + O(x - 1)]: the digits that a difference of powers would lose.
TEST(ElasticEnergy, KeepsItsDigitsNearTheReferenceDensity) {
    const weakly_compressible::Tait tait{1, 10, 7, 0};
    for (const double apart : {1e-3, 1e-5, 1e-7}) {
        EXPECT_NEAR(tait.elastic_energy(1 + apart) / (50 * apart * apart), 1,
                    3 * apart + 1e-15 / (apart * apart));
    }
}

TEST(ElasticEnergy, IsOfferedByTheWeaklyCompressibleSchemeOnly) {
    for (const Scheme* scheme : schemes::all()) {
        Simulation<2> scene = flowing_scene<2>(*scheme, {}, 9);
        scheme->assemble(scene);
        EXPECT_EQ(static_cast<bool>(scene.elastic_energy), scheme->compressible) << scheme->name;
        EXPECT_EQ(static_cast<bool>(scene.internal_torque), scheme->compressible) << scheme->name;
    }
}

// The scheme's energy is the one whose rate is balanced above.
TEST(ElasticEnergy, ChangesAtTheRateOfTheBalance) {
    in_2d_and_3d([&](auto dimension) {
        constexpr int Dim = dimension;
        Simulation<Dim> scene = disordered_scene<Dim>({{"background_pressure", "3"}}, 0, false);
        const double* p = (*scene.particles.find("pressure"))[0];
        const double* rate = (*scene.particles.find("density_rate"))[0];
        double* rho = scene.particles.field("density", 1, Lifetime::state, "test")[0];
        const int count = static_cast<int>(scene.particles.size());
        double expected = 0;
        double size = 0;
        for (int i = 0; i < count; ++i) {
            const double term = scene.particle_mass * p[i] / (rho[i] * rho[i]) * rate[i];
            expected += term;
            size += std::abs(term);
        }
        const double dt = 1e-5;
        const auto energy_after = [&](double time) {
            for (int i = 0; i < count; ++i) {
                rho[i] += time * rate[i];
            }
            const double energy = scene.elastic_energy(scene);
            for (int i = 0; i < count; ++i) {
                rho[i] -= time * rate[i];
            }
            return energy;
        };
        EXPECT_NEAR((energy_after(dt) - energy_after(-dt)) / (2 * dt), expected, 1e-6 * size);
    });
}

// Asking for the torque leaves a run as it was.
TEST(InternalTorque, ChangesNoState) {
    for (const std::string& pressure_force : words("pressure_force")) {
        const auto run = [&](bool ask) {
            const Scheme& scheme = schemes::find("wcsph");
            Simulation<2> scene = flowing_scene<2>(scheme, {{"pressure_force", pressure_force}}, 14, 0.1);
            scheme.assemble(scene);
            for (int step = 0; step < 4; ++step) {
                advance(scene);
                if (ask) {
                    EXPECT_GT(scene.internal_torque(scene), 0);
                }
            }
            return std::pair(scene.particles.velocity.components, scene.work.pair_evaluations);
        };
        EXPECT_EQ(run(true), run(false)) << pressure_force;
    }
}

// In time: the error of the time step vanishes with its square, that of the pair of forms does not.

/// (E(t) - E(0))/E_kin(0) of an inviscid flow after t = 0.04 in that many steps.
double energy_drift(const Forms& forms, int steps) {
    const Scheme& scheme = schemes::find("wcsph");
    Simulation<2> scene = flowing_scene<2>(scheme,
                                           {{"continuity", forms.first},
                                            {"pressure_force", forms.second},
                                            {"integrator", "predictor_corrector"},
                                            {"time_step", shortest(0.04 / steps)}},
                                           14, 0.2);
    scene.kinematic_viscosity = 0;
    scene.end_time = 0.04;
    scheme.assemble(scene);
    const double kinetic = kinetic_energy(scene);
    const double start = kinetic + scene.elastic_energy(scene);
    while (scene.time < scene.end_time) {
        advance(scene);
    }
    EXPECT_EQ(scene.step, steps);
    return (kinetic_energy(scene) + scene.elastic_energy(scene) - start) / kinetic;
}

/// Drifts for time steps that are halved each time.
std::vector<double> energy_drifts(const Forms& forms) {
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1); // 196 particles are no work for two
    std::vector<double> drifts;
    std::printf("%-13s %-22s", forms.first.c_str(), forms.second.c_str());
    for (const int steps : {40, 80, 160, 320}) {
        drifts.push_back(energy_drift(forms, steps));
        std::printf(" %11.3e", drifts.back());
    }
    std::printf("\n");
    omp_set_num_threads(threads);
    return drifts;
}

TEST(Energy, DriftVanishesWithTheSquareOfTheTimeStepForVariationalPairs) {
    for (const Forms& forms : variational) {
        SCOPED_TRACE(forms.first + " " + forms.second);
        const std::vector<double> drift = energy_drifts(forms);
        for (std::size_t k = 1; k < drift.size(); ++k) {
            EXPECT_NEAR(std::log2(drift[k - 1] / drift[k]), 2, 0.25);
        }
        EXPECT_NEAR(std::log2(drift[2] / drift[3]), 2, 0.1);
    }
}

TEST(Energy, DriftTendsToAConstantForOtherPairs) {
    const double variational_drift = std::abs(energy_drifts({"sigma_2", "sigma_2"}).back());
    for (const Forms& forms :
         {Forms{"sigma_2", "sigma_1"}, Forms{"sigma_1", "sigma_2"}, Forms{"sigma_2", "renormalised_coherent"},
          Forms{"renormalised", "renormalised"}, Forms{"renormalised", "taylor"}}) {
        SCOPED_TRACE(forms.first + " " + forms.second);
        const std::vector<double> drift = energy_drifts(forms);
        EXPECT_NEAR(drift[3], drift[2], 0.01 * std::abs(drift[3]));
        EXPECT_GT(std::abs(drift[3]), 100 * variational_drift);
    }
}

} // namespace
} // namespace sphvv::solver
