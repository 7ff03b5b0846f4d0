#include "sphvv/verification/cases.hpp"
#include "sphvv/verification/scene.hpp"
#include "sphvv/verification/turbulent_channel.hpp"

namespace sphvv::verification::cases {

const Case& log_law_channel_rough() {
    static const Case flow{
        .name = "log_law_channel_rough",
        .summary = "turbulent channel with a free surface over a rough bed, mixing length and wall function",
        .equations = "Reynolds-averaged Navier-Stokes in 2-D, eddy viscosity by a mixing length",
        .source = "Issa 2005 §6.2.3 (ISSA-TURB-ROUGH)",
        .solution = "log_law_channel_rough",
        .reference_length = "depth",
        .leading_key = "friction_velocity",
        .end_time = 16,
        .expectations = turbulent_channel::expectations(),
        .claims = turbulent_channel::claims("ISSA-TURB-ROUGH", "Issa 2005 §6.2.3 (ISSA-TURB-ROUGH)"),
        .studies = turbulent_channel::studies("log_law_channel_rough"),
        .fields = {"velocity", "mean_velocity_x", "mean_velocity_gradient", "mean_eddy_viscosity"},
        .measures = turbulent_channel::measures(),
        .keys = turbulent_channel::keys(),
        .columns = 12,
        .reference_side = 1,
        .profile_direction = 1,
        .hooks = {.reference_speed = turbulent_channel::reference_speed,
                  .prepare =
                      [](const SceneRecord& scene, solver::Simulation<2>& simulation) {
                          turbulent_channel::prepare(
                              scene, simulation, "rough",
                              {{"d", scene.case_settings.text("d")},
                               {"roughness", solver::shortest(scene.case_settings.number("roughness") *
                                                              scene.case_settings.number("depth"))}});
                      },
                  .complete = turbulent_channel::add_means},
        .variant_names = turbulent_channel::variant_names(),
    };
    return flow;
}

} // namespace sphvv::verification::cases
