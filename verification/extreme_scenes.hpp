#pragma once

#include "sphvv/solver/schemes.hpp"
#include "sphvv/solver/simulation.hpp"
#include "sphvv/verification/extreme.hpp"
#include "sphvv/verification/scene.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sphvv::verification {

/// Rows that share an edge. One file in verification/extreme_scenes/ defines one.
struct ExtremeScenes {
    std::string_view name;
    std::string_view summary;
    std::vector<ExtremeRow> (*rows)();
};

/// What the files of verification/extreme_scenes/ are made of.
namespace extreme_scenes {

/// Every file in verification/extreme_scenes/, in the order of the file names.
std::span<const ExtremeScenes* const> all();

using Point = std::array<double, 2>;
using Simulation = solver::Simulation<2>;

inline constexpr double round_off = 1e-12;      ///< of positions of the size of a metre, over a short run
inline constexpr double machine = 0x1p-53;      ///< relative error of one operation
inline constexpr double gravity = 10;           ///< m/s2
inline constexpr int neighbours_of_a_disc = 44; ///< of a particle of a square lattice, within 3.9 dx

/// A scene given particle by particle. Lengths in m, velocities in m/s, pressures in Pa.
struct PointScene {
    std::vector<Point> places;
    std::vector<Point> velocities;
    std::vector<double> pressures{}; ///< 0 if left out
    solver::Box<2> box{{-500, -500}, {500, 500}, {false, false}};
    std::vector<solver::Wall<2>> walls{};
    bool free_surface = true;
    double dx = 0.02;
    double density = 1000;
    double viscosity = 1e-3;
    double speed = 1;        ///< the largest that is expected
    double time_step = 1e-3; ///< s
    Point body_force{};
    solver::Assignments settings{}; ///< for the schemes that have such keys
};

/// The scene, ready to be stepped by this scheme (a variant).
Simulation simulate(const std::string& scheme, const PointScene& scene);

/// The keys that keep a comparison of two runs free of what solver and scheme do at random: a solved pressure
/// to 1e-12, no shift_disorder.
solver::Assignments exact_settings();

/// Steps it so often; the error is measured where it survives.
ExtremeOutcome advance_and_measure(Simulation& s, int steps,
                                   const std::function<double(const Simulation&)>& measure);

/// Velocity, place or pressure of the fluid by identity.
std::vector<Point> places_of(const Simulation& s);
std::vector<Point> velocities_of(const Simulation& s);
std::vector<double> pressures_of(const Simulation& s);

/// The largest distance of two lists, and NaN where one is not a number.
double largest_difference(const std::vector<Point>& a, const std::vector<Point>& b);

/// From -1 to 1, the same with every standard library, of a seed and a rank.
class Uniform {
public:
    explicit Uniform(std::uint64_t seed) : state_(seed) {}
    double operator()();

private:
    std::uint64_t state_;
};

/// The middles of columns by rows cells from this corner on.
std::vector<Point> block(int columns, int rows, double dx, const Point& corner);

/// A case of the harness; the error is the relative L2 one of the velocity. Throws std::runtime_error beyond
/// 20 000 steps, so that no row can hang.
ExtremeOutcome run_case(const char* flow, const std::string& scheme, const solver::Assignments& settings,
                        int n);

/// Every scheme by its name.
std::vector<std::string> scheme_names();
bool conserves_momentum(const std::string& scheme);
/// Particles move with the new velocity, not with the mean of old and new: under a constant acceleration g
/// they are off by g t dt/2.
bool moves_with_new_velocity(const std::string& scheme);
/// Quadratic moving least squares: it needs as many neighbours as a polynomial has coefficients.
bool needs_polynomial(const std::string& scheme);
/// Whether the scheme knows what p = 0 on a surface is.
bool has_free_surface(const std::string& scheme);
/// Why isph_di and isph_dfdi fail a row with a free surface; what the scheme does without it is to follow.
extern const std::string cut_density;
/// How a run that grows beyond all bounds may end.
extern const std::vector<std::string> blown_up;
/// Turns a row into one of a scheme that has none: it must be refused.
void must_be_refused(ExtremeRow& row);

/// Adds a row for every scheme: make(scheme).
template <class Make>
void add_for_all(std::vector<ExtremeRow>& rows, const Make& make) {
    for (const std::string& scheme : scheme_names()) {
        rows.push_back(make(scheme));
    }
}

} // namespace extreme_scenes
} // namespace sphvv::verification
