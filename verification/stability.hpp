#pragma once

#include "sphvv/verification/case.hpp"
#include "sphvv/verification/lattice_scene.hpp"
#include "sphvv/verification/provenance.hpp"
#include "sphvv/verification/von_neumann.hpp"

#include <nlohmann/json.hpp>

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Largest stable time steps, found by bisection with the solver and held against linear theory, and maps of
/// stability over two parameters.
namespace sphvv::verification {

/// What bounds the step, and the published bound.
enum class Limit {
    acoustic,  ///< 0.4 h/c0, without viscosity
    viscous,   ///< 0.125 h^2/nu, where viscosity rules
    advective, ///< 0.2 h/U, in a stream of the speed U, without viscosity
    strained,  ///< the same in Taylor-Green vortices (strained_flow.hpp)
    force      ///< 0.25 sqrt(h/f), in free fall, f H = U^2 with the side H of the box, without viscosity
};
std::string_view to_string(Limit limit);

/// The state that the lattice sums take for a scene; nothing for a scheme, or a form of its sums, that they
/// do not cover: then theory is the linearised step. Throws UserError for a scheme that there is not.
std::optional<LatticeState> lattice_state(const LatticeScene& scene);
Stepping stepping_of(const LatticeScene& scene);

constexpr int steps_of_a_part = 200;

/// What a disturbance of the velocities, at random by 1e-8 of the sound speed or 1e-6 of U (1e-4 of U where
/// the density is summed, whose rounding is noise), does in three parts of so many steps of dt (s): it grows
/// where the largest energy of some wave vector in the last part is more than twice that in the part before,
/// or where the run ends. In a lattice of an incompressible scheme that moves, the positions are disturbed,
/// by 1e-6 dx: a velocity that stays what it is would displace particles more and more, which is no growth.
struct Disturbance {
    bool grows;
    double growth; ///< factor in amplitude per step, of the k that grows most; infinite if the run ended
    std::string diagnosis; ///< of a run that ended
};
Disturbance disturb(const LatticeScene& scene, double dt, int part = steps_of_a_part);

/// Two swept parameters.
enum class MapAxes {
    none,    ///< limits in place of a map
    step,    ///< h/dx from 1 to 2, and the time step
    tensile, ///< h/dx from 1 to 2, and pressures of both signs
    pairing  ///< h/dx from 1 to 3, and positive pressures
};

/// Limits that the project determines, over kernels, h/dx, background pressure and integrators.
struct StabilityStudy {
    std::string name;
    Tier tier;
    std::string summary;
    std::string source;
    double cost; ///< s: the budget, processor time
    Limit limit;
    std::vector<std::string> schemes; ///< variants, kernel and h/dx among their settings
    MapAxes map = MapAxes::none;      ///< growth over two parameters, in place of limits
    int n = 16;                       ///< particles along a side of the box
    int part = steps_of_a_part;       ///< of the runs of a map
};
std::span<const StabilityStudy> stability_studies();

/// Throws UserError if a study cannot take that scheme.
void check_scheme(const StabilityStudy& study, const std::string& scheme);

struct StabilityLimit {
    std::string study;
    std::string scheme;
    std::string kernel;
    double h_over_dx;
    std::string limit;
    double published;      ///< s: the published bound
    std::string theory_by; ///< "lattice sums", "linearised step" or "fold"
    double theory;         ///< largest stable step over the published bound
    double measured;       ///< the same, by bisection to 0.5 %; infinite if none was found up to 40
    double low;            ///< measured over theory must lie between this
    double high;           ///< and that
    std::string verdict;
    std::string reason;
    int runs;
    double seconds;
};

/// Growth per step over two parameters; values row by row, y by y.
struct StabilityMap {
    std::string study;
    std::string scheme;
    std::string x_name;
    std::vector<double> x;
    std::string y_name;
    std::vector<double> y;
    std::vector<double> theory;   ///< growth factor per step
    std::vector<double> measured; ///< the same; 1 where nothing grows
    std::vector<std::uint8_t> grows;
    std::string criterion;                  ///< of the kernel alone, beside theory; "" where there is none
    std::vector<std::uint8_t> by_criterion; ///< 1 where it says unstable
    int disagreements;                      ///< points on whose stability theory and run differ
    int undecided;                          ///< points where theory grows more slowly than a run can tell
    std::string verdict;
    std::string reason;
    double seconds;
    int part = steps_of_a_part; ///< a run has three
};

struct StabilityResults {
    std::vector<StabilityLimit> limits;
    std::vector<StabilityMap> maps;
};

/// Told what runs, and the share of the study that is done.
using StabilityProgress = std::function<void(const std::string& what, double fraction)>;

/// Runs one study, for these schemes in place of its own if there are any.
StabilityResults run_stability(const StabilityStudy& study, std::span<const std::string> schemes,
                               const StabilityProgress& progress = {});

/// PASS within the band of the row: 5 % where theory is exact, for a lattice and a small disturbance (the
/// bisection ends at 0.5 %, and the growth over 200 steps tells 1.0017 from 1); between the published bound
/// and the fold in a strained flow.
void judge(StabilityLimit& limit);
void judge(StabilityMap& map);

std::string markdown(const StabilityResults& results);
/// Adds `stability_limits` and `stability_maps` (reports/FORMAT.md).
void add_to_document(const StabilityResults& results, nlohmann::ordered_json& document);
/// 1 if a verdict failed.
int exit_status(const StabilityResults& results);

} // namespace sphvv::verification
