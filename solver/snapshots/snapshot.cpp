#include "sphvv/solver/snapshots/snapshot.hpp"

#include "sphvv/solver/storage/hdf5.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace sphvv::solver {
namespace {

using storage::Group;

constexpr const char* format_name = "sphvv-snapshot";

/// Every number of a simulation that its scene fixes, in SI units.
template <int Dim>
constexpr std::array<std::pair<const char*, double Simulation<Dim>::*>, 6> constants{
    {{"particle_spacing", &Simulation<Dim>::particle_spacing},
     {"smoothing_length", &Simulation<Dim>::smoothing_length},
     {"density", &Simulation<Dim>::density},
     {"kinematic_viscosity", &Simulation<Dim>::kinematic_viscosity},
     {"reference_speed", &Simulation<Dim>::reference_speed},
     {"particle_mass", &Simulation<Dim>::particle_mass}}};

/// Every number that a step hands on to the next.
template <int Dim>
constexpr std::array<std::pair<const char*, double Simulation<Dim>::*>, 3> progress{
    {{"time", &Simulation<Dim>::time},
     {"time_step", &Simulation<Dim>::time_step},
     {"maximum_acceleration", &Simulation<Dim>::maximum_acceleration}}};

constexpr std::array<std::pair<const char*, std::int64_t Work::*>, 4> counters{
    {{"pair_evaluations", &Work::pair_evaluations},
     {"solver_iterations", &Work::solver_iterations},
     {"matrix_entries", &Work::matrix_entries},
     {"particle_steps", &Work::particle_steps}}};

/// Vectors have three components in the file, because those who look at it want points in space.
template <int Dim>
std::size_t stored_components(const Field& field) {
    return field.components.size() == Dim ? 3 : field.components.size();
}

template <class T>
std::span<const T> all(const std::vector<T>& values) {
    return values;
}

template <class T, std::size_t N>
std::vector<T> listed(const std::array<T, N>& values) {
    return {values.begin(), values.end()};
}

template <int Dim>
std::vector<std::uint8_t> periodic_flags(const Box<Dim>& box) {
    return {box.periodic.begin(), box.periodic.end()};
}

Assignments texts_of(const Settings& settings) {
    Assignments texts;
    for (const Key& key : settings.keys()) {
        texts[key.name] = key.value;
    }
    return texts;
}

/// The physics that a scene has beside its scheme, by name and by key; empty for a laminar scene.
template <int Dim>
Assignments texts_of_physics(const Simulation<Dim>& simulation) {
    Assignments texts;
    const auto add = [&texts](const std::string& kind, std::string_view name, const Settings& settings) {
        texts[kind] = name;
        for (const auto& [key, text] : texts_of(settings)) {
            texts[std::string(kind).append(".").append(key)] = text;
        }
    };
    if (simulation.turbulence) {
        add("turbulence", simulation.turbulence->model->name, simulation.turbulence->settings);
    }
    if (simulation.wall_friction) {
        add("wall_function", simulation.wall_friction->function->name, simulation.wall_friction->settings);
    }
    if (simulation.flow_driver) {
        texts["flow_driver.direction"] = std::to_string(simulation.flow_driver->direction);
        texts["flow_driver.bulk_velocity"] = shortest(simulation.flow_driver->bulk_velocity);
    }
    return texts;
}

// ---- writing

void write_texts(const Group& group, const Assignments& texts) {
    for (const auto& [name, text] : texts) {
        group.set_attribute(name, text);
    }
}

template <int Dim>
void write_scene(const Group& group, const Simulation<Dim>& simulation) {
    for (const auto& [name, member] : constants<Dim>) {
        group.set_attribute(name, simulation.*member);
    }
    group.create_dataset("box_low", all(listed(simulation.box.low)));
    group.create_dataset("box_high", all(listed(simulation.box.high)));
    group.create_dataset("box_periodic", all(periodic_flags(simulation.box)));
}

template <int Dim>
void write_field(const Group& group, const Field& field, std::size_t count) {
    const std::size_t columns = stored_components<Dim>(field);
    std::vector<double> rows(count * columns, 0.0);
    for (std::size_t c = 0; c < field.components.size(); ++c) {
        for (std::size_t i = 0; i < count; ++i) {
            rows[i * columns + c] = field.components[c][i];
        }
    }
    group.create_dataset(field.name, all(rows), columns);
}

template <int Dim>
void write_particles(const Group& group, const Particles<Dim>& particles) {
    const std::vector<std::int64_t> id(particles.id.begin(), particles.id.end());
    group.create_dataset("id", all(id));
    for (const Field& field : particles.fields()) {
        if (field.lifetime == Lifetime::state) {
            write_field<Dim>(group, field, particles.size());
        }
    }
}

template <int Dim>
void write_stages(const Group& group, const std::vector<Stage<Dim>>& stages) {
    std::vector<std::string> names;
    std::vector<std::int64_t> pair_evaluations;
    for (const Stage<Dim>& stage : stages) {
        names.push_back(stage.name);
        pair_evaluations.push_back(stage.pair_evaluations);
    }
    group.create_dataset("name", all(names));
    group.create_dataset("pair_evaluations", all(pair_evaluations));
}

template <int Dim>
void write_physics(const Group& root, const Simulation<Dim>& simulation) {
    const Assignments texts = texts_of_physics(simulation);
    if (!texts.empty()) {
        write_texts(root.create_group("physics"), texts);
    }
    if (simulation.flow_driver) {
        const FlowDriver& driver = *simulation.flow_driver;
        const Group group = root.create_group("flow_driver");
        group.set_attribute("force", simulation.body_force[driver.direction]);
        group.set_attribute("previous_error", driver.previous_error);
        group.set_attribute("started", static_cast<std::int64_t>(driver.started));
    }
}

// ---- reading

Group open_snapshot(const std::filesystem::path& path) {
    Group root = storage::open_hdf5(path);
    if (!root.has_attribute("format") || root.attribute_kind("format") != storage::Kind::text ||
        root.attribute<std::string>("format") != format_name) {
        root.refuse("not a snapshot of sphvv (its attribute 'format' is not \"" + std::string(format_name) +
                    "\")");
    }
    const auto version = root.attribute<std::int64_t>("format_version");
    if (version < 1 || version > snapshot_version) {
        root.refuse("written by another sphvv (format version " + std::to_string(version) +
                    "; this one reads up to " + std::to_string(snapshot_version) + ")");
    }
    return root;
}

Assignments read_texts(const Group& group) {
    Assignments texts;
    for (const std::string& name : group.attribute_names()) {
        texts[name] = group.attribute<std::string>(name);
    }
    return texts;
}

/// Refuses a snapshot of another scene.
[[noreturn]] void refuse_scene(const Group& root, const std::string& what, const std::string& stored,
                               const std::string& here) {
    root.refuse("the snapshot is of another scene: its " + what + " is " + stored + ", that of this run is " +
                here);
}

void check_texts(const Group& root, const Assignments& stored, const Assignments& here) {
    for (const auto& [name, text] : here) {
        const auto found = stored.find(name);
        if (found == stored.end() || found->second != text) {
            refuse_scene(root, name, found == stored.end() ? "not given" : "'" + found->second + "'",
                         "'" + text + "'");
        }
    }
}

template <class T>
void check_equal(const Group& root, const std::string& what, const std::vector<T>& stored,
                 const std::vector<T>& here) {
    const auto tuple = [](const std::vector<T>& values) {
        std::string list;
        for (const T value : values) {
            list += (list.empty() ? "" : ", ") + shortest(static_cast<double>(value));
        }
        return values.size() == 1 ? list : "(" + list + ")";
    };
    if (stored != here) {
        refuse_scene(root, what, tuple(stored), tuple(here));
    }
}

/// What the user chose is compared before what follows from it.
template <int Dim>
void check_scene(const Group& root, const Simulation<Dim>& simulation, const Assignments& metadata) {
    using Integers = std::vector<std::int64_t>;
    check_texts(root, read_texts(root.group("metadata")), metadata);
    check_equal(root, "dimension", Integers{root.attribute<std::int64_t>("dimension")}, Integers{Dim});
    check_texts(root, read_texts(root.group("settings")), texts_of(simulation.settings));
    check_equal(root, "number of particles", Integers{root.attribute<std::int64_t>("particles")},
                Integers{static_cast<std::int64_t>(simulation.particles.size())});
    check_texts(root, root.has_member("physics") ? read_texts(root.group("physics")) : Assignments{},
                texts_of_physics(simulation));
    const Group scene = root.group("scene");
    for (const auto& [name, member] : constants<Dim>) {
        check_equal(root, name, {scene.attribute<double>(name)}, std::vector<double>{simulation.*member});
    }
    check_equal(root, "box_low", scene.dataset<double>("box_low"), listed(simulation.box.low));
    check_equal(root, "box_high", scene.dataset<double>("box_high"), listed(simulation.box.high));
    check_equal(root, "box_periodic", scene.dataset<std::uint8_t>("box_periodic"),
                periodic_flags(simulation.box));
}

std::string listing(const std::vector<std::string>& names) {
    std::string list;
    for (const std::string& name : names) {
        list += (list.empty() ? "" : ", ") + name;
    }
    return list;
}

/// Both ways: a field that this run lacks is a sign of another scheme as well.
template <int Dim>
void check_fields(const Group& root, const Particles<Dim>& particles) {
    std::vector<std::string> here{"id"};
    for (const Field& field : particles.fields()) {
        if (field.lifetime == Lifetime::state) {
            here.push_back(field.name);
        }
    }
    std::vector<std::string> stored = root.group("particles").member_names();
    std::sort(here.begin(), here.end());
    std::sort(stored.begin(), stored.end());
    if (stored != here) {
        refuse_scene(root, "list of state fields", listing(stored), listing(here));
    }
}

/// The components of a field, checked against those that this run has.
template <int Dim>
std::vector<std::vector<double>> read_field(const Group& group, const Field& field, std::size_t count) {
    const std::size_t columns = stored_components<Dim>(field);
    const storage::Extent extent = group.extent(field.name);
    if (extent.rows != count || extent.columns != columns) {
        group.refuse(group.place() + "/" + field.name + " is " + std::to_string(extent.rows) + " × " +
                     std::to_string(extent.columns) + ", where " + std::to_string(count) + " × " +
                     std::to_string(columns) + " is needed");
    }
    const std::vector<double> rows = group.dataset<double>(field.name);
    std::vector<std::vector<double>> components(field.components.size(), std::vector<double>(count));
    for (std::size_t c = 0; c < components.size(); ++c) {
        for (std::size_t i = 0; i < count; ++i) {
            components[c][i] = rows[i * columns + c];
        }
    }
    return components;
}

/// Identities are a permutation of 0 … N-1.
std::vector<int> read_identity(const Group& group, std::size_t count) {
    const std::vector<std::int64_t> stored = group.dataset<std::int64_t>("id");
    std::vector<char> seen(count, 0);
    for (const std::int64_t id : stored) {
        if (stored.size() != count || id < 0 || id >= static_cast<std::int64_t>(count) || seen[id]++ != 0) {
            group.refuse(group.place() + "/id does not name every particle once");
        }
    }
    std::vector<int> id(count);
    std::transform(stored.begin(), stored.end(), id.begin(),
                   [](std::int64_t i) { return static_cast<int>(i); });
    return id;
}

/// The driver as it was, and its component of the body force (m/s2).
struct DriverState {
    FlowDriver driver;
    double force;
};

template <int Dim>
std::optional<DriverState> read_driver(const Group& root, const Simulation<Dim>& simulation) {
    if (!simulation.flow_driver) {
        return std::nullopt;
    }
    const Group group = root.group("flow_driver");
    DriverState state{*simulation.flow_driver, group.attribute<double>("force")};
    state.driver.previous_error = group.attribute<double>("previous_error");
    state.driver.started = group.attribute<std::int64_t>("started") != 0;
    return state;
}

template <int Dim>
std::vector<std::int64_t> read_stages(const Group& root, const std::vector<Stage<Dim>>& stages) {
    const Group group = root.group("stages");
    std::vector<std::string> here(stages.size());
    std::transform(stages.begin(), stages.end(), here.begin(),
                   [](const Stage<Dim>& stage) { return stage.name; });
    const std::vector<std::string> stored = group.dataset<std::string>("name");
    std::vector<std::int64_t> pair_evaluations = group.dataset<std::int64_t>("pair_evaluations");
    if (stored != here || pair_evaluations.size() != here.size()) {
        refuse_scene(root, "list of stages", listing(stored), listing(here));
    }
    return pair_evaluations;
}

} // namespace

