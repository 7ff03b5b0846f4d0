#pragma once

#include "sphvv/verification/case.hpp"

/// What the turbulent channels, smooth and rough, have in common: Issa 2005 §6.1, §6.2.
namespace sphvv::verification::turbulent_channel {

/// The keys that stand for the thesis's steps: A, gradient and edge velocity imposed; B, edge velocity
/// computed; C, gradient computed, too. Step D is in every run: means over the second half of its time.
std::vector<solver::Key> keys();

/// Turbulence, wall function and driver of a scene. `function` is the wall function, with settings of its
/// own.
void prepare(const SceneRecord& scene, solver::Simulation<2>& simulation, std::string_view function,
             solver::Assignments settings);

/// Means of velocity, gradient and eddy viscosity at every particle from half of the end time on.
void add_means(const SceneRecord& scene, solver::Simulation<2>& simulation);

/// Bulk velocity and driving force.
std::vector<Measure> measures();

/// u_max + sqrt(g H), m/s: what the speed of sound is a multiple of.
double reference_speed(const SceneRecord& scene, const analytic::Values& values);

/// Claims of one channel and its ladders.
std::vector<Claim> claims(const char* id, const char* source);
/// Order 0 of the velocity where everything is exact next to the wall. Where the mean of the eddy viscosities
/// is not, the stress there is ln(dx/delta)/2 of what it should be: right at dx = e^2 delta, 54 rows of the
/// smooth channel, so that no power of dx describes the error.
std::vector<Expectation> expectations();
std::vector<Study> studies(const std::string& name);
std::map<std::string, std::string> variant_names();

} // namespace sphvv::verification::turbulent_channel
