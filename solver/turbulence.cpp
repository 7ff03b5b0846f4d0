#include "sphvv/solver/turbulence.hpp"

#include "sphvv/solver/operators/gradient_difference.hpp"
#include "sphvv/solver/operators/renormalisation.hpp"
#include "sphvv/solver/simulation.hpp"
#include "sphvv/solver/turbulence/wall_distance.hpp"

#include <algorithm>

namespace sphvv::solver {
namespace {

/// The forms of du_a/dx_b (1/s) at a particle, with V_j = m/rho_j.
template <int Dim>
struct GradientForms {
    std::array<const double*, Dim> u;
    MassOverDensity volume;
    const Simulation<Dim>& s;
    const double* z = nullptr;    ///< m, wall distance
    const double* ln_z = nullptr; ///< its logarithm
    double edge = 0;              ///< m
    double u_star_over_kappa = 0; ///< m/s, imposed

    /// sum_j V_j (u_j - u_i) (x) gradW_ij. Source: Issa 2005 (5.59).
    Matrix<Dim> difference(const Row<Dim>& row, int i) const {
        return vector_gradient_difference<Dim>(row, i, u, volume);
    }
    /// G_i, the same times L_i: exact for linear velocities.
    Matrix<Dim> renormalised(const Row<Dim>& row, int i) const {
        return difference(row, i) * renormalisation<Dim>(row, volume);
    }
    /// G_i with its derivative along the wall's normal n times (1/z_i)/(n . L_i sum_j V_j (ln z_j - ln z_i)
    /// gradW_ij), the factor by which that of ln z is wrong: exact for velocities that are linear in ln z, as
    /// those of a wall layer, which bend within a support.
    Matrix<Dim> logarithmic(const Row<Dim>& row, int i) const {
        const Matrix<Dim> L = renormalisation<Dim>(row, volume);
        const Matrix<Dim> G = difference(row, i) * L;
        const Vector<Dim> n = normal(i);
        const double slope = n.dot(L * gradient_difference<Dim>(row, i, ln_z, volume));
        return slope > 0 ? Matrix<Dim>(G + (1 / (z[i] * slope) - 1) * (G * n) * n.transpose()) : G;
    }
    /// u*/(kappa z) along the particle's velocity. Source: Issa 2005 §6.2.2, step A.
    Matrix<Dim> imposed(const Row<Dim>& /*row*/, int i) const {
        const Vector<Dim> n = normal(i);
        Vector<Dim> along = vector_at<Dim>(s.particles.velocity, i);
        along -= along.dot(n) * n;
        const double speed = along.norm();
        return speed > 0 ? Matrix<Dim>(u_star_over_kappa / (z[i] * speed) * along * n.transpose())
                         : Matrix<Dim>(Matrix<Dim>::Zero());
    }

