#include "sphvv/verification/cases.hpp"
#include "sphvv/verification/scene.hpp"
#include "sphvv/verification/turbulent_channel.hpp"

namespace sphvv::verification::cases {

const Case& log_law_channel() {
    static const Case flow{
        .name = "log_law_channel",
        .summary = "turbulent channel with a free surface over a smooth bed, mixing length and wall function",
        .equations = "Reynolds-averaged Navier-Stokes in 2-D, eddy viscosity by a mixing length",
        .source = "Issa 2005 §6.2.2 (ISSA-TURB-SMOOTH)",
        .solution = "log_law_channel",
        .reference_length = "depth",
        .leading_key = "friction_velocity",
        .end_time = 16,
        .expectations = turbulent_channel::expectations(),
        .claims = turbulent_channel::claims("ISSA-TURB-SMOOTH", "Issa 2005 §6.2.2 (ISSA-TURB-SMOOTH)"),
        .studies = turbulent_channel::studies("log_law_channel"),
        .fields = {"velocity", "mean_velocity_x", "mean_velocity_gradient", "mean_eddy_viscosity"},
        .measures = turbulent_channel::measures(),
        .keys = turbulent_channel::keys(),
        .columns = 12,
        .reference_side = 1,
        .profile_direction = 1,
        .hooks = {.reference_speed = turbulent_channel::reference_speed,
                  .prepare =
                      [](const SceneRecord& scene, solver::Simulation<2>& simulation) {
                          turbulent_channel::prepare(scene, simulation, "smooth",
                                                     {{"b", scene.case_settings.text("b")}});
                      },
                  .complete = turbulent_channel::add_means},
        .variant_names = turbulent_channel::variant_names(),
    };
    return flow;
}

} // namespace sphvv::verification::cases
