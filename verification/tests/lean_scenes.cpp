// A scene carries only what it needs. The table lean_scenes.txt holds stages, fields and bytes per particle
// of every kind of scene; here it is held against the scenes, against rules that say what a stage or field is
// for, and against steps with fields poisoned, which say whether anything reads them.

#include "sphvv/solver/boundaries/wall_methods.hpp"
#include "sphvv/verification/run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>

namespace sphvv::verification {
namespace {

using solver::Field;
using solver::Lifetime;
using solver::Simulation;

// The kinds of scene.

/// One scene of the table: a case and a variant.
struct Subject {
    const Case* flow;
    std::string variant;

    std::string name() const { return std::string(flow->name) + "/" + variant; }
    SceneRecord scene() const { return resolve_scene(*flow, variant_of(variant), {}, n()); }
    int n() const { return dimension_of_case() == 3 ? 8 : 10; }

private:
    int dimension_of_case() const { return dimension(resolve_scene(*flow, variant_of("wcsph"), {}, 16)); }
};

bool can_be_built(const Subject& subject) {
    try {
        const SceneRecord scene = subject.scene();
        if (dimension(scene) == 2) {
            build_scene<2>(scene);
        } else {
            build_scene<3>(scene);
        }
        return true;
    } catch (const UserError&) {
        return false; // the scene has physics for which the scheme has no stage, or a method that it cannot
    }
}

/// What may be said of a scene beside its case and scheme, and changes what it carries or might: every wall
/// method, integrator, condition at a surface and choice of a turbulent channel; and, of periodic vortices
/// alone, the forms that a scheme may take, which do not ask what the scene is.
std::vector<std::string> choices(const Case& flow) {
    std::vector<std::string> all{"", ":integrator=predictor_corrector", ":integrator=verlet"};
    if (flow.name == "taylor_green") {
        for (const char* form :
             {":pressure_force=taylor:continuity=renormalised", ":pressure_force=hybrid_taylor",
              ":shift_correction=none", ":shift_correction=second", ":gradient=plain", ":gradient=normalised",
              ":laplacian=schwaiger", ":relaxation=0"}) {
            all.emplace_back(form);
        }
    }
    all.emplace_back(":viscous_step=implicit");
    for (const solver::WallMethodEntry* method : solver::wall_methods::all()) {
        all.push_back(":wall_method=" + std::string(method->name));
    }
    if (has_free_surface(flow)) {
        all.emplace_back(":surface_pressure=true_position");
        all.emplace_back(":viscosity=morris:surface_peclet=30");
    }
    for (const char* more :
         {":damping=150", ":velocity_gradient=renormalised", ":velocity_gradient=logarithmic",
          ":velocity_gradient=imposed", ":driver=constant", ":driver=controlled"}) {
        all.emplace_back(more);
    }
    return all;
}

/// Whether the case or the scheme has every key that the variant sets, and none of them at its default.
bool says_something(const Subject& subject) {
    const Variant variant = variant_of(subject.variant);
    const auto has = [&](const std::vector<solver::Key>& keys, const auto& setting) {
        const auto found = std::ranges::find(keys, setting.first, &solver::Key::name);
        return found != keys.end() && found->value != setting.second;
    };
    return std::ranges::all_of(variant.settings, [&](const auto& setting) {
        return has(case_keys(*subject.flow), setting) || has(variant.scheme->keys, setting) ||
               setting.first == "viscosity";
    });
}

/// Every case with every scheme and choice that can be built.
const std::vector<Subject>& subjects() {
    static const std::vector<Subject> all = [] {
        std::vector<Subject> found;
        for (const Case* flow : cases::all()) {
            for (const solver::Scheme* scheme : solver::schemes::all()) {
                for (const std::string& choice : choices(*flow)) {
                    const Subject subject{flow, std::string(scheme->name) + choice};
                    try {
                        if (says_something(subject) && can_be_built(subject)) {
                            found.push_back(subject);
                        }
                    } catch (const UserError&) {
                        continue; // a word that this scheme does not take
                    }
                }
            }
        }
        return found;
    }();
    return all;
}

// What a scene carries.

using Words = std::vector<std::string>;

struct Inventory {
    Words stages;
    Words state;   ///< name:components
    Words scratch; ///< with a star where it lives within one stage
    std::size_t bytes = 0;
    bool operator==(const Inventory&) const = default;
};

std::string joined(const Words& words) {
    std::string line;
    for (const std::string& word : words) {
        line += " " + word;
    }
    return line;
}

std::ostream& operator<<(std::ostream& out, const Inventory& inventory) {
    return out << "\n  stages" << joined(inventory.stages) << "\n  state" << joined(inventory.state)
               << "\n  scratch" << joined(inventory.scratch) << "\n  bytes " << inventory.bytes;
}

template <int Dim>
Inventory inventory_of(const Simulation<Dim>& s) {
    Inventory found;
    for (const auto& stage : s.stages) {
        found.stages.push_back(stage.name);
    }
    for (const Field& field : s.particles.fields()) {
        (field.lifetime == Lifetime::state ? found.state : found.scratch)
            .push_back(field.name + ":" + std::to_string(field.components.size()));
    }
    found.bytes = s.particles.bytes_per_particle();
    return found;
}

/// The same without the stars of the table.
Inventory without_stars(Inventory inventory) {
    for (std::string& field : inventory.scratch) {
        std::erase(field, '*');
    }
    return inventory;
}

struct Kind {
    std::string title;
    Inventory inventory;
    Words scenes;
};

std::vector<Kind> read_table() {
    std::ifstream file(SPHVV_LEAN_SCENES);
    std::vector<Kind> kinds;
    std::string line;
    while (std::getline(file, line)) {
        if (line.empty() || line[0] == '#') {
            continue;
        }
        std::istringstream text(line);
        std::string key;
        text >> key;
        Words words;
        for (std::string word; text >> word;) {
            words.push_back(word);
        }
        if (key == "kind") {
            kinds.push_back({joined(words), {}, {}});
        } else if (kinds.empty()) {
            throw UserError("lean_scenes.txt: '" + key + "' before any kind");
        } else if (key == "stages") {
            kinds.back().inventory.stages = words;
        } else if (key == "state") {
            kinds.back().inventory.state = words;
        } else if (key == "scratch") {
            kinds.back().inventory.scratch = words;
        } else if (key == "bytes") {
            kinds.back().inventory.bytes = std::stoul(words.at(0));
        } else if (key == "scenes") {
            kinds.back().scenes.insert(kinds.back().scenes.end(), words.begin(), words.end());
        } else {
            throw UserError("lean_scenes.txt: '" + key +
                            "'; accepted: kind, stages, state, scratch, bytes, scenes");
        }
    }
    return kinds;
}

template <class Act>
void with_scene(const Subject& subject, const Act& act) {
    const SceneRecord scene = subject.scene();
    if (dimension(scene) == 2) {
        act(build_scene<2>(scene));
    } else {
        act(build_scene<3>(scene));
    }
}

TEST(LeanScenes, CarryWhatTheTableSaysAndNoMore) {
    std::map<std::string, const Kind*> table;
    const std::vector<Kind> kinds = read_table();
    for (const Kind& kind : kinds) {
        for (const std::string& scene : kind.scenes) {
            EXPECT_TRUE(table.emplace(scene, &kind).second) << scene << " is there twice";
        }
    }
    for (const Subject& subject : subjects()) {
        SCOPED_TRACE(subject.name());
        const auto found = table.find(subject.name());
        with_scene(subject, [&](const auto& s) {
            const Inventory inventory = inventory_of(s);
            if (found == table.end()) {
                ADD_FAILURE() << "not in the table:" << inventory;
                return;
            }
            EXPECT_EQ(inventory, without_stars(found->second->inventory));
        });
        if (found != table.end()) {
            table.erase(found);
        }
    }
    for (const auto& [scene, kind] : table) {
        ADD_FAILURE() << scene << " is in the table, and no such scene can be built";
    }
    std::set<std::string> titles;
    for (const Kind& kind : kinds) {
        EXPECT_TRUE(titles.insert(kind.title).second) << "two kinds are called" << kind.title;
        EXPECT_FALSE(kind.scenes.empty()) << kind.title;
        for (const Kind& other : kinds) {
            EXPECT_TRUE(&kind == &other || !(kind.inventory == other.inventory))
                << kind.title << " and" << other.title << " are one kind";
        }
    }
}

// What stages and fields are for.

/// What a scene has, of its physics and of the formulas of its scheme.
struct Facts {
    template <int Dim>
    Facts(const SceneRecord& scene, const Simulation<Dim>& s)
        : dim(Dim), flow(scene.flow->name), scheme(scene.scheme->name), surface(s.free_surface),
          turbulence(s.turbulence), friction(s.wall_friction), driven(s.flow_driver),
          walls_move(s.walls_move()),
          slides(s.wall_friction && s.wall_friction->settings.word("edge_motion") != "none"),
          gradient_form(s.turbulence ? s.turbulence->settings.word("velocity_gradient") : ""),
          damped(scene.case_settings.has("damping") && scene.case_settings.number("damping") > 0),
          viscous(s.kinematic_viscosity > 0 || (s.free_surface && s.settings.has("surface_peclet") &&
                                                s.settings.number("surface_peclet") > 0)) {
        const solver::Settings& settings = s.settings;
        const auto word = [&](const char* key) { return settings.has(key) ? settings.word(key) : ""; };
        weakly_compressible = scheme == "wcsph";
        runge_kutta = scheme == "isph_mls";
        projection = !weakly_compressible && !runge_kutta;
        shifts = scheme == "isph_dfs";
        shift_correction = word("shift_correction");
        summed_density = scheme == "isph_di" || scheme == "isph_dfdi";
        relaxed = scheme == "isph_asai" && settings.number("relaxation") > 0;
        // L_i: the normalised gradient and Schwaiger's Laplacian have it, twice in a step at least.
        keeps_L = projection && !summed_density &&
                  (word("gradient") == "normalised" || word("laplacian") == "schwaiger");
        integrator = word("integrator");
        pressure_force = word("pressure_force");
        renormalised = word("continuity") == "renormalised" || pressure_force.starts_with("renormalised") ||
                       pressure_force.ends_with("taylor");
    }