template <int Dim>
void write_snapshot(const Simulation<Dim>& simulation, const Assignments& metadata,
                    const std::filesystem::path& path) {
    storage::write_hdf5(path, [&](const Group& root) {
        root.set_attribute<std::string>("format", format_name);
        root.set_attribute("format_version", snapshot_version);
        root.set_attribute<std::int64_t>("dimension", Dim);
        root.set_attribute("particles", static_cast<std::int64_t>(simulation.particles.size()));
        root.set_attribute("step", simulation.step);
        root.set_attribute("end_time", simulation.end_time);
        for (const auto& [name, member] : progress<Dim>) {
            root.set_attribute(name, simulation.*member);
        }
        write_texts(root.create_group("metadata"), metadata);
        write_texts(root.create_group("settings"), texts_of(simulation.settings));
        write_scene(root.create_group("scene"), simulation);
        write_physics(root, simulation);
        const Group work = root.create_group("work");
        for (const auto& [name, member] : counters) {
            work.set_attribute(name, simulation.work.*member);
        }
        write_stages(root.create_group("stages"), simulation.stages);
        write_particles(root.create_group("particles"), simulation.particles);
    });
}

template <int Dim>
void read_snapshot(Simulation<Dim>& simulation, const Assignments& metadata,
                   const std::filesystem::path& path) {
    const Group root = open_snapshot(path);
    check_scene(root, simulation, metadata);
    check_fields(root, simulation.particles);
    // All is read before anything is changed.
    const std::vector<std::int64_t> pair_evaluations = read_stages(root, simulation.stages);
    const Group particles = root.group("particles");
    const std::size_t count = simulation.particles.size();
    std::vector<int> id = read_identity(particles, count);
    std::vector<std::pair<Field*, std::vector<std::vector<double>>>> state;
    for (Field& field : simulation.particles.fields()) {
        if (field.lifetime == Lifetime::state) {
            state.emplace_back(&field, read_field<Dim>(particles, field, count));
        }
    }
    Work work;
    for (const auto& [name, member] : counters) {
        work.*member = root.group("work").attribute<std::int64_t>(name);
    }
    std::array<double, progress<Dim>.size()> reached{};
    std::transform(progress<Dim>.begin(), progress<Dim>.end(), reached.begin(),
                   [&](const auto& entry) { return root.attribute<double>(entry.first); });
    const auto step = root.attribute<std::int64_t>("step");
    const std::optional<DriverState> driven = read_driver(root, simulation);

    // Images are of particles that are elsewhere now; the next search for neighbours makes new ones.
    simulation.images = {};
    simulation.particles.set_images(0);
    simulation.step = step;
    simulation.work = work;
    simulation.particles.id = std::move(id);
    for (auto& [field, components] : state) {
        field->components = std::move(components);
    }
    for (std::size_t k = 0; k < reached.size(); ++k) {
        simulation.*(progress<Dim>[k].second) = reached[k];
    }
    if (driven) {
        simulation.flow_driver = driven->driver;
        simulation.body_force[driven->driver.direction] = driven->force;
    }
    for (std::size_t k = 0; k < simulation.stages.size(); ++k) {
        simulation.stages[k].pair_evaluations = pair_evaluations[k];
    }
}

SnapshotHeader read_snapshot_header(const std::filesystem::path& path) {
    const Group root = open_snapshot(path);
    return {static_cast<int>(root.attribute<std::int64_t>("dimension")),
            root.attribute<std::int64_t>("particles"),
            root.attribute<std::int64_t>("step"),
            root.attribute<double>("time"),
            root.attribute<double>("end_time"),
            read_texts(root.group("settings")),
            read_texts(root.group("metadata"))};
}

#define SPHVV_INSTANTIATE(Dim)                                                                               \
    template void write_snapshot(const Simulation<Dim>&, const Assignments&, const std::filesystem::path&);  \
    template void read_snapshot(Simulation<Dim>&, const Assignments&, const std::filesystem::path&);
SPHVV_INSTANTIATE(2)
SPHVV_INSTANTIATE(3)
#undef SPHVV_INSTANTIATE

} // namespace sphvv::solver
