// The implicit viscous step of the projections: against dense algebra, against the symbol of the operator on
// a lattice, and what it does to steps, momentum, energy and refusals.
//   solver_implicit_viscosity --gtest_filter='*Dense*'
#include "sphvv/solver/boundaries/shapes/plane.hpp"
#include "sphvv/solver/operators/row.hpp"
#include "sphvv/solver/tests/scenes.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <functional>
#include <numeric>

namespace sphvv::solver {
namespace {

using namespace scenes;
using shapes::plane;

Assignments implicit(Assignments more = {}) {
    more.insert({{"viscous_step", "implicit"},
                 {"viscous_tolerance", "1e-13"},
                 {"kernel", "quintic_spline"},
                 {"h_over_dx", "1.2"}});
    return more;
}

template <int Dim>
Vector<Dim> at(const Field& field, std::size_t i) {
    Vector<Dim> v;
    for (int d = 0; d < Dim; ++d) {
        v[d] = field[d][i];
    }
    return v;
}

/// Runs the first step up to u*, which is then in velocity_next.
template <int Dim>
void form_u_star(Simulation<Dim>& scene) {
    scene.in_step = true;
    scene.step = 1;
    for (Stage<Dim>& stage : scene.stages) {
        stage.run(scene);
        if (stage.name == "viscosity") {
            return;
        }
    }
    FAIL() << "no viscous stage";
}

/// What u* at a place is in terms of the unknowns: map of those of a particle, and an offset.
template <int Dim>
struct Value {
    int particle;
    Vector<Dim> place;
    Matrix<Dim> map;
    Vector<Dim> offset;
};

/// The particles, and their images in each wall in turn, those of images with them. At a wall u* is the
/// wall's, plus what the wall's pressure takes off, n.f dt along n: all of it without slip, its component
/// along n with free slip.
template <int Dim>
std::vector<Value<Dim>> values_and_images(const Simulation<Dim>& s, double dt) {
    std::vector<Value<Dim>> all;
    for (std::size_t i = 0; i < s.particles.size(); ++i) {
        all.push_back({static_cast<int>(i), at<Dim>(s.particles.position, i), Matrix<Dim>::Identity(),
                       Vector<Dim>::Zero()});
    }
    const Eigen::Map<const Vector<Dim>> f(s.body_force.data());
    for (const Wall<Dim>& wall : s.walls) {
        const std::size_t earlier = all.size();
        for (std::size_t k = 0; k < earlier; ++k) {
            const Value<Dim> of = all[k];
            const Vector<Dim> n = wall.normal(of.place);
            const double distance = wall.distance(of.place);
            if (std::abs(distance) >= s.neighbours.support_radius()) {
                continue;
            }
            const Vector<Dim> place = of.place - 2 * distance * n;
            const Vector<Dim> wanted = wall.velocity(place, 0) + dt * f.dot(n) * n;
            const Matrix<Dim> projector = n * n.transpose();
            const Matrix<Dim> fixed =
                wall.slip == Slip::no_slip ? Matrix<Dim>(Matrix<Dim>::Identity()) : projector;
            const Matrix<Dim> reflection = Matrix<Dim>::Identity() - 2 * fixed;
            all.push_back(
                {of.particle, place, reflection * of.map, reflection * of.offset + 2 * fixed * wanted});
        }
    }
    return all;
}

/// u* from (I - dt nu Laplacian) u* = u + dt f, all components in one dense system, with LM or LS from its
/// definition.
template <int Dim>
Eigen::VectorXd dense_u_star(const Simulation<Dim>& s, double dt, bool schwaiger) {
    const auto values = values_and_images(s, dt);
    const int count = static_cast<int>(s.particles.size());
    const double V = s.particle_mass / s.density;
    Eigen::MatrixXd A = Eigen::MatrixXd::Identity(Dim * count, Dim * count);
    Eigen::VectorXd b(Dim * count);
    for (int i = 0; i < count; ++i) {
        const Eigen::Map<const Vector<Dim>> f(s.body_force.data());
        b.segment<Dim>(Dim * i) = at<Dim>(s.particles.velocity, i) + dt * f;
        struct Pair {
            const Value<Dim>* other;
            Vector<Dim> gradW;
            double F;
        };
        std::vector<Pair> pairs;
        Vector<Dim> S = Vector<Dim>::Zero();
        Matrix<Dim> moments = Matrix<Dim>::Zero();
        for (const Value<Dim>& other : values) {
            Vector<Dim> r = values[i].place - other.place;
            for (int d = 0; d < Dim; ++d) {
                r[d] -= s.box.periodic[d] ? s.box.length(d) * std::round(r[d] / s.box.length(d)) : 0;
            }
            const double distance = r.norm();
            if (&other == &values[i] || distance >= s.kernel->support * s.smoothing_length) {
                continue;
            }
            const double slope = s.kernel->normalisation[Dim] / std::pow(s.smoothing_length, Dim + 1) *
                                 s.kernel->derivative(distance / s.smoothing_length);
            pairs.push_back({&other, slope / distance * r, slope / distance});
            S += V * pairs.back().gradW;
            moments -= V * r * pairs.back().gradW.transpose();
        }
        const Matrix<Dim> L = moments.inverse();
        for (const auto& [other, gradW, F] : pairs) {
            // Laplacian = sum_j weight (u_i - u_j)
            const double weight =
                schwaiger ? L.trace() / Dim * V * (2 * F + 2 * (L * gradW).dot(S)) : 2 * V * F;
            const double share = dt * s.kinematic_viscosity * weight;
            A.block<Dim, Dim>(Dim * i, Dim * i) -= share * Matrix<Dim>::Identity();
            A.block<Dim, Dim>(Dim * i, Dim * other->particle) += share * other->map;
            b.segment<Dim>(Dim * i) -= share * other->offset;
        }
    }
    return A.partialPivLu().solve(b);
}

struct Laplacians {
    const char* words;
    Assignments given;
    bool schwaiger;
};

const std::array laplacians{
    Laplacians{"LM", {}, false}, Laplacians{"LS", {{"laplacian", "schwaiger"}}, true},
    Laplacians{"LM beside LS", {{"laplacian", "schwaiger"}, {"viscosity", "morris"}}, false},
    Laplacians{"LM, Jacobi", {{"preconditioner", "jacobi"}}, false}};

/// Boxes that are periodic, or walled by planes normal to the y axis, or to both: at rest, moving along
/// themselves, and one with free slip.
enum class Walls { none, two, four };

Simulation<2> box_scene(Walls walls, const Assignments& given) {
    Simulation<2> scene = flowing_scene<2>(schemes::find("isph_lee"), given, 11, 0.2);
    scene.density = 3;
    scene.particle_mass *= 3;
    scene.kinematic_viscosity = 0.7;
    scene.body_force = {0.9, -2};
    if (walls == Walls::none) {
        return scene;
    }
    for (std::size_t i = 0; i < scene.particles.size(); ++i) { // jitter took some through the walls
        for (int d = walls == Walls::two ? 1 : 0; d < 2; ++d) {
            double& x = scene.particles.position[d][i];
            x = std::clamp(x, 0.02, 0.98);
        }
    }
    scene.box.periodic[1] = false;
    scene.walls = {plane<2>("bed", {0, 0}, {0, 1}, Slip::no_slip, {-0.3, 0}),
                   plane<2>("lid", {0, 1}, {0, -1}, Slip::no_slip, {1.5, 0})};
    if (walls == Walls::four) {
        scene.box.periodic[0] = false;
        scene.walls.push_back(plane<2>("left", {0, 0}, {1, 0}, Slip::free_slip));
        scene.walls.push_back(plane<2>("right", {1, 0}, {-1, 0}, Slip::no_slip, {0, 0.4}));
    }
    return scene;
}

TEST(TheImplicitStep, AgreesWithADenseSolve) {
    for (const Walls walls : {Walls::none, Walls::two, Walls::four}) {
        for (const auto& [words, given, schwaiger] : laplacians) {
            SCOPED_TRACE(std::string(words) + ", walls " + std::to_string(2 * static_cast<int>(walls)));
            Assignments all = implicit(given);
            all["time_step"] = "0.02"; // 1.2 h^2/nu
            Simulation<2> scene = box_scene(walls, all);
            schemes::find("isph_lee").assemble(scene);
            form_u_star(scene);
            EXPECT_EQ(scene.images.empty(), walls == Walls::none);
            const Eigen::VectorXd expected = dense_u_star<2>(scene, scene.time_step, schwaiger);
            const Field& found = *scene.particles.find("velocity_next");
            double largest = 0;
            for (std::size_t i = 0; i < scene.particles.size(); ++i) {
                const Vector<2> off = at<2>(found, i) - expected.segment<2>(2 * static_cast<int>(i));
                largest = std::max(largest, off.norm());
            }
            EXPECT_LT(largest, 1e-10);
        }
    }
}

/// sum_j 2 V F_ij (cos k.r_ij - 1), of a lattice: minus the eigenvalue of LM at the wave k. By the symmetry
/// of the lattice sum_j gradW_ij = 0 and L is a multiple of the identity: LS is (tr L/dim) times it.
template <int Dim>
double lattice_symbol(const Simulation<Dim>& scene, const Vector<Dim>& k, bool schwaiger) {
    Points<Dim> points;
    for (int d = 0; d < Dim; ++d) {
        points[d] = scene.particles.position.components[d];
    }
    const double V = scene.particle_mass / scene.density;
    const auto row = all_neighbours<Dim>(scene.box, points, *scene.kernel, scene.smoothing_length).front();
    double symbol = 0;
    double moment = 0; // of r_x dW/dx
    for (const auto& pair : row) {
        symbol += 2 * V * pair.F * (std::cos(k.dot(Eigen::Map<const Vector<Dim>>(pair.r.data()))) - 1);
        moment -= V * pair.r[0] * pair.gradW[0];
    }
    return schwaiger ? symbol / moment : symbol;
}

// Backward Euler takes a mode by 1/(1 + dt nu lambda_k), however long the step.
TEST(TheImplicitStep, DampsAWaveOfTheLatticeByItsSymbol) {
    in_2d_and_3d([&](auto dimension) {
        constexpr int Dim = dimension;
        for (const auto& [words, given, schwaiger] : laplacians) {
            for (const char* step : {"1e-3", "0.3", "100"}) {
                for (const int wave : {1, 2, 4}) {
                    SCOPED_TRACE(std::string(words) + ", dt " + step + ", wave " + std::to_string(wave));
                    Assignments all = implicit(given);
                    all["time_step"] = step;
                    constexpr int n = Dim == 2 ? 12 : 8;
                    Simulation<Dim> scene = still_scene<Dim>(schemes::find("isph_lee"), all, n);
                    scene.kinematic_viscosity = 0.4;
                    scene.end_time = 1000;
                    Vector<Dim> k = Vector<Dim>::Zero();
                    k[0] = 2 * pi * wave;
                    k[Dim - 1] = Dim == 2 ? 2 * pi : -2 * pi;
                    std::vector<double> start(scene.particles.size());
                    for (std::size_t i = 0; i < scene.particles.size(); ++i) {
                        scene.particles.velocity[1][i] =
                            std::cos(k.dot(at<Dim>(scene.particles.position, i)) + 0.3);
                        start[scene.particles.id[i]] = scene.particles.velocity[1][i];
                    }
                    const double lambda = lattice_symbol<Dim>(scene, k, schwaiger);
                    schemes::find("isph_lee").assemble(scene);
                    form_u_star(scene);
                    const Field& found = *scene.particles.find("velocity_next");
                    const double factor = 1 / (1 + scene.time_step * 0.4 * lambda);
                    EXPECT_GT(lambda, 0);
                    for (std::size_t i = 0; i < scene.particles.size(); ++i) {
                        ASSERT_NEAR(found[1][i], factor * start[scene.particles.id[i]], 1e-11);
                        ASSERT_EQ(found[0][i], 0);
                    }
                }
            }
        }
    });
}

// dt = 1e4 h^2/nu: the explicit step multiplies the shortest waves by thousands, the implicit one leaves
// 1/(1 + dt nu k^2) of a flow of one wave length, and no step adds energy. (Of the schemes that do not move
// the velocity by a density error.) What is uniform is not damped: the start has no mean.
TEST(TheImplicitStep, TakesEnergyAtAnyStep) {
    for (const char* name : {"isph_df", "isph_dfs", "isph_dfdi", "isph_lee"}) {
        for (const bool is_implicit : {true, false}) {
            SCOPED_TRACE(std::string(name) + (is_implicit ? " implicit" : " explicit"));
            constexpr double step = 0.002;
            Assignments given{{"h_over_dx", "1.3"}, {"time_step", shortest(step)}};
            given["viscous_step"] = is_implicit ? "implicit" : "explicit";
            const Scheme& scheme = schemes::find(name);
            Simulation<2> scene = flowing_scene<2>(scheme, given, 16, 0.1);
            for (auto& component : scene.particles.velocity.components) {
                const double mean = std::accumulate(component.begin(), component.end(), 0.0) / 256;
                std::ranges::for_each(component, [&](double& u) { u -= mean; });
            }
            const double h = scene.smoothing_length;
            scene.kinematic_viscosity = 1e4 * h * h / step;
            scheme.assemble(scene);
            const double start = kinetic_energy(scene);
            advance(scene);
            double before = kinetic_energy(scene);
            if (!is_implicit) {
                EXPECT_GT(before, 1e3 * start);
                continue;
            }
            // isph_dfdi takes two steps of dt/2. The Laplacian of a coarse lattice is right to a fifth.
            const double least = 0.8 * step * scene.kinematic_viscosity * 8 * pi * pi;
            EXPECT_LT(before, start / (least * least));
            for (int more = 0; more < 3; ++more) {
                advance(scene);
                EXPECT_LE(kinetic_energy(scene), before * (1 + 1e-12));
                before = kinetic_energy(scene);
            }
        }
    }
}

// The mean of u* is that of u + dt f to round-off, whatever the tolerance of the solver; so is the momentum.
TEST(TheImplicitStep, KeepsTheMomentumAtACoarseTolerance) {
    in_2d_and_3d([&](auto dimension) {
        constexpr int Dim = dimension;
        Assignments given = implicit({{"time_step", "0.01"}});
        given["viscous_tolerance"] = "0.01";
        const Scheme& scheme = schemes::find("isph_lee");
        Simulation<Dim> scene = flowing_scene<Dim>(scheme, given, Dim == 2 ? 16 : 9, 0.2);
        scene.kinematic_viscosity = 1;
        scene.particles.velocity[0][3] += 0.5;
        scene.body_force[1] = 0.25;
        scheme.assemble(scene);
        const std::array<double, Dim> start = momentum(scene);
        for (int step = 0; step < 10; ++step) {
            advance(scene);
        }
        const std::array<double, Dim> end = momentum(scene);
        EXPECT_GT(scene.work.solver_iterations, 0);
        for (int d = 0; d < Dim; ++d) { // of a mass of 1
            EXPECT_NEAR(end[d], start[d] + scene.body_force[d] * scene.time, 1e-14);
        }
    });
}

// Gravity along the normals of walls without slip: u* = dt g everywhere, which the pressure takes off again,
// and no layer of u* forms at the walls. In the two halves of isph_dfdi, too.
TEST(TheImplicitStep, LeavesAFluidAtRestUnderItsWeight) {
    for (const char* name : {"isph_df", "isph_dfdi", "isph_lee"}) {
        SCOPED_TRACE(name);
        Assignments given = implicit({{"time_step", "0.02"}, {"density_tolerance", "1"}});
        if (std::string(name) != "isph_dfdi") {
            given.erase("density_tolerance");
        }
        const Scheme& scheme = schemes::find(name);
        Simulation<2> scene = still_scene<2>(scheme, given, 12);
        scene.kinematic_viscosity = 1;
        scene.body_force = {0, -10};
        scene.box.periodic[1] = false;
        scene.walls = {plane<2>("bed", {0, 0}, {0, 1}, Slip::no_slip),
                       plane<2>("lid", {0, 1}, {0, -1}, Slip::no_slip)};
        scheme.assemble(scene);
        form_u_star(scene);
        const bool halved = std::string(name) == "isph_dfdi";
        const Field& u_star = halved ? scene.particles.velocity : *scene.particles.find("velocity_next");
        for (std::size_t i = 0; i < scene.particles.size(); ++i) {
            EXPECT_NEAR(u_star[1][i], halved ? -0.1 : -0.2, 1e-12);
            EXPECT_NEAR(u_star[0][i], 0, 1e-12);
        }
    }
}

// The steady flow between walls is reached in a few long steps, and is that of the operator: the one to
// which short explicit steps lead.
TEST(TheImplicitStep, FindsTheSteadyFlowOfTheExplicitOne) {
    const auto steady = [](Assignments given) {
        given["laplacian"] = "schwaiger";
        const Scheme& scheme = schemes::find("isph_lee");
        Simulation<2> scene = still_scene<2>(scheme, given, 9);
        scene.kinematic_viscosity = 100;
        scene.body_force = {8, 0};
        scene.end_time = 0.05; // five times L^2/nu: exp(-5 pi^2) of the start is left
        scene.box.periodic[1] = false;
        scene.walls = {plane<2>("bed", {0, 0}, {0, 1}, Slip::no_slip),
                       plane<2>("lid", {0, 1}, {0, -1}, Slip::no_slip)};
        scheme.assemble(scene);
        while (scene.time < scene.end_time) {
            advance(scene);
        }
        std::vector<double> u(scene.particles.size());
        for (std::size_t i = 0; i < u.size(); ++i) {
            u[scene.particles.id[i]] = scene.particles.velocity[0][i];
        }
        return std::pair(u, scene.step);
    };
    const auto [by_explicit, many] = steady({{"h_over_dx", "1.2"}, {"kernel", "quintic_spline"}});
    const auto [by_implicit, few] = steady(implicit({{"time_step", "0.005"}}));
    EXPECT_EQ(few, 10); // (1 + dt nu pi^2/L^2)^-10 = 3e-8
    EXPECT_GT(many, 1000);
    for (std::size_t i = 0; i < by_explicit.size(); ++i) {
        EXPECT_NEAR(by_implicit[i], by_explicit[i], 1e-7 * 0.01) << "of f L^2/8 nu = 0.01 in the middle";
    }
}

// Without viscosity there is nothing to solve.
TEST(TheImplicitStep, IsNoneWithoutViscosity) {
    const auto run = [](const char* step) {
        const Scheme& scheme = schemes::find("isph_dfs");
        Simulation<2> scene = flowing_scene<2>(scheme, {{"viscous_step", step}}, 12, 0.1);
        scene.kinematic_viscosity = 0;
        scheme.assemble(scene);
        advance(scene);
        return scene;
    };
    const auto one = run("explicit");
    const auto other = run("implicit");
    EXPECT_EQ(one.work.matrix_entries, other.work.matrix_entries);
    EXPECT_EQ(one.work.solver_iterations, other.work.solver_iterations);
    EXPECT_EQ(one.particles.velocity.components, other.particles.velocity.components);
    EXPECT_EQ(one.time_step, other.time_step);
}

TEST(TheImplicitStep, HasALimitOfItsOwn) {
    constexpr double h = 1.3 / 16;
    const auto step = [](double nu, Assignments given) {
        given["h_over_dx"] = "1.3";
        Simulation<2> scene = still_scene<2>(schemes::find("isph_df"), given, 16);
        scene.kinematic_viscosity = nu;
        scene.reference_speed = 0.1;
        schemes::find("isph_df").assemble(scene);
        advance(scene);
        return scene.time_step;
    };
    const double advective = even(1, 0.2 * h / 0.1);
    EXPECT_DOUBLE_EQ(step(0.7, {{"viscous_step", "implicit"}}), advective);
    EXPECT_DOUBLE_EQ(step(0.7, {{"viscous_step", "implicit"}, {"viscous_limit", "0.03"}}), advective);
    EXPECT_DOUBLE_EQ(step(0.7, {{"viscous_step", "implicit"}, {"implicit_viscous_limit", "5"}}),
                     even(1, 5 * h * h / 0.7));
    EXPECT_DOUBLE_EQ(step(0.7, {{"implicit_viscous_limit", "5"}}), even(1, 0.2 * h * h / 0.7));
}

/// What assembling a scene is refused with.
std::string refusal(const Assignments& given, const std::function<void(Simulation<2>&)>& change) {
    Assignments all = given;
    all["viscous_step"] = "implicit";
    const Scheme& scheme = schemes::find("isph_df");
    Simulation<2> scene = still_scene<2>(scheme, all, 12);
    change(scene);
    try {
        scheme.assemble(scene);
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

void add_surface(Simulation<2>& scene) {
    scene.box.periodic[1] = false;
    const Detector& detector = free_surface::find("covered_ball");
    scene.free_surface = FreeSurface{&detector, detector.threshold(2, 3.9)};
}

void add_wall(Simulation<2>& scene, const Vector<2>& normal, Slip slip, WallMethod method) {
    scene.box.periodic = {false, false};
    scene.walls = {plane<2>("slope", {0, 0}, normal, slip)};
    scene.wall_method = method;
}

TEST(TheImplicitStep, RefusesWhatItDoesNotCover) {
    const auto nothing = [](Simulation<2>&) {};
    const auto on = [](const Vector<2>& normal, Slip slip, WallMethod method) {
        return [=](Simulation<2>& scene) { add_wall(scene, normal, slip, method); };
    };
    const double slope = std::sqrt(0.5);
    struct Case {
        Assignments given;
        std::function<void(Simulation<2>&)> change;
        std::vector<std::string> words; ///< of the sentence; none: it is accepted
    };
    const std::array cases{
        Case{{{"viscosity", "monaghan_cleary"}},
             nothing,
             {"viscosity=monaghan_cleary", "viscosity=laplacian or morris"}},
        Case{{{"viscosity", "morris"}, {"surface_peclet", "30"}},
             add_surface,
             {"surface_peclet=30", "surface_peclet=0"}},
        Case{{{"viscosity", "morris"}, {"surface_peclet", "30"}},
             [](Simulation<2>& scene) {
                 add_surface(scene);
                 scene.kinematic_viscosity = 0;
             },
             {"surface_peclet=30"}},
        Case{{{"laplacian", "schwaiger"}}, add_surface, {"LS", "viscosity=morris"}},
        Case{{}, on({0, 1}, Slip::no_slip, WallMethod::dummy), {"wall_method=mirror"}},
        Case{{}, on({slope, slope}, Slip::free_slip, WallMethod::mirror), {"slope", "free slip"}},
        Case{{}, on({slope, slope}, Slip::no_slip, WallMethod::mirror), {}},
        Case{{}, on({0, 1}, Slip::free_slip, WallMethod::mirror), {}},
        Case{{{"laplacian", "schwaiger"}, {"viscosity", "morris"}}, add_surface, {}},
        Case{{{"viscosity", "monaghan_cleary"}},
             [](Simulation<2>& scene) { scene.kinematic_viscosity = 0; },
             {}}};
    for (const Case& c : cases) {
        const std::string sentence = refusal(c.given, c.change);
        EXPECT_EQ(sentence.empty(), c.words.empty()) << sentence;
        for (const std::string& word : c.words) {
            EXPECT_NE(sentence.find(word), std::string::npos) << sentence;
        }
        EXPECT_EQ(sentence.find("viscous_step=implicit") == 0, !c.words.empty()) << sentence;
        EXPECT_EQ(sentence.ends_with("viscous_step=explicit"), !c.words.empty()) << sentence;
    }
}

// A free surface is where the symmetric sum ends: no stress, so that a uniform flow stays one, and the
// momentum that of the body force.
TEST(TheImplicitStep, HasNoStressAtAFreeSurface) {
    Assignments given = implicit({{"time_step", "0.01"}});
    Simulation<2> scene = still_scene<2>(schemes::find("isph_lee"), given, 14, 0.1);
    scene.kinematic_viscosity = 3;
    scene.body_force = {0.6, 0};
    add_surface(scene);
    for (std::size_t i = 0; i < scene.particles.size(); ++i) {
        scene.particles.position[1][i] = std::clamp(scene.particles.position[1][i], 0.01, 0.99);
        scene.particles.velocity[0][i] = 0.8;
    }
    schemes::find("isph_lee").assemble(scene);
    form_u_star(scene);
    const Field& u_star = *scene.particles.find("velocity_next");
    for (std::size_t i = 0; i < scene.particles.size(); ++i) {
        EXPECT_NEAR(u_star[0][i], 0.806, 1e-12);
    }
}

} // namespace
} // namespace sphvv::solver
