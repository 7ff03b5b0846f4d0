#pragma once

#include "sphvv/verification/case.hpp"
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
    acoustic, ///< 0.4 h/c0, without viscosity
    viscous   ///< 0.125 h^2/nu, where viscosity rules
};
std::string_view to_string(Limit limit);

/// One lattice at rest and how it is stepped: a periodic box of 16 by 16 particles of a unit square with
/// density 1 whose velocities are disturbed at random by 1e-8 of the sound speed, or 1e-6 of U.
struct LatticeScene {
    std::string scheme;      ///< a variant, as variant_of() reads it
    double sound_speed = 10; ///< m/s, of a compressible scheme
    double viscosity = 0;    ///< m2/s
    std::optional<double>
        pressure{}; ///< Pa, of the undisturbed state; none: the scheme's background pressure
};

/// The state that theory takes for it. Throws UserError for a scheme, or a form of its sums, that the theory
/// does not cover.
LatticeState lattice_state(const LatticeScene& scene);
Stepping stepping_of(const LatticeScene& scene);

/// What a disturbance does in 600 steps of dt (s): it grows where the largest energy of some wave vector in
/// the last 200 is more than twice that in the 200 before, or where the run ends.
struct Disturbance {
    bool grows;
    double growth; ///< factor in amplitude per step, of the k that grows most; infinite if the run ended
    std::string diagnosis; ///< of a run that ended
};
Disturbance disturb(const LatticeScene& scene, double dt);

/// Limits that the project determines, over kernels, h/dx and integrators.
struct StabilityStudy {
    std::string name;
    Tier tier;
    std::string summary;
    std::string source;
    std::string cost;
    Limit limit;
    std::vector<std::string> schemes; ///< variants, kernel and h/dx among their settings
    bool map = false; ///< growth over h/dx and dt (or, for `tensile`, pressure) in place of limits
    bool tensile = false;
};
std::span<const StabilityStudy> stability_studies();

struct StabilityLimit {
    std::string study;
    std::string scheme;
    std::string kernel;
    double h_over_dx;
    std::string limit;
    double published; ///< s: the published bound
    double theory;    ///< largest stable step over the published bound
    double measured;  ///< the same, by bisection to 0.5 %; infinite if none was found up to 40
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
    int disagreements; ///< points on whose stability theory and run differ
    int undecided;     ///< points where theory grows more slowly than a run can tell
    std::string verdict;
    std::string reason;
    double seconds;
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

/// PASS within 5 %: the theory is exact for a lattice and a small disturbance; the bisection ends at 0.5 %,
/// and the growth over 200 steps tells 1.0017 from 1.
void judge(StabilityLimit& limit);
void judge(StabilityMap& map);

std::string markdown(const StabilityResults& results);
/// Adds `stability_limits` and `stability_maps` (reports/FORMAT.md).
void add_to_document(const StabilityResults& results, nlohmann::ordered_json& document);
/// 1 if a verdict failed.
int exit_status(const StabilityResults& results);

} // namespace sphvv::verification