    Vector<Dim> normal(int i) const {
        const Vector<Dim> x = vector_at<Dim>(s.particles.position, i);
        return s.walls[nearest_wall(s.walls, x, edge).index].normal(x);
    }
};

/// The forms that a scene may have, by the word of the setting.
template <int Dim>
struct NamedForm {
    const char* name;
    void (*run)(const GradientForms<Dim>&, Field& gradient);
    int sweeps;
    bool reads_wall; ///< and needs one
};

template <int Dim, Matrix<Dim> (GradientForms<Dim>::*form)(const Row<Dim>&, int) const>
void form_gradient(const GradientForms<Dim>& forms, Field& gradient) {
    const auto result = arrays<Dim * Dim>(gradient);
    for_each_row(forms.s.neighbours, [&](int i, const Row<Dim>& row) {
        const Matrix<Dim> G = (forms.*form)(row, i);
        for (int a = 0; a < Dim; ++a) {
            for (int b = 0; b < Dim; ++b) {
                result[a * Dim + b][i] = G(a, b);
            }
        }
    });
}

template <int Dim>
const NamedForm<Dim>& form_of(const Settings& settings) {
    using Forms = GradientForms<Dim>;
    static const std::array<NamedForm<Dim>, 4> all{
        {{"difference", form_gradient<Dim, &Forms::difference>, 1, false},
         {"renormalised", form_gradient<Dim, &Forms::renormalised>, 2, false},
         {"logarithmic", form_gradient<Dim, &Forms::logarithmic>, 3, true},
         {"imposed", form_gradient<Dim, &Forms::imposed>, 0, true}}};
    return *std::ranges::find_if(
        all, [&](const NamedForm<Dim>& each) { return each.name == settings.word("velocity_gradient"); });
}

/// What the forms read of a simulation on its current neighbour list.
template <int Dim>
GradientForms<Dim> gradient_forms(const Simulation<Dim>& s, const Field& density) {
    GradientForms<Dim> forms{constant_arrays<Dim>(s.particles.velocity), {s.particle_mass, density[0]}, s};
    const Field* z = s.particles.find("wall_distance");
    const Field* ln_z = s.particles.find("log_wall_distance");
    forms.z = z == nullptr ? nullptr : (*z)[0];
    forms.ln_z = ln_z == nullptr ? nullptr : (*ln_z)[0];
    if (s.wall_friction) {
        const Settings& settings = s.wall_friction->settings;
        forms.edge = s.wall_friction->edge();
        forms.u_star_over_kappa = settings.number("friction_velocity") / settings.number("kappa");
    }
    return forms;
}

template <int Dim>
void add_gradient_stage(Simulation<Dim>& s, const NamedForm<Dim>& form, Field& gradient) {
    Field& density = s.particles.field("density", 1, Lifetime::state, "velocity_gradient");
    s.add_stage("velocity_gradient", [&form, &density, &gradient](Simulation<Dim>& sim) {
        sim.fill_walls(sim.particles.velocity, Parity::velocity);
        sim.fill_walls(density, Parity::even);
        form.run(gradient_forms(sim, density), gradient);
        sim.count_sweeps(form.sweeps);
    });
}

/// What reads the distance from a wall needs one; and u* is a number of the wall function.
template <int Dim>
void refuse_without_wall(const Simulation<Dim>& s, const NamedForm<Dim>& form) {
    const bool wall =
        std::ranges::any_of(s.walls, [](const Wall<Dim>& each) { return each.slip == Slip::no_slip; });
    if ((s.turbulence->model->reads_wall_distance || form.reads_wall) && !wall) {
        throw UserError("turbulence '" + std::string(s.turbulence->model->name) +
                        "' with velocity_gradient '" + form.name + "' needs a wall without slip");
    }
    if (form.reads_wall && !s.wall_friction) {
        throw UserError(std::string("velocity_gradient '") + form.name + "' needs a wall function");
    }
}

} // namespace

template <int Dim>
void add_turbulence_stages(Simulation<Dim>& s) {
    if (!s.turbulence) {
        return;
    }
    const TurbulenceModel& model = *s.turbulence->model;
    const NamedForm<Dim>& form = form_of<Dim>(s.turbulence->settings);
    refuse_without_wall(s, form);
    if (model.reads_wall_distance || form.reads_wall) {
        add_wall_distance_stage(s, std::string_view(form.name) == "logarithmic");
    }
    Field& gradient =
        s.particles.field("velocity_gradient", Dim * Dim, Lifetime::scratch, "velocity_gradient");
    Field& nu_T = s.particles.field("eddy_viscosity", 1, Lifetime::scratch, "eddy_viscosity");
    add_gradient_stage(s, form, gradient);
    s.add_stage("eddy_viscosity",
                [&gradient, &nu_T, update = model.assemble(s, s.turbulence->settings)](Simulation<Dim>& sim) {
                    update(sim, gradient, nu_T);
                    sim.fill_walls(nu_T, Parity::even);
                });
}

template <int Dim>
double largest_viscosity(const Simulation<Dim>& s) {
    const Field* field = s.turbulence ? s.particles.find("eddy_viscosity") : nullptr;
    if (field == nullptr) {
        return s.kinematic_viscosity;
    }
    const double* nu_T = (*field)[0];
    return s.kinematic_viscosity + *std::max_element(nu_T, nu_T + s.particles.size());
}

template void add_turbulence_stages(Simulation<2>&);
template void add_turbulence_stages(Simulation<3>&);
template double largest_viscosity(const Simulation<2>&);
template double largest_viscosity(const Simulation<3>&);

namespace turbulence {
const TurbulenceModel& find(std::string_view name) {
    return find_by_name(all(), name, "turbulence model");
}

std::vector<Key> keys(const TurbulenceModel& model) {
    std::vector<Key> result{Key::word(
        "velocity_gradient", "difference", {"difference", "renormalised", "logarithmic", "imposed"},
        "difference: sum V_j (u_j - u_i) (x) gradW; renormalised: the same times L_i, exact for "
        "linear velocities; logarithmic: so that it is exact for ln z along the wall's normal, too; "
        "imposed: u*/(kappa z) with the friction_velocity of the wall function")};
    result.insert(result.end(), model.keys.begin(), model.keys.end());
    return result;
}
} // namespace turbulence

} // namespace sphvv::solver
