#include "sphvv/solver/error.hpp"
#include "sphvv/solver/schemes.hpp"
#include "sphvv/solver/snapshots/snapshot.hpp"
#include "sphvv/solver/snapshots/xdmf.hpp"
#include "sphvv/solver/storage/hdf5.hpp"
#include "sphvv/solver/tests/temporary_folder.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <random>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <sys/resource.h>
#include <unistd.h>
#include <vector>

namespace {

using namespace sphvv::solver;
using sphvv::UserError;
using sphvv::tests::content;
using sphvv::tests::expect_mentions;
using sphvv::tests::put;
using sphvv::tests::refusal;
using storage::Group;
using storage::open_hdf5;
using storage::write_hdf5;
namespace fs = std::filesystem;

const Assignments metadata{{"case", "vortices"}, {"n", "16"}};

class Snapshots : public sphvv::tests::TemporaryFolder {
protected:
    const fs::path path = folder / "s.h5";
};

/// Decaying vortices from a jittered lattice in the periodic unit box.
template <int Dim>
std::unique_ptr<Simulation<Dim>> vortices(const std::string& scheme_name, int n,
                                          const Assignments& given = {}, unsigned seed = 1) {
    const Scheme& scheme = schemes::find(scheme_name);
    Box<Dim> box;
    box.high.fill(1);
    box.periodic.fill(true);
    const auto count = static_cast<std::size_t>(std::lround(std::pow(n, Dim)));
    auto simulation = std::make_unique<Simulation<Dim>>(box, count);
    simulation->settings = Settings(scheme.keys, given);
    simulation->kernel = &kernels::find(simulation->settings.word("kernel"));
    simulation->particle_spacing = 1.0 / n;
    simulation->smoothing_length = simulation->settings.number("h_over_dx") / n;
    simulation->density = 1;
    simulation->kinematic_viscosity = 0.01;
    simulation->reference_speed = 1;
    simulation->particle_mass = std::pow(n, -Dim);
    simulation->end_time = 1;
    std::mt19937_64 engine(seed);
    std::uniform_real_distribution<double> jitter(0.45, 0.55);
    constexpr double k = 2 * std::numbers::pi;
    for (std::size_t i = 0; i < count; ++i) {
        std::array<double, Dim> x{};
        std::size_t rest = i;
        for (int d = 0; d < Dim; ++d) {
            x[d] = (static_cast<double>(rest % n) + jitter(engine)) / n;
            rest /= n;
            simulation->particles.position[d][i] = x[d];
        }
        simulation->particles.velocity[0][i] = -std::cos(k * x[0]) * std::sin(k * x[1]);
        simulation->particles.velocity[1][i] = std::sin(k * x[0]) * std::cos(k * x[1]);
        if constexpr (Dim == 3) {
            simulation->particles.velocity[2][i] = 0.3 * std::sin(k * x[0]);
        }
    }
    scheme.assemble(*simulation);
    return simulation;
}

template <int Dim>
void advance_by(Simulation<Dim>& simulation, int steps) {
    for (int k = 0; k < steps; ++k) {
        advance(simulation);
    }
}

/// Copies a file, each member as `change` wants it: given the place, it copies (false) or deals with it
/// (true).
using Change = std::function<bool(const std::string& place, const Group& from, const Group& to)>;

template <class T>
void copy_dataset(const Group& from, const Group& to, const std::string& name) {
    const std::vector<T> values = from.dataset<T>(name);
    to.create_dataset(name, std::span<const T>(values), from.extent(name).columns);
}

void copy(const Group& from, const Group& to, const Change& change) {
    const std::string prefix = from.place() == "/" ? "/" : from.place() + "/";
    for (const std::string& name : from.attribute_names()) {
        if (change(prefix + name, from, to)) {
            continue;
        }
        const storage::Kind kind = from.attribute_kind(name);
        if (kind == storage::Kind::text) {
            to.set_attribute(name, from.attribute<std::string>(name));
        } else if (kind == storage::Kind::real) {
            to.set_attribute(name, from.attribute<double>(name));
        } else {
            to.set_attribute(name, from.attribute<std::int64_t>(name));
        }
    }
    for (const std::string& name : from.member_names()) {
        if (change(prefix + name, from, to)) {
            continue;
        }
        if (from.is_group(name)) {
            copy(from.group(name), to.create_group(name), change);
        } else if (from.extent(name).kind == storage::Kind::text) {
            copy_dataset<std::string>(from, to, name);
        } else if (from.extent(name).kind == storage::Kind::real) {
            copy_dataset<double>(from, to, name);
        } else {
            copy_dataset<std::int64_t>(from, to, name);
        }
    }
}

void copy_changed(const fs::path& from, const fs::path& to, const Change& change) {
    const Group source = open_hdf5(from);
    write_hdf5(to, [&](const Group& root) { copy(source, root, change); });
}

void copy_without(const fs::path& from, const fs::path& to, const std::string& member) {
    copy_changed(from, to,
                 [&](const std::string& place, const Group&, const Group&) { return place == member; });
}

// ---- stopping and going on

template <int Dim>
void expect_same_bits(const Simulation<Dim>& a, const Simulation<Dim>& b) {
    EXPECT_EQ(a.particles.id, b.particles.id);
    int compared = 0;
    for (const Field& field : a.particles.fields()) {
        for (std::size_t c = 0; field.lifetime == Lifetime::state && c < field.components.size(); ++c) {
            const std::vector<double>& other = b.particles.find(field.name)->components[c];
            ASSERT_EQ(field.components[c].size(), other.size());
            EXPECT_EQ(std::memcmp(field.components[c].data(), other.data(), other.size() * sizeof(double)), 0)
                << field.name << ' ' << c;
            ++compared;
        }
    }
    EXPECT_GT(compared, 2 * Dim);
    EXPECT_EQ(a.time, b.time);
    EXPECT_EQ(a.step, b.step);
    EXPECT_EQ(a.time_step, b.time_step);
    EXPECT_EQ(a.maximum_acceleration, b.maximum_acceleration);
    EXPECT_EQ(a.work.pair_evaluations, b.work.pair_evaluations);
    EXPECT_EQ(a.work.solver_iterations, b.work.solver_iterations);
    EXPECT_EQ(a.work.matrix_entries, b.work.matrix_entries);
    EXPECT_EQ(a.work.particle_steps, b.work.particle_steps);
    ASSERT_EQ(a.stages.size(), b.stages.size());
    for (std::size_t k = 0; k < a.stages.size(); ++k) {
        EXPECT_EQ(a.stages[k].pair_evaluations, b.stages[k].pair_evaluations) << a.stages[k].name;
    }
}

/// Twenty steps, against ten, a snapshot, and ten more in a simulation that was built anew (from another
/// start, so that nothing it has by itself can help), on another number of threads.
template <int Dim>
void expect_resumes(const std::string& scheme, int n, const Assignments& given, const fs::path& path) {
    SCOPED_TRACE(scheme + " in " + std::to_string(Dim) + "-D");
    const int threads = omp_get_max_threads();
    const auto whole = vortices<Dim>(scheme, n, given);
    advance_by(*whole, 20);
    const auto first = vortices<Dim>(scheme, n, given);
    advance_by(*first, 10);
    write_snapshot(*first, metadata, path);
    omp_set_num_threads(threads == 1 ? 2 : 1);
    const auto second = vortices<Dim>(scheme, n, given, 2);
    advance_by(*second, 3);
    read_snapshot(*second, metadata, path);
    expect_same_bits(*first, *second);
    advance_by(*second, 10);
    omp_set_num_threads(threads);
    expect_same_bits(*whole, *second);
    write_snapshot(*whole, metadata, path);
    const std::string expected = content(path);
    write_snapshot(*second, metadata, path);
    EXPECT_TRUE(content(path) == expected) << "snapshots of equal states differ";
}

TEST_F(Snapshots, AResumedRunGivesTheSameBits) {
    for (const Scheme* scheme : schemes::all()) {
        expect_resumes<2>(std::string(scheme->name), 16, {}, path);
        expect_resumes<3>(std::string(scheme->name), 10, {}, path);
    }
}

TEST_F(Snapshots, AResumedRunGivesTheSameBitsWithOtherSettings) {
    expect_resumes<2>("wcsph", 16, {{"integrator", "predictor_corrector"}, {"viscous_limit", "10"}}, path);
    expect_resumes<2>("wcsph", 16, {{"integrator", "verlet"}, {"restart_interval", "7"}}, path);
    expect_resumes<3>("wcsph", 10, {{"continuity", "renormalised"}, {"pressure_force", "hybrid_taylor"}},
                      path);
    expect_resumes<2>("isph_dfs", 16, {{"laplacian", "schwaiger"}, {"shift_correction", "none"}}, path);
    expect_resumes<2>("isph_df", 16,
                      {{"gradient", "plain"}, {"preconditioner", "jacobi"}, {"time_step", "0.002"}}, path);
}

TEST_F(Snapshots, KeepsEveryBitOfEveryValue) {
    const auto written = vortices<2>("wcsph", 10);
    Field& strange = written->particles.field("strange", 5, Lifetime::state, "test");
    std::mt19937_64 engine(3);
    for (std::vector<double>& component : strange.components) {
        for (double& value : component) {
            const std::uint64_t bits = engine();
            std::memcpy(&value, &bits, sizeof value); // not-a-numbers with payload among them
        }
    }
    written->time = 0.1 + 0.2;
    written->maximum_acceleration = 5e-324;
    written->work.pair_evaluations = INT64_MAX;
    write_snapshot(*written, metadata, path);
    const auto read = vortices<2>("wcsph", 10, {}, 2);
    read->particles.field("strange", 5, Lifetime::state, "test");
    read_snapshot(*read, metadata, path);
    expect_same_bits(*written, *read);
}

TEST_F(Snapshots, HoldsALargeNumberOfParticles) {
    const auto written = vortices<2>("isph_df", 300); // several chunks
    write_snapshot(*written, metadata, path);
    const auto read = vortices<2>("isph_df", 300, {}, 2);
    read_snapshot(*read, metadata, path);
    expect_same_bits(*written, *read);
}

// ---- layout

TEST_F(Snapshots, IsLaidOutAsDocumented) {
    const auto simulation = vortices<2>("wcsph", 10);
    simulation->particles.field("tensor", 4, Lifetime::state, "test");
    advance_by(*simulation, 2);
    write_snapshot(*simulation, metadata, path);
    const Group root = open_hdf5(path);
    EXPECT_EQ(root.attribute<std::string>("format"), "sphvv-snapshot");
    EXPECT_EQ(root.attribute<std::int64_t>("format_version"), 1);
    EXPECT_EQ(root.attribute<std::int64_t>("dimension"), 2);
    EXPECT_EQ(root.attribute<std::int64_t>("step"), 2);
    EXPECT_EQ(root.attribute<double>("time"), simulation->time);
    EXPECT_EQ(root.group("metadata").attribute<std::string>("case"), "vortices");
    EXPECT_EQ(root.group("settings").attribute<std::string>("gamma"), "7");
    EXPECT_EQ(root.group("work").attribute<std::int64_t>("particle_steps"), 200);
    EXPECT_EQ(root.group("scene").attribute<double>("particle_spacing"), 0.1);
    const Group particles = root.group("particles");
    using Names = std::vector<std::string>;
    EXPECT_EQ(particles.member_names(),
              (Names{"id", "position", "velocity", "density", "pressure", "tensor"}))
        << "state fields and nothing else";
    EXPECT_EQ(particles.extent("id").kind, storage::Kind::integer);
    EXPECT_EQ(particles.extent("pressure").columns, 1U);
    EXPECT_EQ(particles.extent("tensor").columns, 4U);
    const std::vector<double> position = particles.dataset<double>("position");
    ASSERT_EQ(position.size(), 300U);
    for (std::size_t i = 0; i < 100; ++i) {
        EXPECT_EQ(position[3 * i], simulation->particles.position[0][i]);
        EXPECT_EQ(position[3 * i + 1], simulation->particles.position[1][i]);
        EXPECT_EQ(position[3 * i + 2], 0.0);
    }
}

TEST_F(Snapshots, TheHeaderTellsTheScene) {
    const auto simulation = vortices<3>("isph_df", 8, {{"viscous_limit", "0.1"}});
    advance_by(*simulation, 1);
    write_snapshot(*simulation, metadata, path);
    const SnapshotHeader header = read_snapshot_header(path);
    EXPECT_EQ(header.dimension, 3);
    EXPECT_EQ(header.particles, 512);
    EXPECT_EQ(header.step, 1);
    EXPECT_EQ(header.time, simulation->time);
    EXPECT_EQ(header.end_time, 1.0);
    EXPECT_EQ(header.metadata, metadata);
    EXPECT_EQ(header.settings.at("viscous_limit"), "0.1");
    EXPECT_EQ(header.settings.size(), simulation->settings.keys().size());
}

// ---- snapshots that do not fit

/// The refusal of reading into a simulation, which must stay as it was.
template <int Dim>
std::string refusal_of(Simulation<Dim>& simulation, const fs::path& snapshot,
                       const Assignments& expected = metadata) {
    const fs::path before = snapshot.parent_path() / "before";
    const fs::path after = snapshot.parent_path() / "after";
    write_snapshot(simulation, expected, before);
    std::string message = refusal([&] { read_snapshot(simulation, expected, snapshot); });
    write_snapshot(simulation, expected, after);
    EXPECT_TRUE(content(before) == content(after)) << "changed by a snapshot that was refused";
    expect_mentions(message, {snapshot.string()});
    return message;
}

TEST_F(Snapshots, AnotherSceneIsRefused) {
    const auto stored = vortices<2>("wcsph", 10);
    advance_by(*stored, 2);
    write_snapshot(*stored, metadata, path);
    const auto refused = [&](auto&& change) {
        auto other = vortices<2>("wcsph", 10);
        change(*other);
        return refusal_of(*other, path);
    };
    const auto same = vortices<2>("wcsph", 10);
    expect_mentions(refusal_of(*same, path, {{"case", "lid"}}), {"case", "'vortices'", "'lid'"});
    expect_mentions(refusal_of(*same, path, {{"wall", "mirror"}}), {"wall is not given", "'mirror'"});
    EXPECT_NO_THROW(read_snapshot(*same, {}, path));
    expect_mentions(refusal_of(*vortices<2>("wcsph", 11), path), {"number of particles is 100", "121"});
    expect_mentions(refusal_of(*vortices<2>("wcsph", 10, {{"gamma", "1"}}), path), {"gamma is '7'", "'1'"});
    expect_mentions(refusal_of(*vortices<2>("isph_df", 10), path), {"another scene", "is not given"});
    expect_mentions(refusal_of(*vortices<3>("wcsph", 8), path), {"dimension is 2", "3"});
    expect_mentions(refused([](auto& s) { s.kinematic_viscosity = 0.1; }),
                    {"kinematic_viscosity is 0.01", "0.1"});
    expect_mentions(refused([](auto& s) { s.smoothing_length *= 1 + 1e-15; }), {"smoothing_length"});
    expect_mentions(refused([](auto& s) { s.particle_spacing *= 2; }), {"particle_spacing"});
    expect_mentions(refused([](auto& s) { s.density = 1000; }), {"density"});
    expect_mentions(refused([](auto& s) { s.reference_speed = 2; }), {"reference_speed"});
    expect_mentions(refused([](auto& s) { s.particle_mass *= 2; }), {"particle_mass"});
    expect_mentions(refused([](auto& s) { s.box.low[1] = -1; }), {"box_low is (0, 0)", "(0, -1)"});
    expect_mentions(refused([](auto& s) { s.box.high[0] = 2; }), {"box_high"});
    expect_mentions(refused([](auto& s) { s.box.periodic[1] = false; }),
                    {"box_periodic is (1, 1)", "(1, 0)"});
    expect_mentions(refused([](auto& s) { s.add_stage("gravity", [](auto&) {}); }),
                    {"list of stages", "gravity"});
    expect_mentions(refused([](auto& s) { s.particles.field("k", 1, Lifetime::state, "turbulence"); }),
                    {"list of state fields", "k"});
    expect_mentions(refused([](auto& s) { s.particles.fields()[2].lifetime = Lifetime::scratch; }),
                    {"list of state fields", "density"});
}

TEST_F(Snapshots, AnIncompleteSnapshotIsRefused) {
    const auto simulation = vortices<2>("wcsph", 10);
    write_snapshot(*simulation, metadata, path);
    const fs::path changed = folder / "changed.h5";
    for (const char* member : {"/format",
                               "/format_version",
                               "/dimension",
                               "/particles",
                               "/step",
                               "/time",
                               "/time_step",
                               "/maximum_acceleration",
                               "/metadata",
                               "/settings",
                               "/settings/gamma",
                               "/scene",
                               "/scene/density",
                               "/scene/box_low",
                               "/work",
                               "/work/particle_steps",
                               "/stages",
                               "/stages/name",
                               "/stages/pair_evaluations",
                               "/particles/id",
                               "/particles/position",
                               "/particles/density",
                               "/metadata/case"}) {
        copy_without(path, changed, member);
        const std::string name(std::string_view(member).substr(std::string_view(member).rfind('/') + 1));
        expect_mentions(refusal_of(*simulation, changed), {name});
    }
    copy_changed(path, changed, [](const std::string&, const Group&, const Group&) { return false; });
    EXPECT_NO_THROW(read_snapshot(*simulation, metadata, changed)) << "the copy itself is at fault";
}

TEST_F(Snapshots, MembersOfTheWrongShapeOrContentAreRefused) {
    const auto simulation = vortices<2>("wcsph", 10);
    write_snapshot(*simulation, metadata, path);
    const fs::path changed = folder / "changed.h5";
    const auto with = [&](const std::string& member, auto values, std::size_t columns) {
        copy_changed(path, changed, [&](const std::string& place, const Group&, const Group& to) {
            if (place == member) {
                to.create_dataset(member.substr(member.rfind('/') + 1), std::span(std::as_const(values)),
                                  columns);
            }
            return place == member;
        });
        return refusal_of(*simulation, changed);
    };
    const auto vector = [](auto value, std::size_t size) { return std::vector(size, value); };
    expect_mentions(with("/particles/density", vector(1.0, 99), 1), {"/particles/density", "99 × 1"});
    expect_mentions(with("/particles/density", vector(1.0, 200), 2), {"/particles/density", "100 × 2"});
    expect_mentions(with("/particles/position", vector(1.0, 200), 2), {"/particles/position", "100 × 3"});
    expect_mentions(with("/particles/density", vector(std::string("1"), 100), 1), {"/particles/density"});
    expect_mentions(with("/particles/id", vector(std::int64_t{1}, 100), 1), {"/particles/id", "once"});
    expect_mentions(with("/particles/id", vector(std::int64_t{-1}, 100), 1), {"/particles/id"});
    expect_mentions(with("/particles/id", vector(std::int64_t{100}, 1), 1), {"/particles/id"});
    expect_mentions(with("/particles/id", vector(std::int64_t{0}, 1), 1), {"/particles/id"});
    expect_mentions(with("/stages/pair_evaluations", vector(std::int64_t{1}, 2), 1), {"list of stages"});
    for (const std::int64_t version : {0, 2}) {
        copy_changed(path, changed, [&](const std::string& place, const Group&, const Group& to) {
            if (place == "/format_version") {
                to.set_attribute("format_version", version);
            }
            return place == "/format_version";
        });
        expect_mentions(refusal_of(*simulation, changed), {"format version " + std::to_string(version)});
    }
}

TEST_F(Snapshots, FilesOfOthersAreRefused) {
    const auto simulation = vortices<2>("wcsph", 10);
    expect_mentions(refusal_of(*simulation, folder / "none.h5"), {"does not exist"});
    expect_mentions(refusal_of(*simulation, folder / ""), {"folder"});
    put(path, "VARIABLES = x y");
    expect_mentions(refusal_of(*simulation, path), {"not an HDF5 file"});
    write_hdf5(path, [](const Group& root) { root.set_attribute<std::string>("format", "sphvv-results"); });
    expect_mentions(refusal_of(*simulation, path), {"not a snapshot of sphvv"});
    write_hdf5(path, [](const Group& root) { root.set_attribute<double>("format", 1); });
    expect_mentions(refusal_of(*simulation, path), {"not a snapshot of sphvv"});
    expect_mentions(refusal([&] { read_snapshot_header(path); }), {"not a snapshot of sphvv"});
    expect_mentions(refusal([&] { xdmf_frame(path); }), {"not a snapshot of sphvv"});
}

TEST_F(Snapshots, DamagedOnesAreRefusedOrRead) {
    const auto simulation = vortices<2>("wcsph", 60); // larger than what fits into headers
    write_snapshot(*simulation, metadata, path);
    const std::string whole = content(path);
    const fs::path damaged = folder / "damaged.h5";
    for (std::size_t length = 1; length < whole.size(); length += 9973) {
        put(damaged, whole.substr(0, length));
        EXPECT_THROW(read_snapshot(*simulation, metadata, damaged), UserError) << length;
    }
    int refused = 0;
    for (unsigned seed = 1; seed <= 200; ++seed) {
        std::mt19937_64 engine(seed);
        std::string bytes = whole;
        bytes[engine() % bytes.size()] ^= static_cast<char>(1 << engine() % 8);
        put(damaged, bytes);
        try {
            read_snapshot(*simulation, metadata, damaged);
        } catch (const UserError&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 180) << "datasets have checksums";
}

TEST_F(Snapshots, AFullDiskLeavesTheLastSnapshot) {
    const auto simulation = vortices<2>("wcsph", 40);
    write_snapshot(*simulation, metadata, path);
    const std::string last = content(path);
    advance_by(*simulation, 1);
    rlimit before{};
    ::getrlimit(RLIMIT_FSIZE, &before);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{10000, before.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const std::string message = refusal([&] { write_snapshot(*simulation, metadata, path); });
    ::setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    expect_mentions(message, {path.string(), "cannot be written"});
    EXPECT_TRUE(content(path) == last);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

// ---- XDMF

/// What a reader makes of one time step of an XDMF file.
struct Seen {
    double time;
    std::size_t points, cells;
    std::array<double, 6> bounds;
    struct Range {
        std::size_t components;
        double low, high;
    };
    std::map<std::string, Range> fields;
};

/// Runs read_xdmf.py; by reader, what it saw.
std::map<std::string, std::vector<Seen>> view(const fs::path& xdmf) {
    const char* given = std::getenv("SPHVV_PYTHON");
    const std::string script = (fs::path(SPHVV_SOLVER_FOLDER) / "tests/read_xdmf.py").string();
    const std::string command = std::string(given != nullptr ? given : "/usr/bin/python3") + " '" + script +
                                "' '" + xdmf.string() + "'";
    std::FILE* pipe = ::popen(command.c_str(), "r");
    std::string text;
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
        text += static_cast<char>(c);
    }
    EXPECT_EQ(::pclose(pipe), 0) << command;
    std::map<std::string, std::vector<Seen>> seen;
    std::istringstream words(text);
    std::string reader;
    for (std::string word; words >> word;) {
        if (word == "reader") {
            words >> reader;
        } else if (word == "frame") {
            Seen& frame = seen[reader].emplace_back();
            words >> frame.time >> frame.points >> frame.cells;
        } else if (word == "bounds") {
            for (double& bound : seen[reader].back().bounds) {
                words >> bound;
            }
        } else if (word == "field") {
            std::string name;
            words >> name;
            Seen::Range& range = seen[reader].back().fields[name];
            words >> range.components >> range.low >> range.high;
        }
    }
    return seen;
}

template <int Dim>
void expect_seen(const Seen& seen, const Simulation<Dim>& simulation, double time) {
    EXPECT_EQ(seen.time, time);
    EXPECT_EQ(seen.points, simulation.particles.size());
    EXPECT_EQ(seen.cells, simulation.particles.size());
    for (std::size_t d = 0; d < 3; ++d) {
        const std::vector<double> zero{0};
        const std::vector<double>& x = d < Dim ? simulation.particles.position.components[d] : zero;
        EXPECT_EQ(seen.bounds[2 * d], *std::min_element(x.begin(), x.end()));
        EXPECT_EQ(seen.bounds[2 * d + 1], *std::max_element(x.begin(), x.end()));
    }
    const std::vector<double>& pressure = simulation.particles.find("pressure")->components[0];
    ASSERT_TRUE(seen.fields.contains("pressure"));
    EXPECT_EQ(seen.fields.at("pressure").components, 1U);
    EXPECT_EQ(seen.fields.at("pressure").low, *std::min_element(pressure.begin(), pressure.end()));
    EXPECT_EQ(seen.fields.at("pressure").high, *std::max_element(pressure.begin(), pressure.end()));
    EXPECT_EQ(seen.fields.at("velocity").components, 3U);
    EXPECT_EQ(seen.fields.at("tensor").components, std::size_t{Dim} * Dim);
    EXPECT_EQ(seen.fields.at("id").high, static_cast<double>(simulation.particles.size() - 1));
    EXPECT_FALSE(seen.fields.contains("position"));
}

template <int Dim>
void expect_viewable(const fs::path& folder, int n) {
    const fs::path xdmf = folder / "run é & <more>.xdmf";
    std::vector<XdmfFrame> frames;
    auto simulation = vortices<Dim>("wcsph", n);
    simulation->particles.field("tensor", Dim * Dim, Lifetime::state, "test");
    std::vector<double> times;
    for (int k = 0; k < 3; ++k) {
        advance_by(*simulation, 2);
        const fs::path snapshot = folder / ("run é & <more>-" + std::to_string(k) + ".h5");
        write_snapshot(*simulation, metadata, snapshot);
        frames.push_back(xdmf_frame(snapshot));
        write_xdmf(xdmf, frames);
    }
    const auto seen = view(xdmf);
    ASSERT_FALSE(seen.empty());
    for (const auto& [reader, steps] : seen) {
        SCOPED_TRACE(reader);
        ASSERT_EQ(steps.size(), 3U);
        expect_seen(steps.back(), *simulation, simulation->time);
        EXPECT_EQ(steps.front().time, frames.front().time);
        EXPECT_LT(steps.front().time, steps.back().time);
    }
}

TEST_F(Snapshots, AViewerSeesTheParticles) {
    expect_viewable<2>(folder, 16);
    expect_viewable<3>(folder, 10);
    expect_viewable<2>(folder, 60); // with datasets in chunks
}

TEST_F(Snapshots, NamesThatXdmfCannotHoldAreRefused) {
    const XdmfFrame frame{"a:b.h5", 0, 1, {}};
    expect_mentions(refusal([&] { write_xdmf(folder / "x.xdmf", std::span(&frame, 1)); }),
                    {"x.xdmf", "a:b.h5", "':'"});
    EXPECT_FALSE(fs::exists(folder / "x.xdmf"));
    expect_mentions(refusal([&] { write_xdmf(folder / "no" / "x.xdmf", {}); }), {"no folder"});
}

} // namespace
