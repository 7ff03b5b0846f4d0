// `sphvv compare`, `sphvv bless`: any bytes are a result file, in HDF5 or JSON, or a baseline, or are refused
// in one sentence.
#include "sphvv/solver/fuzz/target.hpp"
#include "sphvv/solver/storage/trial_reading.hpp"
#include "sphvv/verification/compare.hpp"

using namespace sphvv;
using namespace sphvv::verification;

namespace {

/// The tree of a file comes back from another one.
void require_round_trip(const ResultTree& tree) {
    static const fuzz::Scratch scratch;
    write_results_hdf5(tree, scratch.path());
    const ResultTree once = read_results_hdf5(scratch.path());
    write_results_hdf5(once, scratch.path());
    fuzz::require(read_results_hdf5(scratch.path()) == once, "a tree does not come back from its file");
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const fuzz::Scratch scratch;
    scratch.with({reinterpret_cast<const char*>(data), size});
    if (fuzz::is_refused_in_words([] { solver::storage::read_in_trial(scratch.path()); })) {
        return 0;
    }
    fuzz::is_refused_in_words([] { require_round_trip(read_results_hdf5(scratch.path())); });
    fuzz::is_refused_in_words([] {
        const ResultTree tree = read_comparable(scratch.path());
        const Comparison comparison = compare(tree, tree);
        fuzz::require(!comparison.fails(), "a result differs from itself: " + markdown(comparison));
        const std::string baseline = baseline_text(reduced_for_baseline(tree, true));
        fuzz::require(!compare(ResultTree::parse(baseline), tree).fails(),
                      "a result differs from its baseline");
    });
    return 0;
}
