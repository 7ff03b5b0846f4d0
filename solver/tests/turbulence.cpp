// Eddy viscosity: velocity gradients, models, viscous forces with nu_T, and its place in a time step.
//   solver_turbulence --gtest_filter='ViscousForces*'
#include "sphvv/solver/turbulence.hpp"

#include "sphvv/solver/boundaries/shapes/plane.hpp"
#include "sphvv/solver/operators/momentum_weakly_compressible.hpp"
#include "sphvv/solver/operators/renormalisation.hpp"
#include "sphvv/solver/tests/scenes.hpp"
#include "sphvv/solver/turbulence/shear_rate.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <filesystem>

namespace sphvv::solver {
namespace {

using namespace scenes;
using shapes::plane;

// Declarations.

TEST(TurbulenceModels, AreTheFilesOfTheFolder) {
    std::vector<std::string> stems;
    for (const auto& entry : std::filesystem::directory_iterator(SPHVV_SOLVER_FOLDER "/turbulence")) {
        if (entry.path().extension() == ".cpp") {
            stems.push_back(entry.path().stem().string());
        }
    }
    std::ranges::sort(stems);
    std::vector<std::string> names;
    for (const TurbulenceModel* model : turbulence::all()) {
        names.emplace_back(model->name);
        EXPECT_EQ(&turbulence::find(model->name), model);
        for (const std::string_view text : {model->summary, model->formula, model->source}) {
            EXPECT_FALSE(text.empty()) << model->name;
        }
        EXPECT_NE(model->assemble_2d, nullptr);
        EXPECT_NE(model->assemble_3d, nullptr);
    }
    EXPECT_EQ(names, stems);
    EXPECT_THROW(turbulence::find("magic"), UserError);
}

// The shear rate.

TEST(ShearRate, IsThatOfShearAndNoneOfRotation) {
    Matrix<3> shear = Matrix<3>::Zero();
    shear(0, 2) = -1.7;
    EXPECT_NEAR(turbulence::shear_rate<3>(shear), 1.7, 1e-15);
    Matrix<3> rotation;
    rotation << 0, 1, -2, -1, 0, 3, 2, -3, 0;
    EXPECT_EQ(turbulence::shear_rate<3>(rotation), 0);
    EXPECT_NEAR(turbulence::shear_rate<3>(shear + rotation), 1.7, 1e-15);
    const Matrix<3> turn =
        Eigen::AngleAxisd(0.9, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
    EXPECT_NEAR(turbulence::shear_rate<3>(turn * shear * turn.transpose()), 1.7, 1e-14);
}

// Velocity gradient and models in a step.

/// A wcsph scene with that model in a box that is not periodic, over a bed without slip in the last
/// direction: supports are cut off all round, and behind the bed lie images.
template <int Dim>
Simulation<Dim> modelled_scene(const char* model, Assignments given, int n, double disorder) {
    const Scheme& scheme = schemes::find("wcsph");
    auto scene = still_scene<Dim>(scheme, {{"time_step", "1e-4"}, {"kernel", "quartic_spline"}}, n, disorder);
    scene.box.periodic.fill(false);
    const TurbulenceModel& declared = turbulence::find(model);
    scene.turbulence = Turbulence{&declared, Settings(turbulence::keys(declared), given)};
    return scene;
}

template <int Dim>
void add_bed(Simulation<Dim>& scene) {
    Vector<Dim> up = Vector<Dim>::Zero();
    up[Dim - 1] = 1;
    scene.walls = {plane<Dim>("bed", Vector<Dim>::Zero(), up, Slip::no_slip)};
}

/// u = A x + b.
template <int Dim>
void set_linear(Simulation<Dim>& scene, const Matrix<Dim>& A, const Vector<Dim>& b) {
    for (int i = 0; i < static_cast<int>(scene.particles.size()); ++i) {
        Vector<Dim> x;
        for (int d = 0; d < Dim; ++d) {
            x[d] = scene.particles.position[d][i];
        }
        const Vector<Dim> u = A * x + b;
        for (int d = 0; d < Dim; ++d) {
            scene.particles.velocity[d][i] = u[d];
        }
    }
}

/// Runs the stages up to and with the one of that name.
template <int Dim>
void run_until(Simulation<Dim>& scene, std::string_view last) {
    for (Stage<Dim>& stage : scene.stages) {
        stage.run(scene);
        if (stage.name == last) {
            return;
        }
    }
    FAIL() << "no stage " << last;
}

template <int Dim>
Matrix<Dim> gradient_at(const Simulation<Dim>& scene, int i) {
    return turbulence::matrix_at<Dim>(*scene.particles.find("velocity_gradient"), i);
}

TEST(VelocityGradient, RenormalisedIsExactForLinearVelocities) {
    in_2d_and_3d([](auto dimension) {
        constexpr int Dim = dimension;
        auto scene = modelled_scene<Dim>("smagorinsky", {{"velocity_gradient", "renormalised"}},
                                         Dim == 2 ? 14 : 9, 0.2);
        Random random(7);
        Matrix<Dim> A;
        Vector<Dim> b;
        for (int a = 0; a < Dim; ++a) {
            b[a] = random.uniform(-1, 1);
            for (int c = 0; c < Dim; ++c) {
                A(a, c) = random.uniform(-1, 1);
            }
        }
        set_linear<Dim>(scene, A, b);
        schemes::find("wcsph").assemble(scene);
        run_until(scene, "eddy_viscosity");
        const double length = 0.1 * 2 * scene.smoothing_length;
        const double nu_T = length * length * turbulence::shear_rate<Dim>(A);
        for (int i = 0; i < static_cast<int>(scene.particles.size()); ++i) {
            EXPECT_NEAR((gradient_at(scene, i) - A).norm(), 0, 1e-11) << i;
            EXPECT_NEAR((*scene.particles.find("eddy_viscosity"))[0][i], nu_T, 1e-11 * nu_T) << i;
        }
    });
}

TEST(VelocityGradient, SolidRotationHasNoEddyViscosity) {
    auto scene = modelled_scene<2>("smagorinsky", {{"velocity_gradient", "renormalised"}}, 14, 0.2);
    Matrix<2> rotation;
    rotation << 0, -3, 3, 0;
    set_linear<2>(scene, rotation, Vector<2>(1, 2));
    schemes::find("wcsph").assemble(scene);
    run_until(scene, "eddy_viscosity");
    const double scale = std::pow(0.2 * scene.smoothing_length, 2) * 3;
    for (int i = 0; i < static_cast<int>(scene.particles.size()); ++i) {
        EXPECT_NEAR((*scene.particles.find("eddy_viscosity"))[0][i], 0, 1e-12 * scale) << i;
    }
}

// On a lattice the difference gradient inside is off by the lattice sum of the first moment alone; the last
// row below a surface sees hardly more than half of it.
TEST(VelocityGradient, DifferenceIsTheFirstMomentTimesALinearVelocity) {
    auto scene = modelled_scene<2>("smagorinsky", {{"velocity_gradient", "difference"}}, 14, 0);
    Matrix<2> A;
    A << 0, 2, 0, 0;
    set_linear<2>(scene, A, Vector<2>(0, 0));
    schemes::find("wcsph").assemble(scene);
    run_until(scene, "eddy_viscosity");
    const UniformVolume volume{scene.particle_mass / scene.density};
    for (int i = 0; i < static_cast<int>(scene.particles.size()); ++i) {
        const Matrix<2> M = first_moments<2>(scene.neighbours.row(i), volume);
        EXPECT_NEAR((gradient_at(scene, i) - A * M).norm(), 0, 1e-6) << i << ": density of the background";
        if (std::abs(scene.particles.position[0][i] - 0.5) < 0.1 &&
            std::abs(scene.particles.position[1][i] - 0.5) < 0.1) {
            EXPECT_NEAR(gradient_at(scene, i)(0, 1), 2, 2e-2);
        }
    }
}

// nu_T = kappa u* z (1 - z/H) where the law is met: u is that of a rough wall at the edge's height + z.
struct LogProfile {
    static constexpr double u_star = 0.05;
    static constexpr double kappa = 0.41;
    static constexpr double edge = 0.02;
    static constexpr double z0 = 1e-3;
    static double u(double z) { return u_star / kappa * std::log(z / z0); }
};

/// A channel with the profile: rows dx apart from a bed of wall particles on; `disorder` spacings off.
Simulation<2> log_channel(const char* velocity_gradient, double disorder) {
    constexpr int n = 20;
    auto still =
        still_scene<2>(schemes::find("wcsph"),
                       {{"time_step", "1e-4"}, {"kernel", "quartic_spline"}, {"h_over_dx", "1.5"}}, n);
    Simulation<2> scene(still.box, n * n, n);
    scene.settings = still.settings;
    scene.kernel = still.kernel;
    scene.particle_spacing = still.particle_spacing;
    scene.smoothing_length = still.smoothing_length;
    scene.density = 1;
    scene.reference_speed = 1;
    scene.particle_mass = still.particle_mass;
    scene.end_time = 1;
    scene.box.periodic[1] = false;
    scene.walls = {plane<2>("bed", {0, 0}, {0, 1}, Slip::no_slip)};
    scene.wall_method = WallMethod::dummy;
    scene.particles.field("pressure", 1, Lifetime::state, "scene");
    const TurbulenceModel& model = turbulence::find("mixing_length");
    scene.turbulence =
        Turbulence{&model, Settings(turbulence::keys(model),
                                    {{"velocity_gradient", velocity_gradient}, {"depth", "1"}})};
    const WallFunction& rough = wall_functions::find("rough");
    scene.wall_friction =
        WallFriction{&rough, Settings(wall_functions::keys(rough),
                                      {{"edge", "0.02"},
                                       {"edge_velocity", "imposed"},
                                       {"friction_velocity", "0.05"},
                                       {"roughness", shortest(LogProfile::z0 * std::exp(0.41 * 8.5))}})};
    Random random(11);
    for (int i = 0; i < n * n; ++i) {
        const bool bed = i >= n * (n - 1);
        const double noise = bed ? 0 : disorder / n;
        Vector<2> x((i % n + 0.5) / n + random.uniform(-noise, noise),
                    bed ? 0. : (i / n + 1.) / n + random.uniform(-noise, noise));
        if (bed) {
            scene.wall_particles.push_back({0, x});
        }
        for (int d = 0; d < 2; ++d) {
            scene.particles.position[d][i] = x[d];
        }
        scene.particles.velocity[0][i] = LogProfile::u(x[1] + LogProfile::edge);
    }
    schemes::find("wcsph").assemble(scene);
    return scene;
}

/// Largest |nu_T/(kappa u* z sqrt(1 - z/H)^2) - 1| over the particles in low <= z <= high.
double worst_eddy_viscosity(const Simulation<2>& scene, double low, double high) {
    double worst = 0;
    for (int i = 0; i < static_cast<int>(scene.particles.size()); ++i) {
        const double z = scene.particles.position[1][i] + LogProfile::edge;
        if (z >= low && z <= high) {
            const double expected = LogProfile::kappa * LogProfile::u_star * z * (1 - z);
            worst = std::max(worst, std::abs((*scene.particles.find("eddy_viscosity"))[0][i] / expected - 1));
        }
    }
    return worst;
}

TEST(MixingLength, OfAnImposedGradientIsTheParabola) {
    auto scene = log_channel("imposed", 0.2);
    run_until(scene, "eddy_viscosity");
    EXPECT_LT(worst_eddy_viscosity(scene, 0, 1), 1e-12);
}

TEST(MixingLength, IsExactForTheLogarithmicLawByItsOwnGradient) {
    auto scene = log_channel("logarithmic", 0);
    run_until(scene, "eddy_viscosity");
    EXPECT_LT(worst_eddy_viscosity(scene, 0, 1), 1e-9) << "the wall row and that at the surface included";
    auto jittered = log_channel("logarithmic", 0.2);
    run_until(jittered, "eddy_viscosity");
    auto straight = log_channel("renormalised", 0.2);
    run_until(straight, "eddy_viscosity");
    // On disordered particles ln z also varies along the wall as the kernel sees it; still the better one.
    EXPECT_LT(worst_eddy_viscosity(jittered, 0.06, 0.2), 0.2 * worst_eddy_viscosity(straight, 0.06, 0.2));
}

// Second derivative: a kernel gradient of ln z at z smooths over h, with an error of (h/z)^2 times a factor
// of order one (the second moment of the quartic spline over h^2 is 0.5; two thirds of 0.5/2 z^-3 over z^-1).
TEST(MixingLength, OfAGradientThatIsExactForLinearVelocitiesIsOffBySmoothing) {
    auto scene = log_channel("renormalised", 0);
    run_until(scene, "eddy_viscosity");
    const double h = scene.smoothing_length;
    EXPECT_LT(worst_eddy_viscosity(scene, 0.4, 0.7), std::pow(h / 0.4, 2));
    EXPECT_GT(worst_eddy_viscosity(scene, 0.05, 0.13), 0.2) << "the row after the first";
}

TEST(Turbulence, RefusesWhatItCannotDo) {
    auto scene = modelled_scene<2>("mixing_length", {}, 10, 0);
    EXPECT_THROW(schemes::find("wcsph").assemble(scene), UserError) << "no wall";
    auto projected = still_scene<2>(schemes::find("isph_dfs"), {}, 10);
    projected.turbulence = scene.turbulence;
    EXPECT_THROW(schemes::find("isph_dfs").assemble(projected), UserError);
    auto leaping = still_scene<2>(schemes::find("wcsph"), {{"integrator", "verlet"}}, 10);
    leaping.turbulence = scene.turbulence;
    EXPECT_THROW(schemes::find("wcsph").assemble(leaping), UserError);
}

TEST(Turbulence, IsNothingToALaminarScene) {
    auto laminar = flowing_scene<2>(schemes::find("wcsph"), {}, 10);
    schemes::find("wcsph").assemble(laminar);
    for (const char* field : {"eddy_viscosity", "velocity_gradient", "wall_distance", "edge_velocity"}) {
        EXPECT_EQ(laminar.particles.find(field), nullptr) << field;
    }
    std::vector<std::string> names;
    for (const auto& stage : laminar.stages) {
        names.push_back(stage.name);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"time_step", "neighbours", "momentum", "continuity", "drift",
                                               "equation_of_state"}));
    EXPECT_EQ(largest_viscosity(laminar), laminar.kinematic_viscosity);
}

TEST(Turbulence, LimitsTheStepByTheLargestViscosity) {
    auto scene = modelled_scene<2>("smagorinsky", {{"smagorinsky", "1"}}, 10, 0);
    scene.settings = Settings(schemes::find("wcsph").keys, {});
    Matrix<2> A;
    A << 0, 30, 0, 0;
    set_linear<2>(scene, A, Vector<2>(0, 0));
    schemes::find("wcsph").assemble(scene);
    run_until(scene, "time_step");
    const double h = scene.smoothing_length;
    const double largest = largest_viscosity(scene);
    EXPECT_GT(largest, 1);
    EXPECT_DOUBLE_EQ(scene.time_step, even(1, 0.125 * h * h / largest));
}

// Viscous forces.

/// Accelerations of all particles by one viscous force, without pressure.
template <int Dim, class ViscousForce>
std::vector<Vector<Dim>> accelerations(const Sample<Dim>& sample, const MomentumFields<Dim>& fields, double m,
                                       double mu, double eta_squared) {
    std::vector<Vector<Dim>> result(sample.count());
    for (int i = 0; i < sample.count(); ++i) {
        result[i] = momentum_weakly_compressible<Dim, pressure_forces::Sigma2, ViscousForce>(
            sample.list.row(i), i, fields, m, mu, eta_squared);
    }
    return result;
}

/// Random velocities, densities and eddy viscosities on jittered particles.
template <int Dim>
struct Disorder {
    explicit Disorder(int n)
        : sample(n, 0.3, 3, true), zero(sample.count(), 0.), eddy(sample.count()), volume(sample.count()) {
        Random random(5);
        for (auto& component : velocity) {
            component = random.values(sample.count(), -1, 1);
        }
        eddy = random.values(sample.count(), 0, 3);
        volume = random.values(sample.count(), 0.8, 1.2);
        fields = {pointers<Dim>(velocity), zero.data(), volume.data()};
        fields.eddy_viscosity = eddy.data();
    }
    Sample<Dim> sample;
    Points<Dim> velocity;
    std::vector<double> zero;
    std::vector<double> eddy;
    std::vector<double> volume;
    MomentumFields<Dim> fields;
};

template <int Dim, class Laminar, class Eddy>
void check_forces(int n) {
    Disorder<Dim> d(n);
    const double m = d.sample.volume();
    const double eta_squared = 0.01 * d.sample.h * d.sample.h;
    const auto forces = accelerations<Dim, Eddy>(d.sample, d.fields, m, 0.2, eta_squared);
    Vector<Dim> total = Vector<Dim>::Zero();
    double size = 0;
    for (const Vector<Dim>& force : forces) {
        total += force;
        size += force.norm();
    }
    EXPECT_LT(total.norm(), 1e-13 * size) << "momentum";

    std::ranges::fill(d.eddy, 0.);
    const auto without = accelerations<Dim, Eddy>(d.sample, d.fields, m, 0.2, eta_squared);
    const auto laminar = accelerations<Dim, Laminar>(d.sample, d.fields, m, 0.2, eta_squared);
    for (int i = 0; i < d.sample.count(); ++i) {
        EXPECT_NEAR((without[i] - laminar[i]).norm(), 0, 1e-12 * laminar[i].norm()) << i;
    }
    // The same viscosity from either source where the density is uniform.
    std::ranges::fill(d.volume, 1.);
    std::ranges::fill(d.eddy, 0.2);
    const auto by_eddies = accelerations<Dim, Eddy>(d.sample, d.fields, m, 0, eta_squared);
    const auto by_molecules = accelerations<Dim, Laminar>(d.sample, d.fields, m, 0.2, eta_squared);
    for (int i = 0; i < d.sample.count(); ++i) {
        EXPECT_NEAR((by_eddies[i] - by_molecules[i]).norm(), 0, 1e-12 * by_molecules[i].norm()) << i;
    }
}

TEST(ViscousForces, ConserveMomentumAndContainTheLaminarOnes) {
    using namespace viscous_forces;
    check_forces<2, Morris, MorrisEddy<ArithmeticMean>>(14);
    check_forces<2, MonaghanCleary, MonaghanClearyEddy<ArithmeticMean>>(14);
    check_forces<3, Morris, MorrisEddy<ArithmeticMean>>(8);
    check_forces<3, MonaghanCleary, MonaghanClearyEddy<ArithmeticMean>>(8);
}

/// The lattice's factor of the operator for u_x(z) linear, nu linear in z: force/(dnu/dz du/dz), at the
/// middle.
template <class Eddy>
double lattice_factor(double h_over_dx) {
    const Sample<2> sample(20, 0, 1, false, 1, h_over_dx, kernels::find("quartic_spline"));
    const int count = sample.count();
    std::vector<double> zero(count, 0.);
    std::vector<double> one(count, 1.);
    std::vector<double> u(count);
    std::vector<double> eddy(count);
    int middle = 0;
    for (int i = 0; i < count; ++i) {
        u[i] = 3 * sample.points[1][i];
        eddy[i] = 1 + 0.5 * sample.points[1][i];
        const auto off = [&](int k) {
            return std::hypot(sample.points[0][k] - 0.5, sample.points[1][k] - 0.5);
        };
        middle = off(i) < off(middle) ? i : middle;
    }
    MomentumFields<2> fields{{u.data(), zero.data()}, zero.data(), one.data()};
    fields.eddy_viscosity = eddy.data();
    const double eta_squared = 0.01 * sample.h * sample.h;
    return accelerations<2, Eddy>(sample, fields, sample.volume(), 0, eta_squared)[middle][0] / (0.5 * 3);
}

// d(nu du/dz)/dz of a linear nu and a linear u has the same sum as nu d2u/dz2 of a quadratic u, so that it is
// off by the factors nu_eff/nu of the table of §2 of Issa's sheet (quartic, lattice). The table has the
// thesis's normalisation of the kernel, 51/2000, 0.055 % above 96/1199 pi.
TEST(ViscousForces, HaveTheKnownLatticeFactorsForALinearViscosity) {
    using namespace viscous_forces;
    const double normalisation = 96 / (1199 * pi) / (51. / 2000);
    constexpr double half_a_digit = 5e-4;
    EXPECT_NEAR(lattice_factor<MonaghanClearyEddy<ArithmeticMean>>(1.5), 0.943 * normalisation, half_a_digit);
    EXPECT_NEAR(lattice_factor<MonaghanClearyEddy<ArithmeticMean>>(1.2), 0.886 * normalisation, half_a_digit);
    EXPECT_NEAR(lattice_factor<MorrisEddy<ArithmeticMean>>(1.5), 0.990 * normalisation, half_a_digit);
    EXPECT_NEAR(lattice_factor<MorrisEddy<ArithmeticMean>>(1.2), 0.994 * normalisation, half_a_digit);
}

// 2 (a - b)/ln(a/b); the series near a = b meets it, and a vanishing viscosity leaves none.
TEST(LogarithmicMean, IsThatOfTwoEddyViscosities) {
    using viscous_forces::LogarithmicMean;
    for (const double ratio : {1e-12, 1e-3, 0.3, 0.99, 0.9985, 0.9999, 1.0, 1.5, 1e6}) {
        const double a = 2e-3;
        const double b = a * ratio;
        const double exact = ratio == 1 ? 2 * a : 2 * (a - b) / std::log(a / b);
        EXPECT_NEAR(LogarithmicMean::doubled(a, Lanes{} + b)[0], exact, 1e-9 * exact) << ratio;
    }
    EXPECT_EQ(LogarithmicMean::doubled(1e-3, Lanes{})[0], 0);
    EXPECT_EQ(LogarithmicMean::doubled(0, Lanes{})[0], 0);
}

// Over a wall nu_T = kappa u* z and u = (u*/kappa) ln z: every pair then carries the stress of a linear
// profile.
TEST(LogarithmicMean, CarriesAConstantStressOverAWall) {
    using viscous_forces::ArithmeticMean;
    using viscous_forces::LogarithmicMean;
    for (const double z : {1e-3, 1e-2, 0.1}) {
        const double dz = 0.02;
        const double difference = std::log((z + dz) / z);
        const double exact = 2 * dz;
        EXPECT_NEAR(LogarithmicMean::doubled(z, Lanes{} + (z + dz))[0] * difference, exact, 1e-12);
        EXPECT_GT(ArithmeticMean::doubled(z, Lanes{} + (z + dz))[0] * difference, exact);
    }
}

} // namespace
} // namespace sphvv::solver
