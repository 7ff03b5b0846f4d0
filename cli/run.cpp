#include "sphvv/verification/run.hpp"

#include "sphvv/solver/snapshots/snapshot.hpp"
#include "sphvv/solver/snapshots/xdmf.hpp"
#include "sphvv/solver/storage/trial_reading.hpp"

#include "commands.hpp"
#include "output.hpp"
#include "scene_file.hpp"
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>

namespace sphvv::cli {
namespace {

using verification::SceneRecord;
using Tree = nlohmann::ordered_json;

struct Options {
    Common common;
    std::string flow;
    std::string scheme;
    int n = 0;
    std::vector<std::string> settings;
    std::string scene_file;
    int threads = 0;
    std::string out;
    double every = 0;
    std::string resume;
    bool dry_run = false;
};

/// n or seed, within what a scene file and the command line accept.
int count_of(const std::string& text, const std::string& what) {
    const double value = solver::parse_number(text, what);
    if (value < 1 || value > 1e6 || value != std::floor(value)) {
        throw UserError(what + ": " + text + " is not an integer from 1 to 1000000");
    }
    return static_cast<int>(value);
}

/// The description that a snapshot carries.
SceneDescription read_snapshot_scene(const std::string& path) {
    SceneDescription description;
    solver::storage::read_in_trial(path);
    const solver::SnapshotHeader header = solver::read_snapshot_header(path);
    description.settings["end_time"] = solver::shortest(header.end_time);
    for (const auto& [key, value] : header.metadata) {
        if (key == "case") {
            description.flow = value;
        } else if (key == "scheme") {
            description.scheme = value;
        } else if (key == "n") {
            description.n = count_of(value, path + ": n");
        } else if (key == "seed") {
            description.seed = count_of(value, path + ": seed");
        } else if (key.starts_with("set.")) {
            description.settings[key.substr(4)] = value;
        }
    }
    return description;
}

/// What the command line says is laid over what the scene file or the snapshot says.
SceneDescription describe(const Options& options) {
    SceneDescription description{"", "isph_dfs", 40, 1, {}};
    if (!options.scene_file.empty()) {
        const SceneDescription file = read_scene_file(options.scene_file);
        description = {file.flow, file.scheme.empty() ? description.scheme : file.scheme,
                       file.n > 0 ? file.n : description.n, file.seed, file.settings};
    }
    if (!options.resume.empty()) {
        description = read_snapshot_scene(options.resume);
    }
    const solver::Assignments given = parse_assignments(options.settings);
    if (!options.resume.empty()) {
        const bool other = (!options.flow.empty() && options.flow != description.flow) ||
                           (!options.scheme.empty() && options.scheme != description.scheme) ||
                           (options.n > 0 && options.n != description.n) || !options.scene_file.empty();
        if (other || (given.size() > given.count("end_time"))) {
            throw UserError("--resume: '" + options.resume + "' is " + description.flow + " with " +
                            description.scheme + " at n = " + std::to_string(description.n) +
                            "; only end_time may be set anew");
        }
    }
    description.flow = options.flow.empty() ? description.flow : options.flow;
    description.scheme = options.scheme.empty() ? description.scheme : options.scheme;
    description.n = options.n > 0 ? options.n : description.n;
    for (const auto& [key, value] : given) {
        description.settings[key] = value;
    }
    if (description.flow.empty()) {
        throw UserError("give a case; accepted: " + solver::names_of(verification::cases::all()));
    }
    return description;
}

SceneRecord scene_of(const SceneDescription& description) {
    SceneRecord scene =
        resolve_scene(verification::cases::find(description.flow),
                      verification::variant_of(description.scheme), description.settings, description.n);
    scene.seed = static_cast<std::uint64_t>(description.seed);
    check_scene(scene);
    return scene;
}

/// What identifies a scene in its snapshots. The end time is left out: a run may be resumed to go on for
/// longer.
solver::Assignments metadata_of(const SceneRecord& scene) {
    solver::Assignments metadata{{"case", std::string(scene.flow->name)},
                                 {"scheme", std::string(scene.scheme->name)},
                                 {"n", std::to_string(scene.n)},
                                 {"seed", std::to_string(scene.seed)}};
    for (const solver::Settings* settings : {&scene.case_settings, &scene.scheme_settings}) {
        for (const solver::Key& key : settings->keys()) {
            if (key.name != "end_time") {
                metadata["set." + key.name] = key.value;
            }
        }
    }
    return metadata;
}

template <int Dim>
Tree dry_run(const SceneRecord& scene) {
    solver::Simulation<Dim> simulation = build_scene<Dim>(scene);
    simulation.stages.front().run(simulation); // every scheme begins by choosing its time step
    Tree settings = Tree::object();
    for (const auto& [key, value] : metadata_of(scene)) {
        settings[key] = value;
    }
    settings["set.end_time"] = scene.case_settings.text("end_time");
    Tree stages = Tree::array();
    for (const auto& stage : simulation.stages) {
        stages.push_back(stage.name);
    }
    Tree fields = Tree::object();
    for (const solver::Field& field : simulation.particles.fields()) {
        fields[field.name] = field.bytes_per_particle();
    }
    return {{"scene", settings},
            {"particles", simulation.particles.size()},
            {"dx", simulation.particle_spacing},
            {"h", simulation.smoothing_length},
            {"first_time_step", simulation.time_step},
            {"estimated_steps", std::ceil(simulation.end_time / simulation.time_step)},
            {"stages", stages},
            {"bytes_per_particle", simulation.particles.bytes_per_particle()},
            {"fields", fields}};
}

/// State after the last good step, kept so that a run that diverges leaves it on disk.
template <int Dim>
struct GoodState {
    std::vector<int> id;
    std::vector<std::vector<std::vector<double>>> fields;
    double time = 0;
    double time_step = 0;
    double maximum_acceleration = 0;
    std::int64_t step = 0;

