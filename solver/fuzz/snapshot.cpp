// `sphvv run --resume`: any bytes are a snapshot of this simulation, or are refused in words and leave
// it as it was.
#include "sphvv/solver/snapshots/snapshot.hpp"

#include "sphvv/solver/fuzz/target.hpp"
#include "sphvv/solver/snapshots/xdmf.hpp"
#include "sphvv/solver/storage/trial_reading.hpp"

#include <memory>

using namespace sphvv;
using namespace sphvv::solver;

namespace {

const Assignments metadata{{"case", "drop"}, {"n", "2"}};

/// Two fluid particles, with everything that a snapshot can hold but turbulence and wall functions.
std::unique_ptr<Simulation<2>> scene() {
    Box<2> box;
    box.high.fill(1);
    box.periodic.fill(true);
    auto simulation = std::make_unique<Simulation<2>>(box, 2);
    simulation->settings = Settings(
        {Key::number("h_over_dx", 1.5, 1, 3, "1", ""), Key::word("kernel", "a", {"a", "b"}, "")}, {});
    simulation->particles.field("density", 1, Lifetime::state, "fuzz");
    simulation->flow_driver.emplace();
    simulation->add_stage("forces", [](Simulation<2>&) {});
    return simulation;
}

std::string content(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::string written(const Simulation<2>& simulation) {
    static const fuzz::Scratch scratch;
    write_snapshot(simulation, metadata, scratch.path());
    return content(scratch.path());
}

void read_into(Simulation<2>& simulation, std::string_view bytes) {
    static const fuzz::Scratch scratch;
    read_snapshot(simulation, metadata, scratch.with(bytes));
}

/// Whether a snapshot is refused; if not, what was read comes back from its own snapshot.
bool is_refused(std::string_view bytes, const std::string& untouched) {
    const auto simulation = scene();
    if (fuzz::is_refused_in_words([&] { read_into(*simulation, bytes); })) {
        fuzz::require(written(*simulation) == untouched, "a refused snapshot has changed the simulation");
        return true;
    }
    const std::string once = written(*simulation);
    const auto again = scene();
    read_into(*again, once);
    fuzz::require(written(*again) == once, "a state does not come back from its snapshot");
    return false;
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const fuzz::Scratch scratch;
    static const std::string untouched = written(*scene());
    static const bool refuses_all = is_refused(untouched, untouched);
    fuzz::require(!refuses_all, "a sound snapshot is refused");
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    scratch.with(bytes);
    if (fuzz::is_refused_in_words([] { storage::read_in_trial(scratch.path()); })) {
        return 0;
    }
    fuzz::is_refused_in_words([] { read_snapshot_header(scratch.path()); });
    fuzz::is_refused_in_words([] { xdmf_frame(scratch.path()); });
    is_refused(bytes, untouched);
    return 0;
}