    int dim;
    std::string_view flow, scheme;
    bool surface, turbulence, friction, driven, walls_move, slides;
    std::string gradient_form;
    bool damped, viscous;
    bool weakly_compressible = false, runge_kutta = false, projection = false, shifts = false;
    std::string shift_correction;
    bool summed_density = false, relaxed = false, keeps_L = false;
    std::string integrator, pressure_force;
    bool renormalised = false;

    bool explicit_steps() const { return weakly_compressible && integrator == "explicit"; }
    bool predicts() const { return weakly_compressible && integrator == "predictor_corrector"; }
    bool leaps() const { return weakly_compressible && integrator == "verlet"; }
    bool channel() const { return flow.starts_with("log_law_channel"); }
};

struct StageRule {
    bool (*needed)(const Facts&);
    const char* what_for;
};

/// A stage is there if, and only if, its rule holds; one without a rule has no reason to be there.
const std::map<std::string_view, StageRule>& stage_rules() {
    static const std::map<std::string_view, StageRule> rules{
        {"time_step", {[](const Facts&) { return true; }, "every step has a length"}},
        {"neighbours", {[](const Facts&) { return true; }, "every sum runs over neighbours"}},
        {"drift",
         {[](const Facts& f) { return f.projection || f.explicit_steps(); },
          "particles move; other integrators move them with the rest of the state"}},
        {"viscosity",
         {[](const Facts& f) { return f.projection && f.viscous; }, "nu > 0, or damped surface"}},
        {"body_force",
         {[](const Facts& f) { return f.projection && !f.viscous; }, "u* = u + dt f without viscosity"}},
        {"second_viscosity",
         {[](const Facts& f) { return f.scheme == "isph_dfdi" && f.viscous; }, "two half steps"}},
        {"second_body_force",
         {[](const Facts& f) { return f.scheme == "isph_dfdi" && !f.viscous; }, "two half steps"}},
        {"renormalisation",
         {[](const Facts& f) { return f.keeps_L && !f.viscous; }, "L_i, which viscosity else leaves"}},
        {"pressure_poisson", {[](const Facts& f) { return f.projection; }, "pressure of a projection"}},
        {"projection", {[](const Facts& f) { return f.projection; }, "takes the divergence off"}},
        {"shifting", {[](const Facts& f) { return f.shifts; }, "Xu's shifts"}},
        {"density",
         {[](const Facts& f) { return f.scheme == "isph_di" || f.relaxed; }, "source rho_0 - rho"}},
        {"moved_neighbours",
         {[](const Facts& f) { return f.scheme == "isph_di"; }, "density of the moved particles"}},
        {"density_invariance", {[](const Facts& f) { return f.scheme == "isph_dfdi"; }, "Hu & Adams 2007"}},
        {"rates_at_start", {[](const Facts& f) { return f.runge_kutta; }, "rates of the first step"}},
        {"runge_kutta", {[](const Facts& f) { return f.runge_kutta; }, "its inner levels"}},
        {"rates", {[](const Facts& f) { return f.runge_kutta; }, "rates at the end, with the pressure"}},
        {"momentum", {[](const Facts& f) { return f.explicit_steps() || f.leaps(); }, "acceleration"}},
        {"continuity", {[](const Facts& f) { return f.explicit_steps() || f.leaps(); }, "rate of density"}},
        {"predictor", {[](const Facts& f) { return f.predicts(); }, "both, to the middle of the step"}},
        {"corrector", {[](const Facts& f) { return f.predicts(); }, "both, to its end"}},
        {"verlet", {[](const Facts& f) { return f.leaps(); }, "the leap"}},
        {"equation_of_state", {[](const Facts& f) { return f.weakly_compressible; }, "p(rho)"}},
        {"free_surface",
         {[](const Facts& f) { return f.surface && f.projection; },
          "p = 0 is laid down at a surface; with p(rho) it comes of itself"}},
        {"wall_function", {[](const Facts& f) { return f.friction; }, "wall function"}},
        {"wall_transport", {[](const Facts& f) { return f.slides; }, "wall particles slide with the edge"}},
        {"wall_distance",
         {[](const Facts& f) { return f.turbulence; }, "z of Prandtl's length, the one model of a case"}},
        {"velocity_gradient", {[](const Facts& f) { return f.turbulence; }, "shear rate of the model"}},
        {"eddy_viscosity", {[](const Facts& f) { return f.turbulence; }, "what the model gives"}},
        {"flow_driver", {[](const Facts& f) { return f.driven; }, "upholds the bulk velocity"}},
        {"means", {[](const Facts& f) { return f.channel(); }, "a channel is compared by its means"}},
        {"impulse", {[](const Facts& f) { return f.flow == "impulsive_plate"; }, "what the case compares"}},
        {"damping", {[](const Facts& f) { return f.damped; }, "leads the column to rest"}},
    };
    return rules;
}

struct FieldRule {
    Lifetime lifetime;
    int (*components)(const Facts&); ///< 0: the scene has none
    const char* what_for;
};

int vector_if(const Facts& f, bool needed) {
    return needed ? f.dim : 0;
}
int scalar_if(bool needed) {
    return needed ? 1 : 0;
}

const std::map<std::string_view, FieldRule>& field_rules() {
    using enum Lifetime;
    static const std::map<std::string_view, FieldRule> rules{
        {"position", {state, [](const Facts& f) { return f.dim; }, "of a particle"}},
        {"velocity", {state, [](const Facts& f) { return f.dim; }, "of a particle"}},
        {"pressure", {state, [](const Facts&) { return 1; }, "p(rho), or the first guess of the next"}},
        {"density", {state, [](const Facts& f) { return scalar_if(f.weakly_compressible); }, "continuity"}},
        {"velocity_next", {scratch, [](const Facts& f) { return vector_if(f, f.projection); }, "u*"}},
        {"renormalisation",
         {scratch,
          [](const Facts& f) {
              return f.keeps_L ? f.dim * f.dim
                               : scalar_if(f.weakly_compressible && f.renormalised) * f.dim * (f.dim + 1) / 2;
          },
          "L_i, symmetric where it is read at neighbours, too"}},
        {"shift_correction",
         {scratch, [](const Facts& f) { return f.shifts && f.shift_correction != "none" ? f.dim + 1 : 0; },
          "of velocity and pressure"}},
        {"shift_gradient",
         {scratch,
          [](const Facts& f) { return f.shifts && f.shift_correction == "second" ? f.dim * (f.dim + 1) : 0; },
          "of velocity and pressure"}},
        {"particle_density",
         {scratch, [](const Facts& f) { return scalar_if(f.summed_density || f.relaxed); }, "sum m W"}},
        {"density_pressure",
         {state, [](const Facts& f) { return scalar_if(f.scheme == "isph_dfdi"); },
          "first guess of the other of two pressures"}},
        {"divergence_integral", {state, [](const Facts& f) { return scalar_if(f.runge_kutta); }, "s"}},
        {"repulsion_strength", {state, [](const Facts& f) { return scalar_if(f.runge_kutta); }, "b_j"}},
        {"drift_velocity", {state, [](const Facts& f) { return vector_if(f, f.runge_kutta); }, "rate of r"}},
        {"acceleration",
         {scratch, [](const Facts& f) { return vector_if(f, f.runge_kutta || f.weakly_compressible); },
          "rate of u; of isph_mls, which ends a step with the rates that start the next, state"}},
        {"divergence_rate", {state, [](const Facts& f) { return scalar_if(f.runge_kutta); }, "rate of s"}},
        {"step_start",
         {scratch, [](const Facts& f) { return f.runge_kutta || f.predicts() ? 2 * f.dim + 1 : 0; },
          "r, u and s or rho at the start"}},
        {"step_increment",
         {scratch, [](const Facts& f) { return f.runge_kutta ? 2 * f.dim + 1 : 0; }, "sum b_k f_k"}},
        {"predictor_displacement",
         {scratch, [](const Facts& f) { return vector_if(f, f.predicts() && !f.walls_move); },
          "the list follows it, where walls stay"}},
        {"pressure_over_squared_density",
         {scratch,
          [](const Facts& f) { return scalar_if(f.weakly_compressible && f.pressure_force == "sigma_2"); },
          "of the force sigma_2 alone"}},
        {"specific_volume",
         {scratch, [](const Facts& f) { return scalar_if(f.weakly_compressible); }, "1/rho of neighbours"}},
        {"density_rate", {scratch, [](const Facts& f) { return scalar_if(f.weakly_compressible); }, ""}},
        {"lowest_eigenvalue",
         {scratch, [](const Facts& f) { return scalar_if(f.pressure_force == "hybrid_taylor"); }, "Oger's"}},
        {"previous_velocity", {state, [](const Facts& f) { return vector_if(f, f.leaps()); }, "leap"}},
        {"previous_density", {state, [](const Facts& f) { return scalar_if(f.leaps()); }, "leap"}},
        {"edge_velocity", {state, [](const Facts& f) { return vector_if(f, f.friction); }, "at the wall"}},
        {"wall_displacement", {state, [](const Facts& f) { return vector_if(f, f.slides); }, "has slid"}},
        {"wall_distance", {scratch, [](const Facts& f) { return scalar_if(f.turbulence); }, "z"}},
        {"log_wall_distance",
         {scratch, [](const Facts& f) { return scalar_if(f.gradient_form == "logarithmic"); }, "ln z"}},
        {"velocity_gradient",
         {scratch, [](const Facts& f) { return f.turbulence ? f.dim * f.dim : 0; }, "du_a/dx_b"}},
        {"eddy_viscosity", {scratch, [](const Facts& f) { return scalar_if(f.turbulence); }, "nu_T"}},
        {"mean_velocity_x", {state, [](const Facts& f) { return scalar_if(f.channel()); }, "compared"}},
        {"mean_velocity_gradient",
         {state, [](const Facts& f) { return scalar_if(f.channel()); }, "compared"}},
        {"mean_eddy_viscosity", {state, [](const Facts& f) { return scalar_if(f.channel()); }, "compared"}},
        {"averaged_time", {state, [](const Facts& f) { return scalar_if(f.channel()); }, "of the means"}},
        {"impulse", {state, [](const Facts& f) { return scalar_if(f.flow == "impulsive_plate"); }, ""}},
    };
    return rules;
}

/// Whether a scheme whose step ends with the rates of the next carries that field over.
bool is_carried(const Facts& facts, std::string_view field, Lifetime lifetime) {
    return lifetime == Lifetime::state || (facts.runge_kutta && field == "acceleration");
}

template <int Dim>
void expect_rules(const Facts& facts, const Simulation<Dim>& s) {
    const auto has_stage = [&](std::string_view name) {
        return std::ranges::any_of(s.stages, [&](const auto& stage) { return stage.name == name; });
    };
    for (const auto& stage : s.stages) {
        EXPECT_TRUE(stage_rules().contains(stage.name)) << "no rule says what " << stage.name << " is for";
    }
    for (const auto& [name, rule] : stage_rules()) {
        EXPECT_EQ(has_stage(name), rule.needed(facts)) << name << ": " << rule.what_for;
    }
    std::size_t bytes = sizeof(int); // the identity
    for (const auto& [name, rule] : field_rules()) {
        const Field* field = s.particles.find(name);
        const std::size_t components = field == nullptr ? 0 : field->components.size();
        EXPECT_EQ(components, rule.components(facts)) << name << ": " << rule.what_for;
        bytes += rule.components(facts) * sizeof(double);
    }
    for (const Field& field : s.particles.fields()) {
        const auto rule = field_rules().find(field.name);
        ASSERT_NE(rule, field_rules().end()) << "no rule says what " << field.name << " is for";
        EXPECT_EQ(field.lifetime == Lifetime::state, is_carried(facts, field.name, rule->second.lifetime))
            << field.name;
        // A field belongs to stages that are there.
        EXPECT_FALSE(field.asked_by.empty());
        for (const std::string& who : field.asked_by) {
            EXPECT_TRUE(who == "scene" || has_stage(who)) << field.name << " is asked for by " << who;
        }
    }
    EXPECT_LE(s.particles.bytes_per_particle(), bytes);
    EXPECT_EQ(s.pair_bytes != nullptr, !facts.weakly_compressible) << "equations of a pressure";
}

TEST(LeanScenes, HaveAReasonForEveryStageAndField) {
    for (const Subject& subject : subjects()) {
        SCOPED_TRACE(subject.name());
        with_scene(subject, [&](const auto& s) { expect_rules(Facts(subject.scene(), s), s); });
    }
}

// What is read.

/// A scene of a kind one even step from its end, after another. Particles lie unevenly where the
/// case allows it, for an even lattice may leave a sum at zero whatever its terms.
template <int Dim>
Simulation<Dim> before_last_step(const Subject& subject) {
    SceneRecord scene = subject.scene();
    Simulation<Dim> s = build_scene<Dim>(scene);
    for (std::size_t i = 0; i < s.particles.fluid_size(); ++i) {
        for (int d = 0; d < Dim; ++d) {
            const double phase = static_cast<double>(s.particles.id[i] * (d + 2));
            s.particles.position[d][i] += 0.04 * s.particle_spacing * std::sin(phase);
        }
    }
    s.survival = {};
    const auto step_chosen = std::ranges::find(s.stages, "time_step", &solver::Stage<Dim>::name) + 1;
    std::for_each(s.stages.begin(), step_chosen, [&](auto& stage) { stage.run(s); });
    s.end_time = 2 * s.time_step;
    if (s.settings.has("time_step")) {
        solver::Assignments given;
        for (const solver::Key& key : s.settings.keys()) {
            given[key.name] = key.value;
        }
        given["time_step"] = solver::shortest(s.time_step);
        s.settings = solver::Settings(s.settings.keys(), given);
    }
    advance(s);
    return s;
}

using Bits = std::map<std::string, std::vector<std::vector<double>>>;

/// The state at the particles, or what has happened to the run.
template <int Dim>
Bits state_of(const Simulation<Dim>& s) {
    Bits bits;
    for (const Field& field : s.particles.fields()) {
        if (field.lifetime == Lifetime::state) {
            auto& values = bits[field.name];
            for (const auto& component : field.components) {
                values.emplace_back(component.begin(),
                                    component.begin() + static_cast<std::ptrdiff_t>(s.particles.size()));
            }
        }
    }
    return bits;
}

bool same_bits(const std::vector<std::vector<double>>& a, const std::vector<std::vector<double>>& b) {
    return std::ranges::equal(a, b, [](const auto& x, const auto& y) {
        return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(double)) == 0;
    });
}

bool same_bits(const Bits& a, const Bits& b) {
    return std::ranges::equal(a, b, [](const auto& x, const auto& y) {
        return x.first == y.first && same_bits(x.second, y.second);
    });
}

/// State after the last step; nothing if it diverged.
template <int Dim>
std::optional<Bits> last_step(Simulation<Dim>& s) {
    try {
        advance(s);
    } catch (const solver::Diverged&) {
        return std::nullopt;
    }
    return state_of(s);
}

void fill_with_nan(Field& field) {
    for (auto& component : field.components) {
        std::ranges::fill(component, std::nan(""));
    }
}

template <int Dim>
Field& field_of(Simulation<Dim>& s, std::string_view name) {
    return *std::ranges::find(s.particles.fields(), name, &Field::name);
}

bool any_nan(const Field& field) {
    return std::ranges::any_of(field.components, [&](const auto& component) {
        return std::any_of(component.begin(),
                           component.begin() + static_cast<std::ptrdiff_t>(field.particles),
                           [](double x) { return std::isnan(x); });
    });
}

/// A small share of the field's size, uneven; of positions, of dx; of a field that is zero, of 1.
template <int Dim>
void perturb(Simulation<Dim>& s, const std::string& name) {
    Field& field = field_of(s, name);
    double size = 0;
    for (const auto& component : field.components) {
        for (std::size_t i = 0; i < s.particles.size(); ++i) {
            size = std::max(size, std::abs(component[i]));
        }
    }
    size = name == "position" ? s.particle_spacing : size > 0 ? size : 1;
    for (auto& component : field.components) {
        for (std::size_t i = 0; i < s.particles.size(); ++i) {
            component[i] += 1e-3 * size * std::sin(static_cast<double>(3 * i + 1));
        }
    }
}

/// Whether any stage reads what an earlier one of the same step left in a scratch field: whether the end of
/// the step is another one if the field is another one after some stage.
template <int Dim>
bool is_read_by_a_later_stage(const Subject& subject, const std::string& name, const Bits& expected) {
    const std::size_t stages = before_last_step<Dim>(subject).stages.size();
    for (std::size_t k = 0; k + 1 < stages; ++k) {
        Simulation<Dim> s = before_last_step<Dim>(subject);
        auto& stage = s.stages[k];
        stage.run = [run = stage.run, &name](Simulation<Dim>& sim) {
            run(sim);
            perturb(sim, name);
        };
        const std::optional<Bits> found = last_step(s);
        if (!found || !same_bits(*found, expected)) {
            return true;
        }
    }
    return false;
}

template <int Dim>
void expect_minimal(const Subject& subject, const Inventory& table) {
    Simulation<Dim> plain = before_last_step<Dim>(subject);
    const std::optional<Bits> expected = last_step(plain);
    ASSERT_TRUE(expected);
    if (plain.walls.empty()) {
        EXPECT_TRUE(plain.images.empty());
    }

    // Scratch is formed anew: nothing of it gets into a step, and all of it is written.
    Simulation<Dim> poisoned = before_last_step<Dim>(subject);
    for (Field& field : poisoned.particles.fields()) {
        if (field.lifetime == Lifetime::scratch) {
            fill_with_nan(field);
        }
    }
    const std::optional<Bits> found = last_step(poisoned);
    ASSERT_TRUE(found);
    EXPECT_TRUE(same_bits(*found, *expected)) << "scratch of the step before has been read";
    for (const Field& field : poisoned.particles.fields()) {
        if (field.lifetime != Lifetime::scratch) {
            continue;
        }
        EXPECT_FALSE(any_nan(field)) << field.name << " is not written";
        const std::string entry = field.name + ":" + std::to_string(field.components.size());
        const bool within_a_stage = std::ranges::find(table.scratch, entry + "*") != table.scratch.end();
        EXPECT_EQ(is_read_by_a_later_stage<Dim>(subject, field.name, *expected), !within_a_stage)
            << field.name << " is " << (within_a_stage ? "not " : "") << "for one stage alone in the table";
    }

    // State is carried because something reads it: the next state is another one where it is another one.
    for (const auto& [name, values] : *expected) {
        Simulation<Dim> s = before_last_step<Dim>(subject);
        perturb(s, name);
        const std::optional<Bits> next = last_step(s);
        EXPECT_TRUE(!next || !same_bits(*next, *expected)) << name << " is carried for nothing";
    }

    // No two fields are the same thing.
    const auto& fields = plain.particles.fields();
    for (const Field& a : fields) {
        for (const Field& b : fields) {
            const auto zero = [](const std::vector<double>& x) {
                return std::ranges::all_of(x, [&](double value) { return value == x[0]; });
            };
            if (a.name < b.name && a.components.size() == b.components.size() &&
                !std::ranges::all_of(a.components, zero)) {
                EXPECT_FALSE(same_bits(a.components, b.components)) << a.name << " and " << b.name;
            }
        }
    }
}

TEST(LeanScenes, ReadEveryFieldThatTheyCarry) {
    std::map<std::string, Subject> by_name;
    for (const Subject& subject : subjects()) {
        by_name.emplace(subject.name(), subject);
    }
    for (const Kind& kind : read_table()) {
        SCOPED_TRACE(kind.title);
        const auto found = by_name.find(kind.scenes.at(0));
        ASSERT_NE(found, by_name.end());
        SCOPED_TRACE(found->first);
        if (dimension(found->second.scene()) == 2) {
            expect_minimal<2>(found->second, kind.inventory);
        } else {
            expect_minimal<3>(found->second, kind.inventory);
        }
    }
}

} // namespace
} // namespace sphvv::verification