    void take(const solver::Simulation<Dim>& simulation) {
        id = simulation.particles.id;
        fields.resize(simulation.particles.fields().size());
        std::size_t k = 0;
        for (const solver::Field& field : simulation.particles.fields()) {
            if (field.lifetime == solver::Lifetime::state) {
                fields[k] = field.components;
            }
            ++k;
        }
        time = simulation.time;
        time_step = simulation.time_step;
        maximum_acceleration = simulation.maximum_acceleration;
        step = simulation.step;
    }

    void give_back(solver::Simulation<Dim>& simulation) const {
        simulation.particles.id = id;
        std::size_t k = 0;
        for (solver::Field& field : simulation.particles.fields()) {
            if (field.lifetime == solver::Lifetime::state) {
                field.components = fields[k];
            }
            ++k;
        }
        simulation.time = time;
        simulation.time_step = time_step;
        simulation.maximum_acceleration = maximum_acceleration;
        simulation.step = step;
    }
};

/// Snapshots at regular times beside the final one, numbered by these times, and the XDMF file that strings
/// them together.
class Frames {
public:
    Frames(std::string out, double every) : out_(std::move(out)), every_(every) {}

    /// Goes on after those that a run of the same scene has left until the time t (s).
    void resume(const solver::Assignments& metadata, double t) {
        if (every_ <= 0) {
            return;
        }
        next_ = time_after(t);
        for (std::size_t k = 0; static_cast<double>(k) * every_ < next_ - every_ / 2; ++k) {
            try {
                const std::filesystem::path file = path_of(k);
                solver::storage::read_in_trial(file);
                const auto header = solver::read_snapshot_header(file);
                if (header.metadata == metadata && header.time <= t) {
                    frames_.push_back(solver::xdmf_frame(file));
                }
            } catch (const UserError&) {
                continue; // none, or none that can be read: the sequence is shorter by it
            }
        }
    }

    template <int Dim>
    void save_if_due(const solver::Simulation<Dim>& simulation, const solver::Assignments& metadata) {
        if (every_ <= 0 || simulation.time < next_) {
            return;
        }
        next_ = time_after(simulation.time);
        save(simulation, metadata, path_of(static_cast<std::size_t>(std::lround(next_ / every_)) - 1));
    }

    template <int Dim>
    void save(const solver::Simulation<Dim>& simulation, const solver::Assignments& metadata,
              const std::filesystem::path& file) {
        write_snapshot(simulation, metadata, file);
        frames_.push_back(solver::xdmf_frame(file));
        solver::write_xdmf(std::filesystem::path(out_).replace_extension(".xdmf"), frames_);
    }

private:
    double time_after(double t) const { return every_ * (std::floor(t / every_ + 1e-9) + 1); }

    std::filesystem::path path_of(std::size_t frame) const {
        std::filesystem::path file(out_);
        char number[32];
        std::snprintf(number, sizeof number, "_%05zu", frame);
        return file.replace_filename(file.stem().string() + number + ".h5");
    }

    std::string out_;
    double every_;
    double next_ = 0;
    std::vector<solver::XdmfFrame> frames_;
};

std::string summary(const verification::RunRecord& record, const std::string& out) {
    char text[256];
    std::snprintf(text, sizeof text,
                  "%zu particles, %lld steps to t = %.6g s in %.3g s: %.3g million particle-steps/s\n",
                  record.particles, static_cast<long long>(record.steps), record.time, record.seconds,
                  static_cast<double>(record.work.particle_steps) / record.seconds / 1e6);
    std::string lines = text;
    for (const verification::FieldError& error : record.errors) {
        std::snprintf(text, sizeof text, "%s error (%s): L1 %.3e  L2 %.3e  Linf %.3e\n", error.field.c_str(),
                      error.norms.relative ? "relative" : "absolute", error.norms.l1, error.norms.l2,
                      error.norms.linf);
        lines += text;
    }
    if (!record.diagnosis.empty()) {
        lines += "ended early: " + record.diagnosis + "\nlast good state in " + out + "\n";
    }
    std::snprintf(text, sizeof text, "%-20s %10s %8s\n", "stage", "seconds", "share");
    lines += text;
    for (const auto& stage : record.stages) {
        std::snprintf(text, sizeof text, "%-20s %10.3f %7.1f%%\n", stage.name.c_str(), stage.seconds,
                      100 * stage.seconds / record.seconds);
        lines += text;
    }
    std::snprintf(text, sizeof text, "%.0f bytes per particle:", record.bytes_per_particle);
    lines += text;
    for (const auto& field : record.fields) {
        lines += " " + field.name;
    }
    std::snprintf(
        text, sizeof text,
        "\n%.0f bytes per particle of the neighbour list, %.0f of what else is kept for every pair\n",
        record.neighbour_bytes_per_particle, record.pair_bytes_per_particle);
    return lines + text;
}

Tree summary_tree(const SceneRecord& scene, const verification::RunRecord& record) {
    Tree errors = Tree::object();
    for (const verification::FieldError& error : record.errors) {
        errors[error.field] = {{"l1", error.norms.l1},         {"l2", error.norms.l2},
                               {"linf", error.norms.linf},     {"l1_abs", error.norms.l1_abs},
                               {"l2_abs", error.norms.l2_abs}, {"linf_abs", error.norms.linf_abs}};
    }
    Tree settings = Tree::object();
    for (const auto& [key, value] : metadata_of(scene)) {
        settings[key] = value;
    }
    return {{"scene", settings},
            {"particles", record.particles},
            {"survived", record.survived},
            {"diagnosis", record.diagnosis},
            {"time", record.time},
            {"steps", record.steps},
            {"seconds", record.seconds},
            {"work",
             {{"pair_evaluations", record.work.pair_evaluations},
              {"solver_iterations", record.work.solver_iterations},
              {"matrix_entries", record.work.matrix_entries},
              {"particle_steps", record.work.particle_steps}}},
            {"bytes_per_particle", record.bytes_per_particle},
            {"neighbour_bytes_per_particle", record.neighbour_bytes_per_particle},
            {"pair_bytes_per_particle", record.pair_bytes_per_particle},
            {"errors", errors}};
}

template <int Dim>
int simulate(const SceneRecord& scene, const Options& options) {
    const std::string out = options.out.empty() ? std::string(scene.flow->name) + ".h5" : options.out;
    check_writable(out, "--out");
    solver::Simulation<Dim> simulation = build_scene<Dim>(scene);
    const solver::Assignments metadata = metadata_of(scene);
    if (!options.resume.empty()) {
        read_snapshot(simulation, metadata, options.resume);
        if (simulation.time >= simulation.end_time) {
            throw UserError("--resume: '" + options.resume +
                            "' is at t = " + solver::shortest(simulation.time) +
                            " s already; set a later end_time than " + solver::shortest(simulation.end_time));
        }
    }
    remember_signals();
    Frames frames(out, options.every);
    if (!options.resume.empty()) {
        frames.resume(metadata, simulation.time);
    }
    GoodState<Dim> good;
    good.take(simulation);
    frames.save_if_due(simulation, metadata);
    ProgressLine line(options.common.quiet);
    const std::string what = std::string(scene.flow->name) + "  " + std::string(scene.scheme->name) +
                             "  n = " + std::to_string(scene.n);
    verification::RunRecord record;
    try {
        record = step_to_end(simulation, scene, [&](double fraction) {
            good.take(simulation);
            frames.save_if_due(simulation, metadata);
            line.update(what, fraction);
            stop_if_signalled();
        });
    } catch (const Interrupted&) {
        frames.save(simulation, metadata, out);
        throw;
    }
    if (!record.survived) {
        good.give_back(simulation);
    }
    frames.save(simulation, metadata, out);
    if (!options.common.json.empty()) {
        write_text(options.common.json, summary_tree(scene, record).dump(2) + "\n");
    }
    if (options.common.json != "-") {
        std::cout << summary(record, out);
    }
    return record.survived ? 0 : 3;
}

int run(const Options& options) {
    use_threads(options.threads);
    const SceneRecord scene = scene_of(describe(options));
    const bool flat = dimension(scene) == 2;
    if (options.dry_run) {
        const Tree plan = flat ? dry_run<2>(scene) : dry_run<3>(scene);
        write_text(options.common.json.empty() ? "-" : options.common.json, plan.dump(2) + "\n");
        return 0;
    }
    check_writable(options.common.json, "--json");
    return flat ? simulate<2>(scene, options) : simulate<3>(scene, options);
}

} // namespace

void add_run(CLI::App& app, Act& act) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "run", "one simulation, with snapshots that ParaView opens and that can be resumed");
    command->add_option("case", options->flow, "case (see sphvv list cases)");
    command->add_option("--scheme", options->scheme, "scheme (default isph_dfs)");
    command->add_option("--n", options->n, "particle spacings along the reference length (default 40)")
        ->check(CLI::Range(1, 1000000));
    command->add_option("--set", options->settings, "KEY=VALUE of the case or of the scheme; may be repeated")
        ->expected(1)
        ->take_all();
    command
        ->add_option("--scene", options->scene_file,
                     "scene description with case, scheme, n, seed and a table [set]")
        ->type_name("FILE.toml");
    command->add_option("--threads", options->threads, "threads (default: all processors)");
    command
        ->add_option("--out", options->out,
                     "final, resumable snapshot (default CASE.h5), with an XDMF file beside it")
        ->type_name("FILE.h5");
    command->add_option("--every", options->every, "a snapshot every T seconds of flow")
        ->type_name("T")
        ->check(CLI::PositiveNumber);
    command
        ->add_option("--resume", options->resume,
                     "go on from a snapshot; gives the same bits as a run that was not stopped")
        ->type_name("FILE.h5");
    command->add_flag("--dry-run", options->dry_run,
                      "print the resolved scene, stages, bytes per particle and steps; run nothing");
    add_common(*command, options->common);
    command->footer(
        "Example: sphvv run taylor_green --scheme isph_dfs --n 40 --set re=100 --every 0.1 --out tg.h5");
    command->callback([options, &act] { act = [options] { return run(*options); }; });
}

} // namespace sphvv::cli
